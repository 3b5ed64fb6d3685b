"""Real recordings with their yaw column emptied, beside the same with full poses.

    python -m tests.studies.identification.positions [--model icr] [RUN ...]

For each recording of data/motion (TERRAIN_ODOMETRY_DATA names the folder of shared recordings):
the held-out error over windows of 2 m, each half by the other (evaluated with the full poses), and
the root mean square error of the whole run reckoned open loop with the model identified on all
of it, as a share of its length, its start and direction laid over the measured ones. Rows: full
poses; positions alone with the gyroscope, with the treads alone, with one position in a second,
and with 0.3 m of noise; and the ideal differential drive.
"""

import argparse
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.comparison.split import halves, parts_by_terrain
from odometry.errors import OdometryError
from odometry.identification.fitters import fitter
from odometry.identification.start import SolverConfig
from odometry.identification.stretch_fit import windows_or_stretches
from odometry.models.base import KinematicModel
from odometry.models.catalogue import MODELS
from odometry.recording.run import Run
from odometry.recording.run_terrains import with_named_terrain
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.record import position_record_of
from odometry.windows.stretches.stretch_motion import rotations
from odometry.windows.travel.motion import level_path
from odometry.windows.travel.windows import windows_of
from odometry.windows.window_errors import window_errors

MOTION = Path(os.environ.get("TERRAIN_ODOMETRY_DATA", "")) / "motion"
CONFIG = WindowConfig()
IDEAL = MODELS["differential_drive"]


def emptied(run: Run, hz: float = np.inf, noise_m: float = 0.0) -> Run:
    """Positions alone, at most so many in a second, with noise added."""
    period_s = float(np.median(np.diff(run.pose.stamps_s)))
    pose = run.pose.rows(slice(None, None, max(1, round(1 / (hz * period_s)))))
    columns = {name: column for name, column in pose.columns.items() if name != "window"}
    rng = np.random.default_rng(0)
    for name in ("x", "y"):
        columns[name] = columns[name] + noise_m * rng.standard_normal(len(pose))
    columns["yaw"] = np.full(len(pose), np.nan)
    return replace(run, pose=replace(pose, columns=columns))


def without_gyroscope(run: Run) -> Run:
    """The run as if it had none."""
    columns = {k: c for k, c in run.odometry.columns.items() if k != "gyro_z"}
    return replace(run, imu=None, odometry=replace(run.odometry, columns=columns))


ROWS: dict[str, Callable[[Run], Run]] = {
    "full poses": lambda run: run,
    "positions, gyroscope": emptied,
    "positions, treads": lambda run: without_gyroscope(emptied(run)),
    "1 Hz, gyroscope": lambda run: emptied(run, hz=1.0),
    "1 Hz, treads": lambda run: without_gyroscope(emptied(run, hz=1.0)),
    "0.3 m, gyroscope": lambda run: emptied(run, noise_m=0.3),
}


def fitted(run: Run, model: str) -> np.ndarray:
    """Parameters of a model identified on a run."""
    fit = fitter(
        MODELS[model],
        run.robot,
        fixed={},
        window_config=CONFIG,
        solver_config=SolverConfig(starts=2),
    )
    return fit(windows_or_stretches([run], CONFIG)).packed


def held_out(model: KinematicModel, values: np.ndarray, run: Run) -> np.ndarray:
    """Mean errors (2,) over windows of full poses: m per m and degrees per m."""
    columns = {name: column for name, column in run.pose.columns.items() if name != "window"}
    windows = windows_of([replace(run, pose=replace(run.pose, columns=columns))], CONFIG)
    errors = window_errors(model, values, windows)
    return np.array([errors.translation_per_m.mean(), np.degrees(errors.rotation_per_m.mean())])


def loop_error(model: KinematicModel, values: np.ndarray, run: Run) -> float:
    """RMS error of the whole run reckoned open loop, as a share of its length."""
    record = position_record_of(run, CONFIG)
    twists = model.twist(values, record.inputs)
    path = level_path(twists, np.append(np.diff(record.stamps_s), 0.0), record.inputs)
    ways = path[record.pose_samples, :2] - path[record.pose_samples[0], :2]
    measured = record.poses[:, :2] - record.poses[0, :2]
    turn = rotations(ways[None, 1:], measured[None, 1:])[0]
    turned = ways @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    length_m = np.hypot(*np.diff(measured[::10], axis=0).T).sum()
    return float(np.sqrt(np.mean(np.sum((turned - measured) ** 2, axis=1))) / length_m)


def report(name: str, model: str) -> None:
    """Print the rows of one recording."""
    run = with_named_terrain(Run.read(MOTION / name), None)
    part = next(iter(parts_by_terrain(run, name).values()))
    first, second = (half.cut() for half in halves(part))
    width = np.array([run.robot.track_width])
    ideal = np.mean([held_out(IDEAL, width, half) for half in (first, second)], axis=0)
    print(name)
    rows = {"ideal drive": (ideal, loop_error(IDEAL, width, run))}
    for label, made in ROWS.items():
        try:
            errors = np.mean(
                [
                    held_out(MODELS[model], fitted(made(train), model), test)
                    for train, test in ((first, second), (second, first))
                ],
                axis=0,
            )
            rows[label] = errors, loop_error(MODELS[model], fitted(made(run), model), run)
        except OdometryError as error:
            print(f"  {label:22} {str(error).splitlines()[0][:90]}")
    for label, (errors, loop) in rows.items():
        print(
            f"  {label:22} {errors[0]:.3f} m/m  {errors[1]:6.2f} deg/m  loop {loop:6.2%}",
            flush=True,
        )


def main() -> None:
    """Run the study and print its rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--model", default="icr")
    parser.add_argument("runs", nargs="*")
    given = parser.parse_args()
    every = sorted(folder.parent.name for folder in MOTION.glob("*/pose.csv"))
    for name in given.runs or every:
        report(name, given.model)


if __name__ == "__main__":
    main()
