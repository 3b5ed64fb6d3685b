"""How often 95 % intervals hold the truth: by duration, pose rate, dropouts and model.

    python -m tests.studies.identification.coverage [--seeds 500] [--model icr] [--stated 1.0]
        [--wander 0.0]
        [--duration S ...] [--runs 1]

Each seed is a drive of its own: commands that hold for 0.8 to 2.5 s and are reached along ramps,
integrated by fourth-order steps of the twist in continuous time (no code of the packages), read
by encoders at 50 Hz and by a gyroscope, and by poses with 1 cm and 0.3 degrees of noise that do
not share the encoders' stamps. Dropouts lose one pose in ten, and one second in twelve whole.
`--stated` says how many times larger the noise is stated than it is; `--wander` adds slip that
the model does not have (relative size, over about 3 s). `--runs` cuts the time into that many runs.
A run counts as refused where `identify` would write nothing.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.errors import OdometryError
from odometry.identification.fitters import fitter
from odometry.identification.plausibility import refusals
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of

POSITION_M, YAW_RAD = 0.01, np.radians(0.3)
ICR = {"y_left": 0.45, "y_right": -0.38, "x_icr": 0.04, "alpha_left": 0.96, "alpha_right": 0.93}
TRUTHS = {
    "icr": ICR,
    "icr_symmetric": {"alpha": 0.94, "b_hat": 0.83},
}
SYMMETRIC = {
    "y_left": 0.415,
    "y_right": -0.415,
    "x_icr": 0.0,
    "alpha_left": 0.94,
    "alpha_right": 0.94,
}
ENCODER_HZ = 50.0
DURATIONS_S = (10.0, 13.0, 20.0, 30.0, 120.0)
POSE_HZ = (1.0, 2.0, 10.0)


@dataclass(frozen=True)
class Cell:
    """One row of the table."""

    model: str
    duration_s: float
    pose_hz: float
    dropouts: bool
    stated: float = 1.0
    wander: float = 0.0
    runs: int = 1


def speeds_at(times_s: np.ndarray, rng: np.random.Generator, end_s: float) -> np.ndarray:
    """Tread speeds (N, 2) at any times: held, then reached along ramps of 0.4 s."""
    changes_s, values = [0.0], [np.zeros(2)]
    while changes_s[-1] < end_s:
        forward, turn = rng.uniform(-0.3, 1.0), rng.uniform(-1.0, 1.0)
        speeds = np.array([forward - 0.4 * turn, forward + 0.4 * turn])
        changes_s += [changes_s[-1] + 0.4, changes_s[-1] + 0.4 + rng.uniform(0.8, 2.5)]
        values += [speeds, speeds]
    return np.column_stack(
        [np.interp(times_s, changes_s, column) for column in np.transpose(values)]
    )


def true_path(
    speeds: np.ndarray, gains: np.ndarray, values: dict[str, float], step_s: float
) -> tuple[np.ndarray, np.ndarray]:
    """Poses (N, 3) and yaw rates (N,): Runge-Kutta in steps of two rows of `speeds` each."""
    left, right = (speeds * gains * [values["alpha_left"], values["alpha_right"]]).T
    width = values["y_left"] - values["y_right"]
    omega = (right - left) / width
    forward = (right * values["y_left"] - left * values["y_right"]) / width
    sideways = -values["x_icr"] * omega
    # Simpson's rule is the fourth-order step: the right hand side depends on time and yaw alone,
    # and the yaw is the integral of a known function of time.
    middle = (5 * omega[:-2:2] + 8 * omega[1:-1:2] - omega[2::2]) * step_s / 12
    whole = (omega[:-2:2] + 4 * omega[1:-1:2] + omega[2::2]) * step_s / 3
    yaw = np.zeros(len(omega))
    yaw[2::2] = np.cumsum(whole)
    yaw[1::2] = yaw[:-2:2] + middle
    v_x = np.cos(yaw) * forward - np.sin(yaw) * sideways
    v_y = np.sin(yaw) * forward + np.cos(yaw) * sideways
    at = [
        np.concatenate([[0.0], np.cumsum((v[:-2:2] + 4 * v[1:-1:2] + v[2::2]) * step_s / 3)])
        for v in (v_x, v_y)
    ]
    return np.column_stack([*at, yaw[::2]]), omega[::2]


def drive(cell: Cell, seed: int, number: int) -> Run:
    """One recorded run of a cell."""
    rng = np.random.default_rng([seed, number, round(10 * cell.duration_s), round(cell.pose_hz)])
    duration_s = cell.duration_s / cell.runs
    fine_s = np.arange(round(duration_s * 400) + 1) / 400  # rows at and between whole steps
    fine_s = fine_s[: len(fine_s) - (len(fine_s) + 1) % 2]
    speeds = speeds_at(fine_s, rng, duration_s)
    knots_s = np.arange(0.0, duration_s + 6.0, 3.0)
    gains = 1 + cell.wander * np.column_stack(
        [np.interp(fine_s, knots_s, rng.standard_normal(len(knots_s))) for _ in range(2)]
    )
    values = ICR if cell.model == "icr" else SYMMETRIC
    path, omega = true_path(speeds, gains, values, 1 / 400)
    every_s, speeds = fine_s[::2], speeds[::2]

    rows = slice(None, None, round(200 / ENCODER_HZ))
    held = np.add.reduceat(speeds, np.arange(0, len(speeds), round(200 / ENCODER_HZ)))
    counts = np.diff(np.append(np.arange(0, len(speeds), round(200 / ENCODER_HZ)), len(speeds)))
    odometry = {"t": every_s[rows], "v_left": held[:, 0] / counts, "v_right": held[:, 1] / counts}
    if seed % 2:
        odometry["gyro_z"] = omega[rows] + 0.005 * rng.standard_normal(len(omega[rows]))

    pose_s = np.arange(rng.uniform(0, 1 / cell.pose_hz), duration_s, 1 / cell.pose_hz)
    if cell.dropouts:
        whole = np.isin(pose_s.astype(int), rng.choice(int(duration_s) + 1, int(duration_s) // 12))
        pose_s = pose_s[(rng.random(len(pose_s)) > 0.1) & ~whole]
    poses = np.column_stack([np.interp(pose_s, every_s, column) for column in path.T])
    poses += rng.standard_normal(poses.shape) * [POSITION_M, POSITION_M, YAW_RAD]
    poses[:, 2] = np.remainder(poses[:, 2] + np.pi, 2 * np.pi) - np.pi
    pose = {"t": pose_s, **dict(zip(("x", "y", "yaw"), poses.T, strict=True))}
    folder = Path(f"run_{number}")
    return Run(
        folder,
        Robot(track_width=0.6),
        {},
        Table(folder / "odometry.csv", odometry, np.arange(len(odometry["t"])) + 2),
        Table(folder / "pose.csv", pose, np.arange(len(pose_s)) + 2),
    )


def intervals_of(cell: Cell, seed: int) -> dict[str, tuple[float, float]] | None:
    """95 % intervals by parameter; None where the runs are refused."""
    config = WindowConfig(
        position_sigma_m=cell.stated * POSITION_M, yaw_sigma_rad=cell.stated * YAW_RAD
    )
    runs = [drive(cell, seed, number) for number in range(cell.runs)]
    try:
        fit = fitter(
            MODELS[cell.model],
            runs[0].robot,
            fixed={},
            window_config=config,
            solver_config=SolverConfig(starts=2),
        )(windows_of(runs, config))
    except OdometryError:
        return None
    if fit.undetermined or refusals(fit):
        return None
    return {name: (of.low, of.high) for name, of in fit.intervals.items()}


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=500)
    parser.add_argument("--model", action="append", choices=list(TRUTHS))
    parser.add_argument("--duration", type=float, action="append")
    parser.add_argument("--stated", type=float, default=1.0)
    parser.add_argument("--wander", type=float, default=0.0)
    parser.add_argument("--runs", type=int, default=1)
    given = parser.parse_args()
    print("model            s   Hz dropouts  covered  refused  by parameter; median widths")
    for model in given.model or TRUTHS:
        for duration_s in given.duration or DURATIONS_S:
            for pose_hz in POSE_HZ:
                for dropouts in (False, True):
                    cell = Cell(
                        model, duration_s, pose_hz, dropouts, given.stated, given.wander, given.runs
                    )
                    report(cell, given.seeds)


def report(cell: Cell, seeds: int) -> None:
    """Print one row."""
    found = [intervals_of(cell, seed) for seed in range(seeds)]
    told = [each for each in found if each is not None]
    truth = TRUTHS[cell.model]
    inside = {
        name: [low <= truth[name] <= high for each in told for low, high in [each[name]]]
        for name in truth
        if told
    }
    widths = [np.median([each[name][1] - each[name][0] for each in told]) for name in inside]
    print(
        f"{cell.model:13} {cell.duration_s:4g} {cell.pose_hz:4g} "
        f"{'yes' if cell.dropouts else 'no':>8}"
        f"  {np.mean([hit for hits in inside.values() for hit in hits]):6.1%}"
        f"  {1 - len(told) / seeds:6.1%}  "
        + " ".join(f"{n} {np.mean(hits):.0%}" for n, hits in inside.items())
        + "  "
        + " ".join(f"{width:.3g}" for width in widths),
        flush=True,
    )


if __name__ == "__main__":
    main()
