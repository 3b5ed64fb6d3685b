"""Do a model's own parameters come back, and do 95 % intervals cover them?

    python -m tests.studies.identification.recovery [--seeds 50] [--model NAME ...] [--workers 2]

Each model drives 120 s of random commands at 50 Hz; its own twists are integrated in space, the
reference has 1 cm and 0.3 degrees of noise at 10 Hz. Models that need slopes or speed get them.
Everything is identified as a user would, starting from the guess for the robot.
"""

import argparse
import tempfile
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
from scipy.stats import binomtest

from odometry.dead_reckoning import dead_reckon_in_space
from odometry.identification.fitters import fitter
from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.installed import shipped_data
from odometry.io.run_folder import write_run_folder
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of

POSITION_M, YAW_RAD = 0.01, np.radians(0.3)
ICR = {"y_left": 0.45, "y_right": -0.38, "x_icr": 0.04, "alpha_left": 0.96, "alpha_right": 0.93}
BASE = {"half_width": 0.25, "half_length": 0.25}
AURIGA = read_parameters(shipped_data() / "parameters" / "auriga_alpha.toml")  # Martinez 2017


@dataclass(frozen=True)
class Case:
    """A true parameter set and the drive from which it shall be identified."""

    values: dict[str, float]
    speed_m_s: float = 1.0
    slope_rad: float = 0.0
    duration_s: float = 120.0
    rate_hz: float = 50.0
    fixed: dict[str, float] = field(default_factory=dict)


CASES = {
    "icr_symmetric": Case({"alpha": 0.94, "b_hat": 0.83}),
    "icr": Case(ICR),
    "radius_of_curvature": Case({"alpha": 0.94, "beta_1": 0.8, "beta_2": 0.4, "track_width": 0.5}),
    "full_linear": Case(
        {
            "gamma_11": 0.47,
            "gamma_12": 0.44,
            "gamma_21": -0.08,
            "gamma_22": 0.06,
            "gamma_31": -1.1,
            "gamma_32": 1.2,
        }
    ),
    "traction_mode": Case({"k": 0.93, "m": 0.55, "track_width": 0.5}),
    "icr_slope": Case(
        {**ICR, "lambda_1": 1.5, "lambda_2": 3.0, "v_max": 1.0, **BASE},
        slope_rad=np.radians(8),
        fixed={"v_max": 1.0, **BASE},
    ),
    "icr_inertia": Case(
        AURIGA.terrains["hard_ground"].values,
        fixed={"mass": 258.0, "x_cm": 0.04, "y_cm": 0.015, "track_width": 0.42},
    ),
    "contact": Case(
        {
            "mu": 0.5,
            "mass": 50.0,
            "x_cm": 0.03,
            "y_cm": 0.01,
            "height": 0.25,
            "contacts": 3.0,
            "slip_scale": 0.04,
            **BASE,
        },
        slope_rad=np.radians(8),
        rate_hz=10.0,
        fixed={"mass": 50.0, "contacts": 3.0, "half_width": 0.25},
    ),
}


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--model", action="append", choices=list(CASES))
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    for name in arguments.model or CASES:
        with ProcessPoolExecutor(arguments.workers) as pool:
            found = list(pool.map(partial(recover, name), range(arguments.seeds)))
        report(name, found)
    for note in (
        mu_on_flat_ground(),
        icrs_of_creeping_treads(0.01),
        icrs_of_creeping_treads(0.004),
    ):
        print(note)


def recover(name: str, seed: int) -> dict[str, tuple[float, float]]:
    """Estimate and half the width of its 95 % interval by parameter."""
    case = CASES[name]
    with tempfile.TemporaryDirectory() as scratch:
        run = drive(name, case, seed, Path(scratch) / "run")
    config = WindowConfig(position_sigma_m=POSITION_M, yaw_sigma_rad=YAW_RAD)
    fit_to = fitter(
        MODELS[name],
        run.robot,
        fixed=case.fixed,
        window_config=config,
        solver_config=SolverConfig(starts=2),
    )
    fit = fit_to(windows_of([run], config))
    told = {n: (fit.values[n], of.high - fit.values[n]) for n, of in fit.intervals.items()}
    told |= {n: (fit.values[n], np.nan) for n in fit.by_trial}
    if fit.undetermined:
        print(f"seed {seed}:", *(open_.words() for open_ in fit.undetermined), flush=True)
    return told


def drive(name: str, case: Case, seed: int, folder: Path) -> Run:
    """A run folder of the model's own motion."""
    rng = np.random.default_rng(seed)
    stamps_s = np.arange(round(case.duration_s * case.rate_hz) + 1) / case.rate_hz
    knots_s = np.arange(0.0, case.duration_s + 4.0, 2.0)
    speeds = _smooth(stamps_s, knots_s, rng.uniform(-1, 1, (len(knots_s), 2)) * case.speed_m_s)
    tilt = _smooth(stamps_s, knots_s[::2], rng.uniform(-1, 1, (len(knots_s[::2]), 2)))
    roll, pitch = (tilt * case.slope_rad * (stamps_s > 0.4 * case.duration_s)[:, None]).T
    model = MODELS[name]
    twists = model.twist(model.pack(case.values), Inputs(speeds, roll, pitch))
    path = dead_reckon_in_space(stamps_s, twists, roll, pitch, np.zeros(4)).plane
    chosen = slice(None, None, round(case.rate_hz / 10))
    noise = rng.standard_normal(path.poses[chosen].shape)
    x, y, yaw = (path.poses[chosen] + noise * [POSITION_M, POSITION_M, YAW_RAD]).T
    width = case.values.get("track_width", 0.5)
    odometry = {"t": stamps_s, "v_left": speeds[:, 0], "v_right": speeds[:, 1]}
    if case.slope_rad:
        odometry |= {"roll": roll, "pitch": pitch}
    tables = {"odometry": odometry, "pose": {"t": stamps_s[chosen], "x": x, "y": y, "yaw": yaw}}
    write_run_folder(folder, {"robot": {"track_width": width}}, tables)
    return Run.read(folder)


def _smooth(stamps_s: np.ndarray, knots_s: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Columns of values at knots, joined by straight lines."""
    return np.column_stack([np.interp(stamps_s, knots_s, column) for column in values.T])


def report(name: str, found: list[dict[str, tuple[float, float]]]) -> None:
    """Print how often the intervals cover the truth."""
    print(f"\n{name}: {len(found)} seeds")
    hits, count = 0, 0
    for parameter in found[0]:
        values, halves = np.array([seed[parameter] for seed in found]).T
        truth = CASES[name].values[parameter]
        if np.isnan(halves).any():
            low, high = np.percentile(values, [5, 95])
            print(f"  {parameter:12} {truth:10.5g}  by trial, 5-95 % {low:.3g} to {high:.3g}")
            continue
        inside = np.abs(values - truth) <= halves
        hits, count = hits + inside.sum(), count + len(inside)
        print(
            f"  {parameter:12} {truth:10.5g}  mean {values.mean():10.5g}  spread {values.std():.2g}"
            f"  stated {np.median(halves) / 1.96:.2g}  covered {inside.mean():.0%}"
        )
    interval = binomtest(int(hits), int(count)).proportion_ci()
    print(f"  all: {hits / count:.1%} [{interval.low:.1%}, {interval.high:.1%}]", flush=True)


def mu_on_flat_ground() -> str:
    """What the check says of `contact` on level ground at low speed."""
    values = CASES["contact"].values
    case = Case(values, speed_m_s=0.3, rate_hz=10.0, fixed=CASES["contact"].fixed)
    return "contact on level ground:\n" + _undetermined("contact", case)


def icrs_of_creeping_treads(speed_m_s: float) -> str:
    """What the check says of `icr` where the robot hardly moves."""
    case = Case(ICR, speed_m_s=speed_m_s)
    return f"icr at up to {speed_m_s:g} m/s:\n" + _undetermined("icr", case)


def _undetermined(name: str, case: Case) -> str:
    with tempfile.TemporaryDirectory() as scratch:
        run = drive(name, case, 0, Path(scratch) / "run")
        config = WindowConfig(
            horizon_m=min(2.0, 2 * case.speed_m_s),
            position_sigma_m=POSITION_M,
            yaw_sigma_rad=YAW_RAD,
        )
        found = identify([run], name, fixed=case.fixed, window_config=config)
    (ground,) = found.terrains.values()
    return "\n".join(f"  {open_.words()}" for open_ in ground.fit.undetermined) or "  all found"


if __name__ == "__main__":
    main()
