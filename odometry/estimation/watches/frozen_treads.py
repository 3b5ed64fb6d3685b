"""Treads that keep their speeds and turn the robot, while the gyroscope says it does not turn.

The log holds its last values, or the robot is blocked: no speed is known, as in a gap.
"""

import math
from typing import NamedTuple

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian
from odometry.estimation.transition import (
    ALPHA_LEFT,
    ALPHA_RIGHT,
    GYRO_BIAS,
    Y_LEFT,
    Y_RIGHT,
    YAW,
    X,
    Y,
)
from odometry.recording.frames import Frame

FROZEN_S = 2.0  # for so long the gyroscope must say so
# By which treads differ in a turn; and by more than their mean speed: treads that differ by less go
# straight on where one is scaled wrongly.
TURNS_M_S = 0.15
STANDS = 0.2  # share of their turn, up to which the robot does not turn


class FrozenTreads(NamedTuple):
    """A stretch in which they do, or may do.

    Attributes
    ----------
    since_s : float
    belief : (9,), (9, 9)
        State estimate then, with the turn by the gyroscope since.
    is_found : bool
        Whether it has lasted for long enough.
    """

    since_s: float
    belief: Gaussian
    is_found: bool = False


def stepped(
    watch: FrozenTreads | None,
    frame: Frame,
    begin_s: float,
    *,
    speeds_m_s: FloatArray,
    yaw_rate: float,
    belief: Gaussian,
    before: Gaussian,
) -> tuple[FrozenTreads | None, tuple[FilterEvent, ...]]:
    """The watch after the step to a frame, and the event of a stretch that ended there.

    Parameters
    ----------
    watch : FrozenTreads or None
    frame : Frame
    begin_s : float
        Stamp of the beginning of the step.
    speeds_m_s : (2,)
        Tread speeds over the step, which are those of all steps since `watch.since_s`.
    yaw_rate : float
        Of the gyroscope over the step [rad/s]; NaN where there is none.
    belief : (9,), (9, 9)
        State estimate at its beginning.
    before : (9,), (9, 9)
        That when the treads took these speeds: they have changed bias and ICRs since.
    """
    left, right = speeds_m_s.tolist()
    if frame.in_gap or math.isnan(left + right):
        return None, ended(watch, begin_s)
    mean = before[0] if watch is None else watch.belief[0]
    if not _stands(mean, left, right, yaw_rate) and (watch is None or not watch.is_found):
        return None, ()
    if watch is None:
        watch = FrozenTreads(begin_s, _with_pose(before, belief))
    watch = _later(watch, begin_s, frame.stamp_s, yaw_rate)
    if (frame.tread_speeds_m_s == speeds_m_s).all():
        return watch, ()
    return None, ended(watch, frame.stamp_s)


def _stands(mean: FloatArray, left: float, right: float, yaw_rate: float) -> bool:
    """Whether the treads turn on the spot and the gyroscope reads, less its bias, no turn."""
    asked = mean.item(ALPHA_RIGHT) * right - mean.item(ALPHA_LEFT) * left
    if abs(asked) <= TURNS_M_S or abs(asked) <= abs(left + right) / 2:
        return False
    turned = (mean.item(Y_LEFT) - mean.item(Y_RIGHT)) * (yaw_rate - mean.item(GYRO_BIAS))
    return abs(turned) < STANDS * abs(asked)


def _with_pose(before: Gaussian, belief: Gaussian) -> Gaussian:
    """A state estimate with the pose of another one, uncorrelated with the rest."""
    mean, covariance = before[0].copy(), before[1].copy()
    mean[:3] = belief[0][:3]
    covariance[:3, 3:], covariance[3:, :3] = 0.0, 0.0
    covariance[:3, :3] = belief[1][:3, :3]
    return mean, covariance


def _later(watch: FrozenTreads, begin_s: float, end_s: float, yaw_rate: float) -> FrozenTreads:
    mean = watch.belief[0].copy()
    if not math.isnan(yaw_rate):
        mean[YAW] += (yaw_rate - float(mean[GYRO_BIAS])) * (end_s - begin_s)
    is_found = end_s - watch.since_s >= FROZEN_S
    return FrozenTreads(watch.since_s, (mean, watch.belief[1]), is_found)


def restored(watch: FrozenTreads, stamp_s: float, position_density: float) -> Gaussian:
    """State estimate without what the treads changed since the stretch began.

    The position is less certain, by a density [m^2/s]; the yaw is so by the gyroscope's bias.
    """
    mean, covariance = watch.belief[0].copy(), watch.belief[1].copy()
    lasts_s = stamp_s - watch.since_s
    covariance[X, X] += position_density * lasts_s
    covariance[Y, Y] += position_density * lasts_s
    covariance[YAW, YAW] += float(covariance[GYRO_BIAS, GYRO_BIAS]) * lasts_s**2
    return mean, covariance


def ended(watch: FrozenTreads | None, stamp_s: float) -> tuple[FilterEvent, ...]:
    """The event of a stretch that was found."""
    if watch is None or not watch.is_found:
        return ()
    text = (
        "both treads kept their speeds while the gyroscope read that the robot does not turn: the "
        "log held its last values, or the robot was blocked or its wheels spun; neither the bias "
        "of the gyroscope nor the ICRs were updated, and the position is not known well"
    )
    return (FilterEvent("treads_frozen", watch.since_s, stamp_s, text),)
