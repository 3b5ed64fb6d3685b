"""Auriga-alpha in the contact simulator: the 441 steady states of Martinez 2017.

    python -m tests.studies.identification.auriga [--vehicle FILE] [--law coulomb|shear]
        [--out FOLDER]

Left and right track speeds from -1 to 1 m/s in steps of 0.1 m/s. Printed beside the paper's: the
mean ICRs, the speed ratio H of turning on the spot, and the errors of constant ICRs (Table II).
Written: the steady states (CSV) and figures like Fig. 3 (ICRs), 5 (inertial force) and 6 (indices).
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.arrays import BoolArray, FloatArray
from odometry.io.csv_table import write_csv_table
from odometry.report.drawing.figure import save_figure
from odometry.simulation.contact.steady_state import steady_state
from odometry.simulation.contact.vehicle import ContactVehicle, read_contact_vehicle

VEHICLE = Path(__file__).parents[3] / "data" / "vehicles" / "auriga_alpha.toml"
PAPER_ICRS_M = (0.458, -0.630, 0.0482)  # section II, as y_left, y_right, x_icr
PAPER_H = 0.67134
PAPER_RMSE = (0.0821718, 0.015962, 0.143285)  # Table II, constant ICRs; v_x, v_y, omega


@dataclass(frozen=True)
class SteadyStates:
    """Steady twists of the 441 speed pairs, in the project's frame.

    Attributes
    ----------
    vehicle : ContactVehicle
    pairs_m_s : (441, 2) array
        v_left, v_right.
    twists_body : (441, 3) array
        v_x, v_y, omega.
    settled : (441,) array of bool
    """

    vehicle: ContactVehicle
    pairs_m_s: FloatArray
    twists_body: FloatArray
    settled: BoolArray

    @property
    def turns(self) -> BoolArray:
        """Where the speeds differ, (441,): elsewhere there is no ICR."""
        return self.pairs_m_s[:, 0] != self.pairs_m_s[:, 1]

    @property
    def icrs_m(self) -> FloatArray:
        """y_left, y_right, x_icr (441, 3) by eq. 1-3; NaN without a turn."""
        v_x, v_y, omega = self.twists_body.T
        spin = np.where(self.turns, omega, np.nan)
        left, right = self.pairs_m_s.T
        return np.column_stack([(v_x - left) / spin, (v_x - right) / spin, -v_y / spin])

    @property
    def inertial_force_n(self) -> FloatArray:
        """|F| (441,) by eq. 11."""
        v_x, v_y, omega = self.twists_body.T
        x, y, _ = self.vehicle.centre_of_mass_m
        return self.vehicle.mass_kg * np.abs(omega) * np.hypot(v_x - omega * y, v_y + omega * x)

    @property
    def indices(self) -> FloatArray:
        """Sliding zeta [m], eccentricity epsilon [m], efficiency eta (441, 3) by eq. 17-19.

        The paper's X points to the right.
        """
        left, right, x_icr = self.icrs_m.T
        return np.column_stack(
            [x_icr, -(left + right) / 2, (left - right) / self.vehicle.track_width_m]
        )


def solve(vehicle: ContactVehicle) -> SteadyStates:
    """Settle all pairs at once."""
    speeds = np.arange(-10, 11) / 10
    pairs = np.stack(np.meshgrid(speeds, speeds, indexing="ij"), axis=-1).reshape(-1, 2)
    return SteadyStates(vehicle, pairs, *steady_state(vehicle, pairs))


def spot_turn_ratio(states: SteadyStates) -> float:
    """H of eq. 13: the centre of mass has no forward speed at v_left = -H v_right.

    For each v_right its zero along v_left, by linear interpolation; the mean of -v_left / v_right.
    """
    v_x, _, omega = states.twists_body.T
    forward = (v_x - omega * states.vehicle.centre_of_mass_m[1]).reshape(21, 21)
    speeds = states.pairs_m_s[:21, 1]
    ratios = []
    for column in np.flatnonzero(np.abs(speeds) > 0.05):
        zero = np.interp(0.0, forward[:, column], speeds)
        ratios.append(-zero / speeds[column])
    return float(np.mean(ratios))


def constant_icr_errors(states: SteadyStates) -> FloatArray:
    """RMSE of v_x, v_y, omega (3,) over all pairs when every ICR is its mean (Table II)."""
    y_left, y_right, x_icr = np.nanmean(states.icrs_m, axis=0)
    left, right = states.pairs_m_s.T
    omega = (right - left) / (y_left - y_right)
    constant = np.column_stack([left + omega * y_left, -omega * x_icr, omega])
    return np.asarray(np.sqrt(((constant - states.twists_body) ** 2).mean(axis=0)))


def draw_icrs(figure: Figure, states: SteadyStates) -> None:
    """Draw Fig. 3, seen from above with the robot's front at the top."""
    axes = figure.add_subplot()
    icrs = states.icrs_m
    for side in (0, 1):
        axes.plot(-icrs[:, side], icrs[:, 2], ".", color="#0072B2", markersize=3)
        axes.plot(-np.nanmean(icrs[:, side]), np.nanmean(icrs[:, 2]), "*", color="#D55E00", ms=11)
        axes.plot(-PAPER_ICRS_M[side], PAPER_ICRS_M[2], "x", color="black", markersize=9)
    places = states.vehicle.places_m
    axes.plot(-places.imag, places.real, "s", color="#777777", markersize=4)
    axes.set_aspect("equal")
    axes.set_xlabel("to the right [m]")
    axes.set_ylabel("forward [m]")
    axes.set_title("Track ICRs: each pair (dots), mean (stars), the paper's mean (crosses)")


def draw_map(figure: Figure, states: SteadyStates, values: FloatArray, title: str) -> None:
    """Draw values over the speed plane, with the lines of eq. 12 and 13 (Fig. 5 and 6)."""
    axes = figure.add_subplot()
    speeds = states.pairs_m_s[:21, 1]
    mesh = axes.pcolormesh(speeds, speeds, values.reshape(21, 21).T, cmap="viridis")
    figure.colorbar(mesh, ax=axes)
    axes.plot(speeds, speeds, color="#D55E00")
    axes.plot(-spot_turn_ratio(states) * speeds, speeds, "--", color="white")
    axes.set_xlabel("v_left [m/s]")
    axes.set_ylabel("v_right [m/s]")
    axes.set_title(title)


def write(states: SteadyStates, out: Path) -> None:
    """Write the steady states and the figures."""
    columns = {
        **dict(zip(("v_left", "v_right"), states.pairs_m_s.T, strict=True)),
        **dict(zip(("v_x", "v_y", "omega"), states.twists_body.T, strict=True)),
        "settled": states.settled.astype(float),
    }
    write_csv_table(out / "auriga_steady_states.csv", columns)
    save_figure(out / "auriga_icrs.png", (7.0, 4.5), lambda figure: draw_icrs(figure, states))
    maps = {
        "inertial_force": (states.inertial_force_n, "Inertial force |F| [N]"),
        "sliding": (states.indices[:, 0], "Sliding index zeta [m]"),
        "eccentricity": (states.indices[:, 1], "Eccentricity index epsilon [m]"),
        "efficiency": (states.indices[:, 2], "Steering efficiency index eta"),
    }
    for name, (values, title) in maps.items():
        save_figure(
            out / f"auriga_{name}.png",
            (5.5, 4.5),
            lambda figure, values=values, title=title: draw_map(figure, states, values, title),
        )


def main() -> None:
    """Run the study, print its numbers, write its figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vehicle", type=Path, default=VEHICLE)
    parser.add_argument("--law", choices=["coulomb", "shear"], default=None)
    parser.add_argument("--out", type=Path, default=None)
    arguments = parser.parse_args()
    changes = {"law": arguments.law} if arguments.law else {}
    states = solve(read_contact_vehicle(arguments.vehicle, changes))
    print(f"{states.settled.sum()} of {len(states.settled)} pairs settled")
    icrs = states.icrs_m
    for name, values, paper in zip(
        ("y_left", "y_right", "x_icr"), icrs.T, PAPER_ICRS_M, strict=True
    ):
        print(
            f"{name}: mean {np.nanmean(values):.4f}, spread {np.nanstd(values):.4f}; paper {paper}"
        )
    print(f"H {spot_turn_ratio(states):.4f}; paper {PAPER_H}")
    print(f"largest |F| {states.inertial_force_n.max():.0f} N")
    names = ("v_x", "v_y", "omega")
    for name, error, paper in zip(names, constant_icr_errors(states), PAPER_RMSE, strict=True):
        print(f"constant ICRs, RMSE of {name}: {error:.4f}; paper {paper:.4f}")
    if arguments.out:
        write(states, arguments.out)
        print(f"Wrote {arguments.out}")


if __name__ == "__main__":
    main()
