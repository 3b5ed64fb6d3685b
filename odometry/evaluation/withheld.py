"""Poses that are held out from a filter, so that its estimate can be evaluated with them.

Every JUDGED_EVERY_S one pose is used for evaluation, and no pose of the last SILENT_S before it is
given to the filter: poses that follow one another closely have similar errors, and an estimate
right after an update would be compared with the noise of that pose alone. What is evaluated is thus
the estimate SILENT_S after its last pose, or one period of the poses after it where they are
sparser. A delay of the poses is found and undone before, by all of them.
"""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.frames import POSE_COLUMNS
from odometry.run import Run
from odometry.trajectory import Trajectory

JUDGED_EVERY_S = 2.0
SILENT_S = 1.0


@dataclass(frozen=True)
class Withheld:
    """A run without some of its poses, and those of them that are used for evaluation.

    Attributes
    ----------
    run : Run
        x, y and yaw of the withheld rows are NaN: its frames keep their stamps.
    judged : Trajectory
        One held-out pose every JUDGED_EVERY_S; its yaw is NaN where none was measured.
    poses : int
        How many were withheld.
    """

    run: Run
    judged: Trajectory
    poses: int


def withhold(run: Run, begin_s: float, end_s: float) -> Withheld | None:
    """Remove poses of a run for evaluation; None where fewer than two are left for that.

    Parameters
    ----------
    run : Run
    begin_s, end_s : float
        First and last stamp of the replay: its first pose starts it and is never withheld.
    """
    if run.pose is None:
        return None
    poses = run.pose.stack(*POSE_COLUMNS)
    stamps_s = run.pose.stamps_s
    measured = np.isfinite(poses).any(axis=1) & (stamps_s >= begin_s) & (stamps_s <= end_s)
    rows = np.flatnonzero(measured)
    judged, kept = choose(stamps_s[rows])
    has_place = np.isfinite(poses[rows[judged], :2]).all(axis=1)
    judges = rows[judged][has_place]
    if len(judges) < 2:
        return None
    emptied = poses.copy()
    emptied[rows[~kept]] = np.nan
    columns = dict(run.pose.columns) | dict(zip(POSE_COLUMNS, emptied.T, strict=True))
    return Withheld(
        replace(run, pose=replace(run.pose, columns=columns)),
        Trajectory(stamps_s[judges], poses[judges]),
        int(np.sum(~kept)),
    )


def choose(stamps_s: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Which poses at increasing stamps (M,) are evaluated with, and which are given to the filter.

    The first is given, and so is at least one between two of the evaluation.
    """
    judged, given = np.zeros(len(stamps_s), dtype=np.bool_), np.ones(len(stamps_s), dtype=np.bool_)
    last_s, given_from = stamps_s[:1], 0  # last evaluation pose; at first, the start
    for row, stamp_s in enumerate(stamps_s):
        silent_from = int(np.searchsorted(stamps_s, stamp_s - SILENT_S, side="right"))
        if stamp_s - last_s[0] >= JUDGED_EVERY_S and silent_from > given_from:
            judged[row], given[silent_from : row + 1] = True, False
            last_s, given_from = stamps_s[row:], row + 1
    return judged, given
