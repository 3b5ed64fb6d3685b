"""Whole turns between measured poses, counted by the gyroscope or by the treads.

A measured yaw tells a turn but for whole turns. The number of these between two poses is the one
that is nearest to a predicted turn, and it is known where the prediction, with its bound, stays
within half a turn of it. Three predictions are asked in this order:

- the gyroscope, less its bias, where it agrees with turns that poses measured;
- the difference of the tread speeds over an effective width, found from the same turns;
- no turn, with the bound that no robot turns twice as fast as treads that do not slip.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.geometry.angles import wrap
from odometry.run import Run
from odometry.windows.gaps import odometry_gaps
from odometry.windows.gyroscope import Gyroscope, gyroscope_of
from odometry.windows.robust import slope, spread
from odometry.windows.spans import touched
from odometry.windows.tread_travel import TreadTravel, tread_travel

FASTEST = 2.0  # times the turn of treads that do not slip: the stated width may be twice too large
SKEWED = 0.1  # of the treads' travel by the width: a turn while both treads are as fast
POSE_RAD = 0.2  # by which measured yaws may be off
CLOSE_S = 5.0  # longest pair from which something is learned
LEAST_PAIRS = 8
LEAST_TURNED_RAD = 2.0  # over all pairs: less tells no scale
SCALES = (0.8, 1.25)  # of a gyroscope that can be right
SCALE_RAD = 0.03  # by a rad turned: what is left open of its scale
UNKNOWN_SCALE, UNKNOWN_BIAS_RAD_S = 0.1, 0.1  # where poses tell neither
DRIFT_RAD_S = 0.005  # of its bias over a run
WIDTHS = (0.1, FASTEST)  # turn of the treads, in turns of the stated width
WIDTH_QUANTILE, WIDTH_MARGIN, LEAST_SHARE = 0.95, 2.0, 0.1


@dataclass(frozen=True)
class Turns:
    """The yaw of M poses, continuous over whole turns.

    Attributes
    ----------
    yaw_rad : (M,)
        Not wrapped; where turns are not known, the shorter way.
    known : (M - 1,)
        Whether the whole turns from a pose to the next are known.
    """

    yaw_rad: FloatArray
    known: BoolArray


@dataclass(frozen=True)
class _Pairs:
    """Turns (C,) that measured yaws tell by themselves, from stamps (C,) to others."""

    begin_s: FloatArray
    end_s: FloatArray
    turned_rad: FloatArray


def continuous_yaw(run: Run) -> FloatArray:
    """Yaw (M,) of the rows of pose.csv without wraps; NaN where it was not measured."""
    if run.pose is None:
        return np.empty(0)
    measured = np.isfinite(run.pose["yaw"])
    yaw = np.full(len(measured), np.nan)
    if measured.any():
        yaw[measured] = counted_turns(
            run, run.pose.stamps_s[measured], run.pose["yaw"][measured]
        ).yaw_rad
    return yaw


def counted_turns(run: Run, stamps_s: FloatArray, yaw_rad: FloatArray) -> Turns:
    """Count the whole turns between yaws that were measured on a run.

    Parameters
    ----------
    run : Run
    stamps_s, yaw_rad : (M,)
        Measured yaws at increasing stamps; one or more.
    """
    measured = wrap(np.diff(yaw_rad))
    turned, known = measured.copy(), np.zeros(len(measured), dtype=np.bool_)
    for predicted, bound in _predictions(run, stamps_s, yaw_rad):
        whole = 2 * np.pi * np.round((predicted - measured) / (2 * np.pi))
        told = ~known & (np.abs(predicted - measured - whole) + bound < np.pi)
        turned[told] += whole[told]
        known |= told
        if known.all():
            break
    return Turns(yaw_rad[0] + np.append(0.0, np.cumsum(turned)), known)


def _predictions(
    run: Run, stamps_s: FloatArray, yaw_rad: FloatArray
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Turns (M - 1,) between neighbours, and how far each may be off, the best first."""
    width_m, travel, gyroscope = run.robot.track_width, tread_travel(run), gyroscope_of(run)
    gaps_s = odometry_gaps(run).spans_s
    pairs = _close_pairs(travel, width_m, stamps_s, yaw_rad, gaps_s)
    begin_s, end_s = stamps_s[:-1], stamps_s[1:]
    if gyroscope is not None:
        ideal = travel.between(begin_s, end_s)[1] / width_m
        by_gyroscope = _by_gyroscope(gyroscope, pairs, begin_s, end_s, ideal)
        if by_gyroscope is not None:
            yield by_gyroscope
    unseen = _unseen(travel, gaps_s, begin_s, end_s)
    by_treads = _by_treads(travel, width_m, pairs, begin_s, end_s)
    if by_treads is not None:
        yield by_treads[0], np.where(unseen, np.inf, by_treads[1])
    fastest = _fastest_rad(travel, width_m, begin_s, end_s) + POSE_RAD
    yield np.zeros(len(begin_s)), np.where(unseen, np.inf, fastest)


def _fastest_rad(
    travel: TreadTravel, width_m: float, begin_s: FloatArray, end_s: FloatArray
) -> FloatArray:
    """The largest turns (K,) that treads of half the stated width could make."""
    _, _, difference_m, gross_m = travel.between(begin_s, end_s)
    return np.asarray((FASTEST * difference_m + SKEWED * gross_m) / width_m)


def _unseen(
    travel: TreadTravel, gaps_s: FloatArray, begin_s: FloatArray, end_s: FloatArray
) -> BoolArray:
    """Whether treads were not recorded at some time from stamps (K,) to others."""
    outside = (begin_s < travel.stamps_s[0]) | (end_s > travel.stamps_s[-1])
    return np.asarray(outside | touched(gaps_s, begin_s, end_s))


def _close_pairs(
    travel: TreadTravel,
    width_m: float,
    stamps_s: FloatArray,
    yaw_rad: FloatArray,
    gaps_s: FloatArray,
) -> _Pairs:
    """Poses end to end, as far apart as treads of half the width turn less than half a turn."""
    turn = _fastest_rad(travel, width_m, np.full(len(stamps_s), stamps_s[0]), stamps_s)
    reached = np.searchsorted(turn, turn + np.pi - POSE_RAD) - 1
    in_time = np.searchsorted(stamps_s, stamps_s + CLOSE_S, side="right") - 1
    last = np.minimum(reached, in_time)
    ends, at = [], 0
    while at < len(stamps_s) - 1:
        if last[at] > at:
            ends.append((at, int(last[at])))
        at = max(int(last[at]), at + 1)
    begin, end = np.array(ends, dtype=np.int64).reshape(-1, 2).T
    seen = ~_unseen(travel, gaps_s, stamps_s[begin], stamps_s[end])
    begin, end = begin[seen], end[seen]
    return _Pairs(stamps_s[begin], stamps_s[end], wrap(yaw_rad[end] - yaw_rad[begin]))


def _by_gyroscope(
    gyroscope: Gyroscope,
    pairs: _Pairs,
    begin_s: FloatArray,
    end_s: FloatArray,
    ideal_rad: FloatArray,
) -> tuple[FloatArray, FloatArray] | None:
    """Turns and bounds; None where it turns another way than the treads (ideal, without slip)."""
    turn, gross, off, silent_s = gyroscope.between(begin_s, end_s)
    lasts_s = end_s - begin_s
    heard = (silent_s == 0) & (ideal_rad != 0)
    if heard.sum() < LEAST_PAIRS:
        return None
    if not WIDTHS[0] < slope(turn[heard], ideal_rad[heard]) < WIDTHS[1]:
        return None
    found = _bias_and_scale(gyroscope, pairs)
    if found is None:
        return None
    bias, bias_off, scale_off, pose_rad = found
    bound = pose_rad + off + scale_off * gross + bias_off * lasts_s
    return turn - bias * lasts_s, np.where(silent_s > 0, np.inf, bound)


def _bias_and_scale(
    gyroscope: Gyroscope, pairs: _Pairs
) -> tuple[float, float, float, float] | None:
    """Bias [rad/s], how far it may be off, that of the scale, and of measured yaws [rad].

    None where the pairs tell a scale that is not that of rad/s; where they turned too little to
    tell one, what may be expected of any gyroscope.
    """
    turn, _, _, silent_s = gyroscope.between(pairs.begin_s, pairs.end_s)
    heard = silent_s == 0
    if heard.sum() < LEAST_PAIRS or np.abs(pairs.turned_rad[heard]).sum() < LEAST_TURNED_RAD:
        return 0.0, UNKNOWN_BIAS_RAD_S, UNKNOWN_SCALE, POSE_RAD
    lasts_s = (pairs.end_s - pairs.begin_s)[heard]
    turn, turned = turn[heard], pairs.turned_rad[heard]
    bias = slope(turn - turned, lasts_s)
    scale = slope(turned, turn - bias * lasts_s)
    if not SCALES[0] < scale < SCALES[1]:
        return None
    bias_off = DRIFT_RAD_S + 3 * spread((turn - turned) / lasts_s) / np.sqrt(len(turn))
    pose_rad = POSE_RAD + 3 * spread(turn - turned - bias * lasts_s)
    return bias, float(bias_off), abs(scale - 1) + SCALE_RAD, pose_rad


def _by_treads(
    travel: TreadTravel,
    width_m: float,
    pairs: _Pairs,
    begin_s: FloatArray,
    end_s: FloatArray,
) -> tuple[FloatArray, FloatArray] | None:
    """Turns and bounds; None where measured turns tell no width, or one that cannot be."""
    _, difference_m, _, gross_m = travel.between(pairs.begin_s, pairs.end_s)
    turned = pairs.turned_rad
    if len(turned) < LEAST_PAIRS or np.abs(turned).sum() < LEAST_TURNED_RAD:
        return None
    if np.count_nonzero(difference_m) < LEAST_PAIRS:
        return None
    rad_per_m = slope(turned, difference_m)
    if not WIDTHS[0] < rad_per_m * width_m < WIDTHS[1]:
        return None
    errors = np.abs(turned - rad_per_m * difference_m) / (rad_per_m * gross_m + POSE_RAD)
    share = max(LEAST_SHARE, WIDTH_MARGIN * float(np.quantile(errors, WIDTH_QUANTILE)))
    _, difference_m, _, gross_m = travel.between(begin_s, end_s)
    return rad_per_m * difference_m, POSE_RAD + share * rad_per_m * gross_m
