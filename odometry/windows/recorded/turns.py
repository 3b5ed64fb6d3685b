"""Whole turns between measured poses, counted by the gyroscope or by the treads.

A measured yaw gives a turn but for whole turns. The number of these between two poses is the one
that is nearest to a predicted turn, and it is known where the prediction, with its bound, stays
within half a turn of it. Three predictions are used in this order:

- the gyroscope, less its bias, where it agrees with turns that poses measured;
- the difference of the tread speeds over an effective width, found from the same turns;
- no turn, with the bound that no robot turns twice as fast as treads that do not slip, or faster
  than the treads' difference turned it elsewhere in the run.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.geometry.angles import wrap
from odometry.recording.run import Run
from odometry.recording.sensors import Gyroscope, gyroscope_of
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.recorded.measured_poses import (
    FASTEST,
    LEAST_PAIRS,
    POSE_RAD,
    ClosePairs,
    TreadTravel,
    close_pairs,
    fastest_rad,
    tread_travel,
    unseen,
)
from odometry.windows.recorded.robust import slope, spread

LEAST_TURN = 0.1  # of that of treads that do not slip: less, or to the other side, is no width


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
        resolved = ~known & (np.abs(predicted - measured - whole) + bound < np.pi)
        turned[resolved] += whole[resolved]
        known |= resolved
        if known.all():
            break
    return Turns(yaw_rad[0] + np.append(0.0, np.cumsum(turned)), known)


def _predictions(
    run: Run, stamps_s: FloatArray, yaw_rad: FloatArray
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Turns (M - 1,) between neighbours, and how far each may be off, the best first."""
    width_m, travel, gyroscope = (
        run.robot.track_width,
        tread_travel(run),
        gyroscope_of(run.yaw_rate),
    )
    gaps_s = odometry_gaps(run).spans_s
    pairs = close_pairs(travel, width_m, stamps_s, yaw_rad, gaps_s)
    if gyroscope is not None:
        by_gyroscope = turns_by_gyroscope(gyroscope, pairs, stamps_s, yaw_rad)
        if by_gyroscope is not None:
            yield by_gyroscope
    rad_per_m = turn_per_metre(travel, pairs)
    of_ideal = 0.0 if rad_per_m is None else rad_per_m * width_m
    not_seen = unseen(travel, gaps_s, stamps_s[:-1], stamps_s[1:])
    if rad_per_m is not None and LEAST_TURN < of_ideal < FASTEST:
        turn, bound = turns_by_treads(travel, pairs, stamps_s, rad_per_m)
        yield turn, np.where(not_seen, np.inf, bound)
    fastest = fastest_rad(travel, width_m, stamps_s[:-1], stamps_s[1:]) * max(1.0, abs(of_ideal))
    yield np.zeros(len(fastest)), np.where(not_seen, np.inf, fastest + POSE_RAD)


QUANTILE, MARGIN = 0.95, 2.0  # of the errors of close pairs, to what they may be elsewhere
LEAST_SHARE = 0.1  # of all that the treads travel by the width: what may be off


def turn_per_metre(travel: TreadTravel, pairs: ClosePairs) -> float | None:
    """Turn [rad] by a metre of tread difference; None where the pairs turned too little."""
    difference_m = travel.between(pairs.begin_s, pairs.end_s)[1]
    if not pairs.tell_a_scale or np.count_nonzero(difference_m) < LEAST_PAIRS:
        return None
    return slope(pairs.turned_rad, difference_m)


def turns_by_treads(
    travel: TreadTravel, pairs: ClosePairs, stamps_s: FloatArray, rad_per_m: float
) -> tuple[FloatArray, FloatArray]:
    """Turns (M - 1,) between stamps (M,), and how far each may be off."""
    _, difference_m, _, gross_m = travel.between(pairs.begin_s, pairs.end_s)
    errors = np.abs(pairs.turned_rad - rad_per_m * difference_m)
    shares = errors / (rad_per_m * gross_m + POSE_RAD)
    share = max(LEAST_SHARE, MARGIN * float(np.quantile(shares, QUANTILE)))
    _, difference_m, _, gross_m = travel.between(stamps_s[:-1], stamps_s[1:])
    return rad_per_m * difference_m, POSE_RAD + share * rad_per_m * gross_m


SCALES = (0.8, 1.25)  # of a gyroscope that can be right
UNLIKE = 0.3  # of all turns measured: what one of these scales may leave
SCALE_OFF = 0.03  # by a rad turned: what is left open of its scale
DRIFT_RAD_S = 0.005  # of its bias over a run
SIGMAS = 3.0  # of what scatters
# Where close pairs determine neither, most turns of so many must agree but for counts; a bias as
# large as this, of a fault, turns by half a turn unnoticed in longer gaps.
LARGEST_BIAS_RAD_S = 0.1
AGREES_FROM_RAD, LEAST_AGREEING, AGREEING = 0.6, 10, 0.8


@dataclass(frozen=True)
class _Calibration:
    """Bias and scale of a gyroscope, how far they may be off, and measured yaws.

    `unlike` is the share of measured turns that it did not measure.
    """

    bias_rad_s: float
    bias_off_rad_s: float
    scale: float
    scale_off: float
    pose_rad: float
    unlike: float


def turns_by_gyroscope(
    gyroscope: Gyroscope, pairs: ClosePairs, stamps_s: FloatArray, yaw_rad: FloatArray
) -> tuple[FloatArray, FloatArray] | None:
    """Turns and bounds; None of a gyroscope that turns another way than measured yaws."""
    turn, gross, off, silent_s = gyroscope.between(stamps_s[:-1], stamps_s[1:])
    known, longest_s = _calibrated(gyroscope, pairs), np.inf
    if known is None:
        longest_s = np.pi / LARGEST_BIAS_RAD_S
        here = (silent_s == 0) & (gross > AGREES_FROM_RAD)
        off_rad = wrap(np.diff(yaw_rad) - turn)[here]
        if len(off_rad) < LEAST_AGREEING or np.mean(np.abs(off_rad) < np.pi / 4) < AGREEING:
            return None
        known = _calibration(turn[here], turn[here] + off_rad, np.diff(stamps_s)[here])
    if known.unlike > UNLIKE or not SCALES[0] < known.scale < SCALES[1]:
        return None
    lasts_s = np.diff(stamps_s)
    bound = known.pose_rad + off + known.scale_off * gross + known.bias_off_rad_s * lasts_s
    unknown = (silent_s > 0) | (lasts_s > longest_s)
    return turn - known.bias_rad_s * lasts_s, np.where(unknown, np.inf, bound)


def _calibrated(gyroscope: Gyroscope, pairs: ClosePairs) -> _Calibration | None:
    """Scale and bias of a gyroscope by the pairs; None where they are few or turned too little."""
    turn, _, _, silent_s = gyroscope.between(pairs.begin_s, pairs.end_s)
    known = pairs.where(silent_s == 0)
    if not known.tell_a_scale:
        return None
    return _calibration(turn[silent_s == 0], known.turned_rad, known.end_s - known.begin_s)


def _calibration(turn: FloatArray, turned: FloatArray, lasts_s: FloatArray) -> _Calibration:
    """Of turns (K,) by the gyroscope and by yaws over times (K,)."""
    bias = slope(turn - turned, lasts_s)
    scale = slope(turned, turn - bias * lasts_s)
    errors = turn - bias * lasts_s - turned
    scattered_rad_s = spread((turn - turned) / lasts_s) / np.sqrt(len(turn))
    return _Calibration(
        bias,
        DRIFT_RAD_S + SIGMAS * scattered_rad_s,
        scale,
        abs(scale - 1) + SCALE_OFF,
        POSE_RAD + SIGMAS * spread(errors),
        float(np.abs(errors).sum() / np.abs(turned).sum()),
    )
