"""ICRs on slopes (Martinez 2024): the ovals of Fig. 2, the slope of Fig. 8, and Table II.

    python -m tests.studies.identification.slopes [--out slopes] [--seeds 5]

The truth is the contact simulator, for a vehicle like the paper's J8: `icr` is identified on
level ground, `icr_slope` in two stages with a turn on the spot on 4 degrees as the paper does it,
`contact` on both runs. The three paths of Fig. 7 are then predicted open loop from the start.
Figures are drawn of the parameter sets that the paper prints.
"""

import argparse
import tempfile
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("agg")
import matplotlib.pyplot as plt

from odometry.evaluation.open_loop import fitness, measured_poses, open_loop
from odometry.identification.fit import Fit, fit
from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.models.icr_slope import IcrSlope
from odometry.models.inputs import Inputs
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.slope import Plane
from odometry.simulation.contact.vehicle import read_contact_vehicle
from odometry.simulation.courses import STEP_S, make_course, slope_paths
from odometry.simulation.record import ContactSensors, write_contact_run
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.run_inputs import inputs_of
from odometry.windows.travel.windows import windows_of

DATA = Path(__file__).parents[3] / "data"
PRINTED = {"spin": (1.005, 0.081), "figure_eight": (0.781, 0.310), "three_zones": (8.821, 6.438)}
SENSORS = ContactSensors()
WINDOWS = WindowConfig(position_sigma_m=0.01, yaw_sigma_rad=0.004)


def main() -> None:
    """Draw the figures and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("slopes"))
    parser.add_argument("--seeds", type=int, default=5)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    draw_ovals(arguments.out / "icrs_over_heading.png")
    vehicle = read_contact_vehicle(DATA / "vehicles" / "j8.toml")
    rows = [study(vehicle, seed, arguments.out) for seed in range(arguments.seeds)]
    print_table(rows)
    print("wrote", ", ".join(sorted(file.name for file in arguments.out.glob("*.png"))))


def study(vehicle, seed: int, out: Path) -> dict[tuple[str, str], object]:
    """Fitness of each model on each path, by (path, model)."""
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as scratch:
        runs = record_runs(vehicle, rng, Path(scratch))
        fits = identify_models(runs["level"], runs["turn"])
        if seed == 0:
            for name, found in fits.items():
                print(f"{name}:", {n: float(f"{v:.4g}") for n, v in found.values.items()})
        judged = {}
        for path in PRINTED:
            run = runs[path]
            reckoned = {}
            for name, found in fits.items():
                twists = found.model.twist(found.packed, inputs_of(run))
                reckoned[name] = open_loop(run, twists)
                judged[path, name] = fitness(reckoned[name], *measured_poses(run))
            if seed == 0:
                draw_path(out / f"path_{path}.png", run, reckoned)
        if seed == 0:
            draw_slope(out / "slope_along_path.png", runs["three_zones"])
    return judged


def record_runs(vehicle, rng: np.random.Generator, scratch: Path) -> dict[str, Run]:
    """The calibration runs and the three paths, as run folders."""
    level = make_course(
        "excitation",
        vehicle,
        duration_s=180.0,
        max_speed_m_s=1.0,
        slope_rad=0.0,
        uphill_rad=0.0,
        rng=rng,
    )
    turn = make_course(
        "spin",
        vehicle,
        duration_s=60.0,
        max_speed_m_s=0.33,
        slope_rad=0.0,
        uphill_rad=0.0,
        rng=rng,
    )
    courses = {
        "level": (level.tread_speeds_m_s, level.ground),
        "turn": (turn.tread_speeds_m_s, Plane(np.deg2rad(4.0), np.pi / 2)),
    } | {name: (c.tread_speeds_m_s, c.ground) for name, c in slope_paths(vehicle).items()}
    runs = {}
    for name, (speeds, ground) in courses.items():
        drive = simulate_contact(vehicle, speeds, STEP_S, ground=ground)
        folder = write_contact_run(scratch / name, drive, SENSORS, rng, terrain="concrete")
        runs[name] = Run.read(folder)
    return runs


def identify_models(level: Run, turn: Run) -> dict[str, Fit]:
    """Each model from the calibration runs alone."""
    robot = level.robot
    settings = {"window_config": WINDOWS, "solver_config": SolverConfig(starts=2)}
    flat = fit(MODELS["icr"], windows_of([level], WINDOWS), robot, fixed={}, **settings)
    base = {"half_width": 0.6, "half_length": 1.06}
    sloped = identify([level, turn], "icr_slope", fixed=base | {"v_max": 1.0}, **settings)
    contact = identify(
        [level, turn], "contact", fixed={"half_width": 0.6, "contacts": 4.0}, **settings
    )
    return {
        "icr": flat,
        "icr_slope": sloped.terrains["concrete"].fit,
        "contact": contact.terrains["concrete"].fit,
    }


def print_table(rows: list[dict[tuple[str, str], object]]) -> None:
    """Print J / N and its parts: medians over seeds, and ratios beside the paper's."""
    models = ("icr", "icr_slope", "contact")
    print(f"\nmedian of {len(rows)} seeds; J / N and its parts x, y, z [m^2], heading [rad^2]")
    for path, (flat, sloped) in PRINTED.items():
        for model in models:
            parts = [row[path, model] for row in rows]
            means = np.median([[p.x_m2, p.y_m2, p.z_m2, p.yaw_rad2, p.mean] for p in parts], axis=0)
            print(f"  {path:13} {model:10}", " ".join(f"{value:9.4f}" for value in means))
        ratio = {
            model: np.array([row[path, "icr"].mean / row[path, model].mean for row in rows])
            for model in models[1:]
        }
        words = ", ".join(
            f"icr / {model} {np.median(values):.1f} [{values.min():.1f}, {values.max():.1f}]"
            for model, values in ratio.items()
        )
        print(f"  {path:13} {words}; printed ICRHK / ICRIK {flat / sloped:.1f}")


def draw_ovals(file: Path) -> None:
    """Tread ICRs over a full turn on the spot, as in Fig. 2: rows of tilt, one column a robot."""
    shown = {
        "Lazaro (turning right at 0.21 m/s)": (
            "lazaro",
            "melamine",
            (0.21, -0.21),
            (0, 2.5, 4.4, 7.6),
        ),
        "J8 (turning left at 0.33 m/s)": ("j8", "smooth_concrete", (-0.33, 0.33), (0, 2, 4, 6)),
    }
    figure, axes = plt.subplots(4, 2, figsize=(9, 12), layout="constrained")
    for column, (title, (name, terrain, speeds, tilts)) in enumerate(shown.items()):
        table = read_parameters(DATA / "parameters" / f"{name}.toml").terrains[terrain]
        values = IcrSlope().pack(table.values)
        for row, degrees in enumerate(tilts):
            draw_oval(axes[row, column], values, np.array(speeds), np.deg2rad(degrees))
            axes[row, column].set_title(
                f"{title if row == 0 else ''}\ntilt {degrees} degrees", fontsize=9
            )
    figure.savefig(file, dpi=110)
    plt.close(figure)


def draw_oval(axes, values: np.ndarray, speeds: np.ndarray, slope: float) -> None:
    """ICRs by heading; the paper's axes: X to the right, Y forward."""
    headings = np.linspace(0, 2 * np.pi, 361)
    # The body's axes on a plane that rises along world x: tan(slope) seen along x and y.
    rise, side = np.tan(slope) * np.cos(headings), -np.tan(slope) * np.sin(headings)
    pitch = -np.arctan(rise)
    roll = np.arctan2(side * np.cos(pitch), 1.0)
    icrs = IcrSlope().icrs(values, Inputs(np.broadcast_to(speeds, (361, 2)), roll, pitch))
    for tread, colour in ((0, "#0072B2"), (1, "#D55E00")):
        axes.plot(-icrs[:, tread], icrs[:, 2], ".", markersize=2.5, color=colour)
        axes.plot(-icrs[0, tread], icrs[0, 2], "o", color=colour, markersize=6)
    half_width, half_length = values[-2:]
    axes.add_patch(
        plt.Rectangle(
            (-half_width, -half_length),
            2 * half_width,
            2 * half_length,
            fill=False,
            color="#555555",
        )
    )
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="X to the right [m]", ylabel="Y forward [m]")
    axes.grid(visible=True, alpha=0.4)


def draw_path(file: Path, run: Run, reckoned: dict[str, object]) -> None:
    """The path from above, uphill at the top, as in Fig. 7."""
    figure, axes = plt.subplots(figsize=(7, 6), layout="constrained")
    truth = run.truth.stack("x", "y")
    axes.plot(truth[:, 0], truth[:, 1], color="black", linewidth=2, label="truth")
    styles = {
        "icr": ("#D55E00", "dashdot"),
        "icr_slope": ("#0072B2", "solid"),
        "contact": ("#00785A", "dotted"),
    }
    for name, path in reckoned.items():
        colour, dashes = styles[name]
        x, y = path.positions_m[:, 0], path.positions_m[:, 1]
        axes.plot(x, y, color=colour, linestyle=dashes, label=name)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="x [m]", ylabel="y, uphill [m]")
    axes.grid(visible=True, alpha=0.4)
    axes.legend()
    figure.savefig(file, dpi=110)
    plt.close(figure)


def draw_slope(file: Path, run: Run) -> None:
    """Maximum slope beta along the path, from measured roll and pitch, as in Fig. 8."""
    roll, pitch = run.odometry["roll"], run.odometry["pitch"]
    beta = np.degrees(np.arccos(np.cos(roll) * np.cos(pitch)))  # eq. 3, exact
    figure, axes = plt.subplots(figsize=(8, 3.2), layout="constrained")
    axes.plot(run.odometry.stamps_s, beta, color="#0072B2", linewidth=0.8)
    axes.set(xlabel="time [s]", ylabel="slope beta [degrees]", ylim=(0, None))
    axes.margins(x=0)
    axes.grid(visible=True, alpha=0.4)
    figure.savefig(file, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
