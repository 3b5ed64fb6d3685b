"""Whose poses a file holds: of another drive, or of the reference itself, errors say nothing."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.evaluation.other_odometry import Judge
from odometry.trajectory import Trajectory
from terrain.other_odometry.shared_turns import (
    CONSTANT_RAD,
    TURNED_RAD,
    shared_pieces,
    turns_of,
)

MOVED_M = 1.0  # a reference that moves by less says nothing
MOST_SHIFT_S, STEP_S = 3.5, 0.1  # by which its stamps may be off and its turns still follow
FEWEST_COMPARED = 30  # turns, or poses; fewer do not show another drive
UNLIKE = 0.5  # correlation at the best shift: of 182 pairs of real drives 170 stay below
SAME_M = 1e-3  # no odometry follows a reference so closely over a metre and more
STAMP_DIGITS = 4  # after the point, of seconds: files round them


def of_another_drive(trajectory: Trajectory, judge: Judge) -> str:
    """A note where turns follow those of odometer and reference at no shift, else an empty text."""
    reference = judge.reference
    others = [judge.odometer]
    if np.isfinite(reference.poses[:, 2]).all():
        others.append(reference)
    best = -1.0
    for shift_s in np.arange(-MOST_SHIFT_S, MOST_SHIFT_S + STEP_S / 2, STEP_S):
        moved = Trajectory(trajectory.stamps_s + shift_s, trajectory.poses)
        best = max(best, *(_likeness(moved, other) for other in others))
        if best > UNLIKE:
            return ""
    return (
        f"its turns do not follow those of ours, whichever way its stamps are shifted by up to "
        f"{MOST_SHIFT_S:g} s (correlation {best:.2f} at best): the file is of another drive, its "
        "stamps are of another clock, or the program lost its way. Only in the last case its "
        "errors mean something; else give the file of this drive, with stamps of its clock"
    )


def of_the_reference(trajectory: Trajectory, judge: Judge) -> str:
    """A note where positions are those of the reference in any frame, else an empty text."""
    stamps, of_reference_s = (
        np.round(each.stamps_s, STAMP_DIGITS) for each in (trajectory, judge.reference)
    )
    _, rows, of_reference = np.intersect1d(stamps, of_reference_s, return_indices=True)
    own, known = trajectory.poses[rows, :2], judge.reference.poses[of_reference, :2]
    if len(rows) < FEWEST_COMPARED or np.ptp(known, axis=0).max() < MOVED_M:
        return ""
    if not _same_shape(own, known):
        return ""
    return (
        f"its positions are those of the reference within {1000 * SAME_M:g} mm: it is the "
        "reference, or was made of it, and its errors measure nothing. Give poses that were made "
        "without it"
    )


def _same_shape(own: FloatArray, known: FloatArray) -> bool:
    """Whether positions (K, 2) are others, moved and turned as a whole."""
    a, b = (np.asarray((each - each.mean(axis=0)) @ [1, 1j]) for each in (own, known))
    turn = np.exp(1j * np.angle(np.vdot(a, b)))
    return bool(np.abs(a * turn - b).max() <= SAME_M)


def _likeness(trajectory: Trajectory, other: Trajectory) -> float:
    """Correlation of the turns of two trajectories; 1 where these are too few or small to say."""
    rows = shared_pieces(trajectory, other)
    turns, ours = (turns_of(each, each.poses[:, 2], rows) for each in (trajectory, other))
    if len(ours) < FEWEST_COMPARED or np.ptp(np.cumsum(ours)) < TURNED_RAD:
        return 1.0
    turns = np.clip(turns, -np.abs(ours).max(), np.abs(ours).max())  # one jump is not a drive
    if min(np.ptp(turns), np.ptp(ours)) < CONSTANT_RAD:
        return 1.0
    return float(np.corrcoef(turns, ours)[0, 1])
