"""The inertia model on Auriga-alpha: printed and refitted coefficients (Martinez 2017, Table II).

    python -m tests.studies.identification.auriga_indices [--out auriga]

The truth is the 441 steady states of the contact simulator (`auriga.py`). The coefficients of
eq. 25-27 are refitted as the paper did, each index by least squares with the simulated |F| and H.
The model then predicts every pair from its speeds alone, with the |F| of its own twist. Errors of
all pairs that settled are printed beside constant ICRs and beside the paper's Table II; and,
because a fit is evaluated on other data, those of pairs left out in turn (ten folds of random
pairs).
"""

import argparse
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.arrays import BoolArray, FloatArray
from odometry.models.icr_inertia import IcrInertia
from odometry.models.inputs import Inputs
from odometry.parameters import read_parameters
from odometry.report.drawing.figure import save_figure
from odometry.simulation.contact.vehicle import read_contact_vehicle
from tests.studies.identification.auriga import (
    VEHICLE,
    SteadyStates,
    constant_icr_errors,
    solve,
    spot_turn_ratio,
)

PRINTED = Path(__file__).parents[3] / "data" / "parameters" / "auriga_alpha.toml"
PAPER_RMSE = {
    "constant": (0.0821718, 0.015962, 0.143285),
    "inertia": (0.0383464, 0.0044424, 0.0637394),
}
NAMES = ("zeta_0", "zeta_1", "epsilon_0", "epsilon_1", "eta_0", "eta_1", "eta_2", "h")
MODEL = IcrInertia()


def main() -> None:
    """Fit, evaluate, draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=None)
    arguments = parser.parse_args()
    states = solve(read_contact_vehicle(VEHICLE))
    printed = read_parameters(PRINTED).terrains["hard_ground"].values
    every = np.ones(len(states.pairs_m_s), dtype=bool)
    refitted = {**printed, **coefficients(states, every)}
    print(f"{'':10} {'printed':>12} {'refitted':>12}")
    for name in NAMES:
        print(f"{name:10} {printed[name]:12.5g} {refitted[name]:12.5g}")

    errors = {
        "constant ICRs": constant_icr_errors(states),
        "inertia, printed": rmse(states, predicted(printed, states)),
        "inertia, refitted": rmse(states, predicted(refitted, states)),
        "inertia, pairs left out": rmse(states, left_out(states, printed)),
    }
    print(f"\nRMSE over 441 pairs {'v_x':>10} {'v_y':>10} {'omega':>10}")
    for name, values in errors.items():
        print(f"{name:24}", " ".join(f"{value:10.4f}" for value in values))
    for name, values in PAPER_RMSE.items():
        print(f"{'paper: ' + name:24}", " ".join(f"{value:10.4f}" for value in values))
    ratio = errors["constant ICRs"] / errors["inertia, pairs left out"]
    paper = np.divide(PAPER_RMSE["constant"], PAPER_RMSE["inertia"])
    print("constant / inertia     ", " ".join(f"{value:10.2f}" for value in ratio))
    print("the same in the paper  ", " ".join(f"{value:10.2f}" for value in paper))
    if arguments.out:
        save_figure(
            arguments.out / "auriga_index_fits.png",
            (11.0, 4.0),
            lambda figure: draw_fits(figure, states, refitted),
        )
        save_figure(
            arguments.out / "auriga_model_icrs.png",
            (8.0, 4.0),
            lambda figure: draw_icrs(figure, states, refitted),
        )
        print(f"Wrote {arguments.out}")


def signs(states: SteadyStates, h: float) -> tuple[FloatArray, FloatArray]:
    """sign(x_1) and sign(x_2) of eq. 14-15."""
    left, right = states.pairs_m_s.T
    return np.sign(np.round(left - right, 9)), np.sign(np.round(left + h * right, 9))


def coefficients(states: SteadyStates, used: BoolArray) -> dict[str, float]:
    """Eq. 25-27 by least squares over the used pairs that turn, with the simulated |F| and H."""
    h = spot_turn_ratio(states)
    used = used & states.turns & states.settled
    first, second = signs(states, h)
    force, ones = states.inertial_force_n, np.ones(len(states.pairs_m_s))
    zeta, epsilon, eta = states.indices.T

    def fitted(columns: list[FloatArray], index: FloatArray) -> list[float]:
        matrix = np.column_stack(columns)[used]
        return [float(v) for v in np.linalg.lstsq(matrix, index[used], rcond=None)[0]]

    zeta_fit = fitted([ones, force * second], zeta)  # eq. 25
    epsilon_fit = fitted([ones, force * first * second], epsilon)  # eq. 26
    eta_fit = fitted([ones, force * first * second, force**2], eta)  # eq. 27
    return dict(zip(NAMES, [*zeta_fit, *epsilon_fit, *eta_fit, h], strict=True))


def predicted(values: dict[str, float], states: SteadyStates) -> FloatArray:
    """Twists (441, 3) from the speeds alone."""
    return MODEL.twist(MODEL.pack(values), Inputs(states.pairs_m_s))


def left_out(states: SteadyStates, known: dict[str, float]) -> FloatArray:
    """Twists (441, 3), each predicted without its own fold."""
    fold = np.random.default_rng(0).permutation(len(states.pairs_m_s)) % 10
    twists = np.empty_like(states.twists_body)
    for part in range(10):
        values = {**known, **coefficients(states, fold != part)}
        twists[fold == part] = predicted(values, states)[fold == part]
    return twists


def rmse(states: SteadyStates, twists: FloatArray) -> FloatArray:
    """Of v_x, v_y, omega (3,)."""
    return np.asarray(np.sqrt(((twists - states.twists_body) ** 2).mean(axis=0)))


def draw_fits(figure: Figure, states: SteadyStates, values: dict[str, float]) -> None:
    """Indices against the signed force, as in Fig. 7, with the refitted polynomials."""
    first, second = signs(states, values["h"])
    force = states.inertial_force_n
    span = np.linspace(-force.max(), force.max(), 200)
    shown = {
        "zeta [m]": (force * second, [values["zeta_0"], values["zeta_1"], 0.0]),
        "epsilon [m]": (force * first * second, [values["epsilon_0"], values["epsilon_1"], 0.0]),
        "eta": (force * first * second, [values["eta_0"], values["eta_1"], values["eta_2"]]),
    }
    for place, (name, (signed, polynomial)) in enumerate(shown.items()):
        axes = figure.add_subplot(1, 3, place + 1)
        axes.plot(signed, states.indices[:, place], ".", color="#0072B2", markersize=3)
        axes.plot(span, np.polyval(polynomial[::-1], span), color="#D55E00", linewidth=2)
        product = "sign(x_2)" if place == 0 else "sign(x_1) sign(x_2)"
        axes.set(xlabel=f"|F| {product} [N]", ylabel=name)
        axes.grid(visible=True, alpha=0.4)
    figure.subplots_adjust(left=0.07, right=0.99, bottom=0.15, top=0.96, wspace=0.3)


def draw_icrs(figure: Figure, states: SteadyStates, values: dict[str, float]) -> None:
    """ICRs of the refitted model, as in Fig. 8; those of the simulator in grey."""
    axes = figure.add_subplot()
    found = MODEL.icrs(MODEL.pack(values), Inputs(states.pairs_m_s))[states.turns]
    true = states.icrs_m[states.turns]
    for side in (0, 1):
        axes.plot(-true[:, side], true[:, 2], ".", color="#BBBBBB", markersize=3)
        axes.plot(-found[:, side], found[:, 2], ".", color="#0072B2", markersize=3)
        axes.plot(-true[:, side].mean(), true[:, 2].mean(), "*", color="#D55E00", markersize=11)
    axes.set(xlabel="to the right [m]", ylabel="forward [m]")
    axes.set_title("ICRs of the model (blue) and of the simulator (grey)")
    axes.grid(visible=True, alpha=0.4)


if __name__ == "__main__":
    main()
