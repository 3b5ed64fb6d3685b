"""What the check says of measured velocities, right ones and wrong ones, and what they do to `run`.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.recordings.check_velocities [--run RECORDING]

Real recordings with poses: the velocity of each is that of its poses over half a second, in the
robot's axes, at 2 to 20 Hz and with noise of 0.02 to 0.15 m/s. It is given as it is, and wrong in
one way, with the poses and without. A line for each way: how often which finding is named. With
`--run` instead the error of the filter on one recording by each, with the velocities believed.
"""

import argparse
import os
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.recording import check_recording
from odometry.checks.velocity.velocity import VELOCITY_FAULTS
from odometry.recording.run import Run
from odometry.tables.table import Table
from terrain.main_job import run_odometry

RATES_HZ, NOISES_M_S, TURN_NOISE_RAD_S = (2.0, 5.0, 10.0, 20.0), (0.02, 0.05, 0.15), 0.01
OVER_S = 0.5
SCORES = ("odometer", "estimate")


@dataclass(frozen=True)
class Velocity:
    """Velocities (N, 2) in the axes of the robot and of the map, and turns (N,)."""

    stamps_s: FloatArray
    of_robot: FloatArray
    of_map: FloatArray
    turn: FloatArray


def measured(run: Run, rate_hz: float, noise_m_s: float, seed: int) -> Velocity:
    """The velocity by the poses of a run."""
    assert run.pose is not None
    rng, pose_s = np.random.default_rng(seed), run.pose.stamps_s
    at_s = np.arange(pose_s[0] + OVER_S, pose_s[-1] - OVER_S, 1 / rate_hz)
    columns = run.pose["x"], run.pose["y"], np.unwrap(run.pose["yaw"])
    vx, vy, turn = (
        (np.interp(at_s + OVER_S / 2, pose_s, of) - np.interp(at_s - OVER_S / 2, pose_s, of))
        / OVER_S
        for of in columns
    )
    yaw = np.interp(at_s, pose_s, columns[2])
    ahead, left = vx * np.cos(yaw) + vy * np.sin(yaw), vy * np.cos(yaw) - vx * np.sin(yaw)
    of_robot = np.stack([ahead, left], -1) + noise_m_s * rng.standard_normal((len(at_s), 2))
    turn = turn + TURN_NOISE_RAD_S * rng.standard_normal(len(at_s))
    return Velocity(at_s, of_robot, np.stack([vx, vy], -1), turn)


WRONG: dict[str, Callable[[Velocity], Velocity]] = {
    "as it is": lambda of: of,
    "km/h": lambda of: replace(of, of_robot=3.6 * of.of_robot),
    "degrees per second": lambda of: replace(of, turn=np.degrees(of.turn)),
    "a sensor mounted backwards": lambda of: replace(of, of_robot=-of.of_robot),
    "axes with z down": lambda of: replace(of, of_robot=of.of_robot * [1, -1], turn=-of.turn),
    "along the axes of the map": lambda of: replace(of, of_robot=of.of_map),
    "vx and vy exchanged": lambda of: replace(of, of_robot=of.of_robot[:, ::-1]),
    "zeros": lambda of: replace(of, of_robot=0 * of.of_robot, turn=0 * of.turn),
    "0.4 s late": lambda of: replace(of, stamps_s=of.stamps_s + 0.4),
}


def with_velocity(run: Run, of: Velocity) -> Run:
    """The run with a velocity.csv."""
    vx, vy = of.of_robot.T
    columns = {"t": of.stamps_s, "vx": vx, "vy": vy, "wz": of.turn}
    return replace(run, velocity=Table(Path("velocity.csv"), columns, np.arange(len(vx)) + 2))


def recordings() -> Iterator[Run]:
    """Those with poses."""
    for folder in sorted((Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion").iterdir()):
        if (folder / "pose.csv").exists():
            yield Run.read(folder)


def main() -> None:
    """Print what is named, or what a run ends up with."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--run", help="name of a recording")
    arguments = parser.parse_args()
    if arguments.run:
        errors(next(run for run in recordings() if run.folder.name == arguments.run))
        return
    counts: Counter[tuple[str, str, str]] = Counter()
    for number, run in enumerate(recordings()):
        of = measured(run, RATES_HZ[number % 4], NOISES_M_S[number % 3], number)
        for words, change in WRONG.items():
            wrong = with_velocity(run, change(of))
            for beside, one in (("poses", wrong), ("no poses", replace(wrong, pose=None))):
                names = {f.name for f in check_recording(one).findings if f.name in VELOCITY_FAULTS}
                counts[words, beside, ", ".join(sorted(names)) or "silent"] += 1
    for (words, beside, names), count in counts.items():
        print(f"{words}, {beside}: {names} {count}")


def errors(run: Run) -> None:
    """Errors of the filter with the velocities believed, m per m of wheel travel."""
    of = measured(run, 5.0, 0.03, 0)
    runs = {"none": run} | {name: with_velocity(run, of_it(of)) for name, of_it in WRONG.items()}
    for words, one in runs.items():
        scores = run_odometry(one).scores
        said = (
            f"{name} {scores[name].mean_translation_per_m:.3f}" for name in ("odometer", "estimate")
        )
        print(f"{words}: {', '.join(said)}")


if __name__ == "__main__":
    main()
