"""Interpolated poses: the filter with each of them as a measured pose, or with all as one.

    python -m tests.studies.main_job.estimation_interpolated

Needs TERRAIN_ODOMETRY_DATA. Poses of eight recordings, the first of each second (or two), and
positions and yaws at 10 Hz on straight lines between them. Means and, of NEES, medians over the
recordings: distance of the estimate from all recorded poses, NEES of its pose (3 is right), error
of the odometer over 5 m of wheel travel per metre. The last row has no line at all.
"""

import argparse
from dataclasses import replace

import numpy as np

from odometry.estimation.config import IcrEkfConfig
from odometry.geometry.angles import wrap
from odometry.preparation.pose_noise import with_pose_noise
from odometry.recording.run import Run
from tests.studies.main_job.estimation_noise import RECORDINGS, errors, replayed
from tests.studies.main_job.estimation_recordings import motion

PERIODS_S, GRID_S = (1.0, 2.0), 0.1


def main():
    argparse.ArgumentParser(description=__doc__).parse_args()
    print("period [s], poses: estimate [m], median NEES of it, odometer [m per m]")
    for period_s in PERIODS_S:
        rows = np.array([figures(Run.read(motion() / name), period_s) for name in RECORDINGS])
        for way, of in enumerate(("each as measured", "together as one", "measured ones alone")):
            off_m, per_m, nees = rows[:, way].T
            print(f"{period_s:g} {of:20s}: {off_m.mean():.3f} {np.median(nees):6.1f} "
                  f"{per_m.mean():.4f}", flush=True)  # fmt: skip


def figures(run, period_s):
    """(3, 3) errors of estimate and odometer, and NEES."""
    stamps_s, poses = thinned(run, period_s)
    grid_s = np.arange(stamps_s[0], stamps_s[-1], GRID_S)
    lines = np.column_stack([np.interp(grid_s, stamps_s, column) for column in poses.T])
    filled, alone = with_poses(run, grid_s, lines), with_poses(run, stamps_s, poses)
    usual = IcrEkfConfig()
    ways = ((filled, usual), (filled, with_pose_noise(filled, usual)[0]), (alone, usual))
    replays = [replayed(run, of, config) for of, config in ways]
    return [(*errors(*of), pose_nees(*of)) for of in replays]


def thinned(run, period_s):
    beats = np.floor((run.pose.stamps_s - run.pose.stamps_s[0]) / period_s)
    first = np.r_[True, np.diff(beats) > 0]
    poses = run.pose.stack("x", "y", "yaw")[first]
    poses[:, 2] = np.unwrap(poses[:, 2])
    return run.pose.stamps_s[first], poses


def with_poses(run, stamps_s, poses):
    columns = dict(zip(("x", "y"), poses.T, strict=False))
    return replace(
        run, pose=replace(run.pose, columns={"t": stamps_s, **columns, "yaw": wrap(poses[:, 2])})
    )


def pose_nees(result, true, settled):
    off = result.numbers("mean", columns=slice(0, 3))[settled] - true[settled]
    off[:, 2] = wrap(off[:, 2])
    covariances = result.pose_covariances[settled]
    return np.einsum("ni,nij,nj->n", off, np.linalg.inv(covariances), off).mean()


if __name__ == "__main__":
    main()
