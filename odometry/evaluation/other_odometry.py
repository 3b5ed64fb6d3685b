"""Errors of the odometry of another program on a run that was replayed, by the same rules.

It is evaluated at the stamps of the reference that lie within its own, none of them in a gap; where
its poses are less than half as frequent as those of the reference, at its own, since a straight
line from one to the next is no odometry's error. It is placed at the filter's estimate at the first
of these, where our odometer starts as well. Nothing else is fitted. Its scale and its axes stay as
they are, and are only reported.
"""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray, usual_period_s
from odometry.errors import TrajectoryError
from odometry.evaluation.relative import (
    EvaluationConfig,
    RelativeErrors,
    position_errors,
    relative_errors,
)
from odometry.evaluation.score import Score, summary
from odometry.geometry import se2
from odometry.trajectory import Trajectory

LONGEST_GAP_S = 1.0  # between two poses; no straight line is drawn over a longer one
SPARSE = 2.0  # periods of the reference
LOST = 3.0  # periods of its own: after a longer gap its frame may be another


@dataclass(frozen=True)
class Judge:
    """What the trajectories of a run are evaluated with.

    Attributes
    ----------
    reference : Trajectory
        Yaw with whole turns counted, NaN where it was not measured.
    travel_m : (N,)
        Wheel travel at each of its stamps.
    believed, odometer : Trajectory
        Of the robot: the filter's poses, and our odometer.
    place_m : (2,)
        Where the reference's poses are taken, in the robot frame.
    config : EvaluationConfig
    """

    reference: Trajectory
    travel_m: FloatArray
    believed: Trajectory
    odometer: Trajectory
    place_m: FloatArray
    config: EvaluationConfig


@dataclass(frozen=True)
class OtherScore:
    """Errors of another odometry, and what its numbers hide.

    Attributes
    ----------
    score : Score
    ours : Score
        Of our odometer at the same stamps, from the same start.
    share : float
        Part of the reference's stamps at which it is evaluated; of sparse ones, that it spans.
    own_stamps : int
        At how many stamps of its own it is evaluated; 0 at those of the reference.
    scale : float
        By which its path would have to grow to fit the reference best.
    turned_rad : float
        By which its path would have to turn for the same.
    """

    score: Score
    ours: Score
    share: float
    scale: float
    turned_rad: float
    own_stamps: int = 0


def score_other(trajectory: Trajectory, judge: Judge) -> OtherScore:
    """Errors of another odometry of the robot.

    Raises
    ------
    TrajectoryError
        If it holds fewer than two stamps of the reference.
    """
    share = float(trajectory.covers(judge.reference.stamps_s).mean())
    own = _is_sparse(trajectory, judge.reference)
    longest_s = max(LONGEST_GAP_S, LOST * usual_period_s(trajectory.stamps_s)) if own else np.inf
    judge = _at_own_stamps(trajectory, judge) if own else judge
    stamps_s = judge.reference.stamps_s
    held = held_stamps(trajectory, stamps_s) & judge.believed.covers(stamps_s)
    held &= judge.odometer.covers(stamps_s)
    if held.sum() < 2:
        raise TrajectoryError(
            f"its stamps are of {trajectory.stamps_s[0]:.3f} to {trajectory.stamps_s[-1]:.3f} s, "
            f"those of the reference of {stamps_s[0]:.3f} to {stamps_s[-1]:.3f} s; fewer than two "
            f"of these lie within it and in no gap above {LONGEST_GAP_S:g} s"
        )
    placed = _placed(trajectory, judge, held)
    scale, turned_rad = similarity(
        placed.at(stamps_s[held]).poses[:, :2], judge.reference.poses[held, :2]
    )
    return OtherScore(
        _score(placed, judge, held, longest_s),
        _score(_placed(judge.odometer, judge, held), judge, held, longest_s),
        share if own else float(held.mean()),
        scale,
        turned_rad,
        int(held.sum()) if own else 0,
    )


def _is_sparse(trajectory: Trajectory, reference: Trajectory) -> bool:
    """Whether poses come less than half as often as those of a reference that holds some."""
    within = int(held_stamps(reference, trajectory.stamps_s).sum())
    return within > 1 and usual_period_s(trajectory.stamps_s) > SPARSE * usual_period_s(
        reference.stamps_s
    )


def _at_own_stamps(trajectory: Trajectory, judge: Judge) -> Judge:
    """The judge at the stamps of a trajectory that the reference holds."""
    reference = judge.reference
    stamps_s = trajectory.stamps_s[held_stamps(reference, trajectory.stamps_s)]
    columns = (*reference.poses.T, judge.travel_m)
    *poses, travel_m = (np.interp(stamps_s, reference.stamps_s, each) for each in columns)
    at_own = Trajectory(stamps_s, np.stack(poses, axis=-1))
    return replace(judge, reference=at_own, travel_m=travel_m)


def held_stamps(trajectory: Trajectory, stamps_s: FloatArray) -> BoolArray:
    """Which stamps (M,) lie within a trajectory and in none of its gaps."""
    own_s = trajectory.stamps_s
    after = np.clip(np.searchsorted(own_s, stamps_s), 1, len(own_s) - 1)
    near = (own_s[after] - own_s[after - 1] <= LONGEST_GAP_S) | np.isin(stamps_s, own_s)
    return np.asarray(trajectory.covers(stamps_s) & near)


def similarity(ours: FloatArray, true: FloatArray) -> tuple[float, float]:
    """Scale and turn [rad] that bring positions (N, 2) nearest to others (N, 2).

    Umeyama 1991 (IEEE PAMI 13(4), eq. 40 and 42) in the plane, by complex numbers: the least
    squares factor of centred positions. NaN where nothing moves.
    """
    a, b = (np.asarray((each - each.mean(axis=0)) @ [1, 1j]) for each in (ours, true))
    square = float(np.sum(np.abs(a) ** 2))
    if square == 0:
        return np.nan, np.nan
    factor = np.vdot(a, b) / square
    return float(np.abs(factor)), float(np.angle(factor))


def _placed(trajectory: Trajectory, judge: Judge, held: BoolArray) -> Trajectory:
    """A trajectory from the estimated pose at the first held stamp, at the reference's place."""
    first_s = judge.reference.stamps_s[held][:1]
    start = judge.believed.at(first_s).poses[0]
    moved = trajectory.moved(se2.compose(start, se2.inverse(trajectory.at(first_s).poses[0])))
    places = se2.transform(moved.poses, judge.place_m)
    return Trajectory(moved.stamps_s, np.column_stack([places, moved.poses[:, 2]]))


def _score(trajectory: Trajectory, judge: Judge, held: BoolArray, longest_s: float) -> Score:
    """Errors at held stamps; windows lie within stretches of these, none across a gap."""
    breaks = np.diff(judge.reference.stamps_s) > longest_s
    edges = np.flatnonzero((np.diff(held.astype(int)) != 0) | breaks) + 1
    stretches = [part for part in np.split(np.arange(len(held)), edges) if held[part[0]]]
    found = [_relative(trajectory, judge, part) for part in stretches]
    relative = RelativeErrors(
        *(
            np.concatenate([getattr(each, name) for each in found])
            for name in ("start_s", "translation_per_m", "rotation_per_m")
        )
    )
    of_held = Trajectory(judge.reference.stamps_s[held], judge.reference.poses[held])
    return summary(relative, position_errors(trajectory, of_held)[1])


def _relative(trajectory: Trajectory, judge: Judge, part: IntArray) -> RelativeErrors:
    reference = Trajectory(judge.reference.stamps_s[part], judge.reference.poses[part])
    return relative_errors(
        trajectory,
        reference,
        reference.stamps_s,
        judge.travel_m[part],
        judge.config,
        reference_yaw_rad=reference.poses[:, 2],
    )
