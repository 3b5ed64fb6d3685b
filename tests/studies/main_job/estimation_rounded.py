"""Positions that were rounded: what steps do to estimates of real recordings.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.main_job.estimation_rounded [--held-out]

Positions of each recording in steps: 1/32 m and half a metre, as single precision leaves of
easting and northing, and 0.25, 0.5 and 1 m of both; with yaw and without it. A row for each: the
parameter that is farthest from that of the recording as it is, in deviations of both; how far the
estimate is from the poses that were rounded (second half), the share of it beyond three deviations,
of the yaw as well, and its deviation; the error of the odometer over that of the recording as it
is; events.
"""

import argparse
import warnings
from dataclasses import replace

import numpy as np

from odometry.geometry.angles import wrap
from odometry.recording.run import Run
from terrain.main_job import run_odometry
from tests.studies.main_job.estimation_recordings import motion

STEPS_M = ((0.03125, 0.5), (0.25, 0.25), (0.5, 0.5), (1.0, 1.0))
PARAMETERS = [3, 4, 5, 7, 8]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--held-out", action="store_true", help="every third recording")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    rng = np.random.default_rng(5)
    for number, file in enumerate(sorted(motion().glob("*/run.toml"))):
        run = Run.read(file.parent)
        if (number % 3 == 2) != options.held_out or run.pose is None:
            continue
        reference = run_odometry(run, vision=False)
        for steps_m in STEPS_M:
            for has_yaw in (True, False):
                result = run_odometry(rounded(run, steps_m, has_yaw, rng), vision=False)
                print(file.parent.name, *steps_m, "yaw" if has_yaw else "no yaw", end=" ")
                print(*(f"{value:.3g}" for value in figures(result, reference, run.pose)), end=" ")
                print(*sorted({event.kind for event in result.replay.events}), flush=True)


def rounded(run, steps_m, has_yaw, rng):
    """The run with positions on a grid that lies anywhere."""
    columns = dict(run.pose.columns)
    for name, step_m, shift in zip(("x", "y"), steps_m, rng.uniform(0, 1, 2), strict=True):
        columns[name] = (np.round(columns[name] / step_m + shift) - shift) * step_m
    if not has_yaw:
        columns["yaw"] = np.full(len(run.pose), np.nan)
    return replace(run, pose=replace(run.pose, columns=columns))


def figures(result, reference, poses):
    """Parameter, distance [m], shares beyond three deviations (place, yaw), deviation, odometer."""
    replay, usual = result.replay, reference.replay
    later = slice(len(replay.stamps_s) // 2, None)
    stamps_s, means, sigmas = replay.stamps_s[later], replay.means[later], replay.sigmas[later]
    apart = (means[-1] - usual.means[-1])[PARAMETERS]
    off = np.abs(apart) / np.hypot(sigmas[-1], usual.sigmas[-1])[PARAMETERS]
    true = [np.interp(stamps_s, poses.stamps_s, poses[name]) for name in ("x", "y")]
    off_m = np.hypot(*(means[:, :2].T - true))
    yaw = np.interp(stamps_s, poses.stamps_s, np.unwrap(poses["yaw"]))
    off_rad = np.abs(wrap(means[:, 2] - yaw))
    sigma_m = np.hypot(*sigmas[:, :2].T)
    per_m = [of.scores["odometer"].mean_translation_per_m for of in (result, reference)]
    beyond = np.mean(off_m > 3 * sigma_m), np.mean(off_rad > 3 * sigmas[:, 2])
    return (off.max(), np.sqrt(np.mean(off_m**2)), *beyond, np.median(sigma_m),
            per_m[0] / per_m[1])  # fmt: skip


if __name__ == "__main__":
    main()
