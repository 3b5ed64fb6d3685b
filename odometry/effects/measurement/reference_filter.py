"""References that smooth, lag or swing: their poses are filtered ones of the robot.

Each filter acts on the course of the poses in time. A robot does not know what comes, is not where
its yaw will lead it, and does not ring; but it may turn at once and move later, as it would with
positions that lag.
"""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from scipy.linalg import solve_banded

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter, MeasurementEffect
from odometry.effects.interface.recorded import Reported

GRID_S = 0.02  # of the oscillator
MOST_DAMPED = 0.5  # more is no ringing: a robot that slides may answer so
RAW_FIXES = "the fixes before the filter: of a robot that follows slowly they are late as well"
NO_INVERSE = "use the unfiltered fixes: what a filter took away does not come back"


class ReferenceFilter(MeasurementEffect):
    """A reference that filters its poses; the poses of the robot do not follow from them."""

    name = "reference_fault"
    of_reference = True
    by_pose = False
    remedy = NO_INVERSE


class SmoothedPoses(ReferenceFilter):
    """Each pose is the mean of those before and after it."""

    form = "smoothed"
    in_words = "poses of the reference that are smoothed over time"
    equation = "pose(t) -> mean of pose over t - span / 2 to t + span / 2"
    source = "moving average"
    looks_like = "corners that are cut, and turns that begin before the treads do"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("span", "s", 0.0, 6.0, 1.0, 0.05),)

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`; at the ends of a run the mean is of what there is."""
        half_s, stamps_s = values[0] / 2, reported.stamps_s
        if half_s <= 0:
            return poses
        mids = (poses[1:] + poses[:-1]) / 2 * np.diff(stamps_s)[:, None]
        summed = np.concatenate([np.zeros((1, 3)), np.cumsum(mids, axis=0)])
        begin_s = np.maximum(stamps_s - half_s, stamps_s[0])
        end_s = np.minimum(stamps_s + half_s, stamps_s[-1])
        sums = [_integral(summed, poses, stamps_s, at_s) for at_s in (end_s, begin_s)]
        return np.asarray((sums[0] - sums[1]) / (end_s - begin_s)[:, None])


class FilteredPositions(ReferenceFilter):
    """Positions follow with a first-order lag, the yaw does not."""

    form = "filtered_positions"
    in_words = "positions of the reference that follow slowly, with a yaw that does not"
    equation = "lag d(x, y)_seen/dt = (x, y) - (x, y)_seen"
    source = "first-order lag"
    looks_like = "a robot at the position of a moment ago, with the heading of now"
    mimicked_by = "a robot that turns at once and follows slowly"
    alike: ClassVar[Mapping[str, str]] = {
        "time_offset": "quick changes of speed: a lag rounds them, late stamps do not",
        "inertia": RAW_FIXES,
    }

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("lag", "s", 0.0, 3.0, 0.3, 0.02),)

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`."""
        slow = _lagged(poses[:, :2], reported.stamps_s, float(values[0]))
        return np.concatenate([slow, poses[:, 2:]], axis=1)


class SlowYaw(ReferenceFilter):
    """The yaw follows with a first-order lag, positions do not."""

    form = "slow_yaw"
    in_words = "a yaw of the reference that follows slowly, with positions that do not"
    equation = "lag d(yaw)_seen/dt = yaw - yaw_seen"
    source = "first-order lag"
    looks_like = "a robot that goes sideways in turns, outward, the more the faster it turns"
    mimicked_by = "a robot that slides outward in turns"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("lag", "s", 0.0, 3.0, 0.3, 0.02),)

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`."""
        slow = _lagged(poses[:, 2:], reported.stamps_s, float(values[0]))
        return np.concatenate([poses[:, :2], slow], axis=1)


class SwayingMast(ReferenceFilter):
    """An antenna on a mast that bends against the acceleration, and rings."""

    form = "swaying_mast"
    in_words = "an antenna on a mast that sways"
    equation = "s'' + 2 damping f s' + f^2 s = -bend f^2 (x, y)'';  (x, y) -> (x, y) + s"
    source = "oscillator of second order"
    looks_like = "positions that swing after each change of speed, while yaw and treads do not"
    remedy = "stiffen the mast, or measure with the antenna low"

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: a mast rings."""
        return bool(values[2] <= MOST_DAMPED)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`; `bend` is the lean [m] per m/s^2 of acceleration."""
        return (
            EffectParameter("bend", "s2", 0.0, 1.0, 0.05, 0.005),
            EffectParameter("frequency", "rad/s", 1.0, 15.0, 5.0, 0.2, None),
            EffectParameter("damping", "", 0.01, 2.0, 0.2, 0.05, None),
        )

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`; by the bilinear transform, at rest before the first."""
        from scipy.signal import lfilter, lfilter_zi  # noqa: PLC0415 - slow to load

        bend, frequency, damping = values
        square, rate = frequency**2, 2 * damping * frequency
        below = _bilinear(1.0, rate, square)
        numbers = _bilinear(1 - bend * square, rate, square) / below[0], below / below[0]
        stamps_s = reported.stamps_s
        grid_s = np.arange(stamps_s[0], stamps_s[-1] + GRID_S, GRID_S)
        rest = lfilter_zi(*numbers)
        seen = poses.copy()
        for column in range(2):
            course = np.interp(grid_s, stamps_s, poses[:, column])
            swung = lfilter(*numbers, course, zi=rest * course[0])[0]
            seen[:, column] = np.interp(stamps_s, grid_s, swung)
        return seen


def _bilinear(second: float, first: float, constant: float) -> FloatArray:
    """Coefficients (3,) in 1, 1/z, 1/z^2 of a polynomial in s = 2 / GRID_S (1 - 1/z) / (1 + 1/z).

    Times (1 + 1/z)^2.
    """
    rate = 2 / GRID_S
    square, turn = second * rate**2, first * rate
    return np.array([square + turn + constant, 2 * (constant - square), square - turn + constant])


def _integral(
    summed: FloatArray, poses: FloatArray, stamps_s: FloatArray, at_s: FloatArray
) -> FloatArray:
    """Integral (M, 3) of poses, linear between their stamps, from the first to each moment (M,)."""
    row = np.clip(np.searchsorted(stamps_s, at_s, side="right") - 1, 0, len(stamps_s) - 2)
    into_s = at_s - stamps_s[row]
    slope = (poses[row + 1] - poses[row]) / (stamps_s[row + 1] - stamps_s[row])[:, None]
    return np.asarray(summed[row] + (poses[row] + slope * into_s[:, None] / 2) * into_s[:, None])


def _lagged(course: FloatArray, stamps_s: FloatArray, lag_s: float) -> FloatArray:
    """First-order lag of a course (M, C) that is linear between its stamps, exact there."""
    if lag_s <= 0 or len(course) < 2:
        return course
    spans = np.diff(stamps_s) / lag_s
    decay, share = np.exp(-spans), -np.expm1(-spans) / spans
    driven = (share - decay)[:, None] * course[:-1] + (1 - share)[:, None] * course[1:]
    recursion = np.stack([np.ones(len(course)), np.append(-decay, 0.0)])
    return np.asarray(solve_banded((1, 0), recursion, np.vstack([course[:1], driven])))
