"""A run as an identification sees it: inputs that hold between stamps, and measured poses."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.grounds import terrains_of
from odometry.models.inputs import Inputs
from odometry.models.run_inputs import inputs_of
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.errors import WindowError

GAP_PERIODS = 5.0  # stamps farther apart than this many usual periods are a gap


@dataclass(frozen=True)
class Record:
    """Samples of one run: the stamps of odometry and of its poses, merged.

    Attributes
    ----------
    run : Run
    stamps_s : (N,)
    inputs : Inputs
        Of stack (N,), each in force until the next stamp.
    travel_m : (N,)
        Wheel travel up to each stamp.
    poses : (M, 3)
        Measured x, y, yaw.
    pose_samples : (M,)
        The sample at which each pose was measured.
    stretch : (M,)
        Number of the stretch without gap, change of `window` or of terrain in which a pose lies.
    terrains : (M,) of str
        Terrain at each pose.
    """

    run: Run
    stamps_s: FloatArray
    inputs: Inputs
    travel_m: FloatArray
    poses: FloatArray
    pose_samples: IntArray
    stretch: IntArray
    terrains: AnyArray


def record_of(run: Run, config: WindowConfig) -> Record:
    """Merge odometry and poses of a run.

    Raises
    ------
    WindowError
        If the run has no two measured poses within the time of its odometry.
    """
    odometry_s = run.odometry.stamps_s
    poses, pose_s, windows = _measured_poses(run)
    inside = (pose_s >= odometry_s[0]) & (pose_s <= odometry_s[-1])
    if inside.sum() < 2:
        raise WindowError(
            f"{run.folder}: {int(inside.sum())} measured poses within the time of odometry.csv, "
            "expected two or more: an identification needs pose.csv"
        )
    poses, pose_s, windows = poses[inside], pose_s[inside], windows[inside]
    stamps_s = np.unique(np.concatenate([odometry_s, pose_s]))
    rows = np.searchsorted(odometry_s, stamps_s, side="right") - 1
    inputs = replace(inputs_of(run).rows(rows), time_s=stamps_s - odometry_s[0])
    speed = np.abs(inputs.tread_speeds_m_s).mean(axis=1)
    travel_m = np.concatenate([[0.0], np.cumsum(speed[:-1] * np.diff(stamps_s))])
    samples = np.searchsorted(stamps_s, pose_s)
    terrains = terrains_of(run)[rows]
    changes = np.concatenate([[0], np.cumsum(terrains[1:] != terrains[:-1])])[samples]
    breaks = (
        (np.diff(pose_s) > max(config.pose_gap_s, GAP_PERIODS * np.median(np.diff(pose_s))))
        | (windows[1:] != windows[:-1])
        | (changes[1:] != changes[:-1])
        | _odometry_gap_between(odometry_s, pose_s)
    )
    stretch = np.concatenate([[0], np.cumsum(breaks)])
    return Record(run, stamps_s, inputs, travel_m, poses, samples, stretch, terrains[samples])


def _measured_poses(run: Run) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Poses (M, 3), their stamps (M,) and source windows (M,), without rows of missing cells."""
    if run.pose is None:
        return np.empty((0, 3)), np.empty(0), np.empty(0)
    poses = run.pose.stack("x", "y", "yaw")
    measured = np.isfinite(poses).all(axis=1)
    windows = run.pose["window"] if "window" in run.pose.columns else np.zeros(len(poses))
    return poses[measured], run.pose.stamps_s[measured], np.nan_to_num(windows)[measured]


def _odometry_gap_between(odometry_s: FloatArray, pose_s: FloatArray) -> BoolArray:
    """Whether an odometry gap (M - 1,) lies between a pose and the next."""
    periods_s = np.diff(odometry_s)
    gap = np.concatenate([[False], periods_s > GAP_PERIODS * np.median(periods_s)])
    gaps_before = np.cumsum(gap)
    behind = np.searchsorted(odometry_s, pose_s[:-1], side="right") - 1
    ahead = np.searchsorted(odometry_s, pose_s[1:])
    return np.asarray(gaps_before[ahead] > gaps_before[behind])
