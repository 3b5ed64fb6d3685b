"""A gyroscope that repeats one value to the last digit while the treads turn the robot."""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian, turned_by_treads
from odometry.estimation.noise_scale import width_sigma_m
from odometry.estimation.transition import (
    GYRO_BIAS,
    STATES,
    Y_LEFT,
    Y_RIGHT,
    YAW,
)

SAME_RAD_S = 1e-9
HELD_S = 1.0  # for so long a value must repeat
EXCESS_RAD = 0.3  # by which the treads must turn otherwise, beyond what is allowed ...
SOUND, BANDED = (0.05, 0.03), (0.1, 0.1)  # ... in rad/s and as a share of speed over the width:
DEAD_BAND_RAD_S = 0.05  # the more in a band where a sound gyroscope may repeat its value, ...
NOISY_S = 10.0  # ... if it has not changed from sample to sample for so long
WIDTH_SIGMAS = 2.5  # ... besides what the uncertainty of the width explains


class GyroscopeHold(NamedTuple):
    """What is remembered of a value that repeats.

    Attributes
    ----------
    rate_rad_s : float
        The value; NaN before the first.
    same_since_s, off_since_s : float
        Stamps since when it repeats on one terrain, and since when the treads turn otherwise.
    before : (9,), (9, 9)
        State estimate at `same_since_s`.
    terrain : str
        In force then.
    excess_rad : float
        Sum of the differences beyond what is allowed; it never falls below zero (Page 1954,
        Biometrika 41: CUSUM).
    owed_rad : float
        Turn of the treads less that of the gyroscope since `off_since_s`.
    is_found : bool
        Whether the gyroscope is taken as silent.
    changing_s : float
        For how long, before the value, no value repeated for half of `HELD_S`.
    """

    rate_rad_s: float
    same_since_s: float
    off_since_s: float
    before: Gaussian
    terrain: str
    excess_rad: float = 0.0
    owed_rad: float = 0.0
    is_found: bool = False
    changing_s: float = 0.0


def watched(
    hold: GyroscopeHold | None,
    yaw_rate: float,
    begin_s: float,
    stamp_s: float,
    *,
    speeds_m_s: FloatArray,
    belief: Gaussian,
    terrain: str,
) -> GyroscopeHold:
    """The watch after a step from `begin_s` to `stamp_s` over which `yaw_rate` was recorded.

    Parameters
    ----------
    hold : GyroscopeHold or None
        None before the first step.
    yaw_rate : float
        [rad/s]; NaN where the gyroscope was silent.
    begin_s, stamp_s : float
    speeds_m_s : (2,)
        Tread speeds used over the step; NaN where they are not known.
    belief : (9,), (9, 9)
        At the beginning of the step.
    terrain : str
        In force then.
    """
    if hold is None:
        return _begun(yaw_rate, begin_s, belief, terrain, 0.0)
    if math.isnan(yaw_rate) and math.isnan(hold.rate_rad_s):
        return hold
    if not abs(yaw_rate - hold.rate_rad_s) <= SAME_RAD_S:
        same_s = begin_s - hold.same_since_s
        sound = same_s < HELD_S / 2 and not math.isnan(hold.rate_rad_s)
        changing_s = hold.changing_s + same_s if sound else 0.0
        return _begun(yaw_rate, begin_s, belief, terrain, changing_s)
    left, right = speeds_m_s.tolist()
    if hold.is_found or math.isnan(left + right):
        return hold
    if terrain != hold.terrain:
        return _begun(yaw_rate, begin_s, belief, terrain, hold.changing_s)
    if not hold.excess_rad:
        hold = hold._replace(off_since_s=begin_s, owed_rad=0.0)
    off_rad_s, allowed_rad_s = _difference(hold, left, right)
    step_s = stamp_s - begin_s
    excess_rad = hold.excess_rad + (abs(off_rad_s) - allowed_rad_s) * step_s
    return hold._replace(
        excess_rad=max(excess_rad, 0.0),
        owed_rad=hold.owed_rad + off_rad_s * step_s,
        is_found=excess_rad > EXCESS_RAD and stamp_s - hold.same_since_s > HELD_S,
    )


def repeats(hold: GyroscopeHold | None, begin_s: float) -> bool:
    """Whether the gyroscope may hold its value at a stamp: it repeats for half of `HELD_S`."""
    return hold is not None and begin_s - hold.same_since_s > HELD_S / 2


def _begun(
    yaw_rate: float, begin_s: float, belief: Gaussian, terrain: str, changing_s: float
) -> GyroscopeHold:
    """The watch of a value from the step on in which it came first."""
    return GyroscopeHold(yaw_rate, begin_s, begin_s, belief, terrain, 0.0, 0.0, False, changing_s)


def _difference(hold: GyroscopeHold, left: float, right: float) -> tuple[float, float]:
    """By how much treads and gyroscope differ, and what is allowed [rad/s]."""
    mean, covariance = hold.before
    width_m = float(mean[Y_LEFT] - mean[Y_RIGHT])
    by_treads = turned_by_treads(mean, left, right)
    by_gyroscope = hold.rate_rad_s - float(mean[GYRO_BIAS])
    may_repeat = abs(by_gyroscope) < DEAD_BAND_RAD_S and hold.changing_s < NOISY_S
    at_rest, share = BANDED if may_repeat else SOUND
    allowed = at_rest + share * (abs(left) + abs(right)) / 2 / width_m
    allowed += WIDTH_SIGMAS * width_sigma_m(covariance) / width_m * abs(by_treads)
    return by_treads - by_gyroscope, allowed


def forgotten(belief: Gaussian, hold: GyroscopeHold, begin_s: float, posed_s: float) -> Gaussian:
    """State estimate at `begin_s` without what was learned since the value began to repeat.

    The next step adds the turn that the gyroscope missed (`owed_rad`). Where a pose corrected the
    yaw in that time, last at `posed_s`, the yaw holds that turn already, and it is subtracted here.
    """
    then_mean, then_covariance = hold.before
    mean, covariance = np.append(belief[0][:3], then_mean[3:]), np.zeros((STATES, STATES))
    covariance[:3, :3] = belief[1][:3, :3]
    covariance[3:, 3:] = then_covariance[3:, 3:]
    covariance[YAW, YAW] += hold.owed_rad**2
    if posed_s > hold.same_since_s:
        mean[YAW] -= hold.owed_rad
    else:
        rate_rad_s = hold.rate_rad_s - float(then_mean[GYRO_BIAS])
        mean[YAW] = then_mean[YAW] + rate_rad_s * (begin_s - hold.same_since_s)
    return mean, covariance


def ended(hold: GyroscopeHold, stamp_s: float) -> tuple[FilterEvent, ...]:
    """The event of a value that repeated until a stamp."""
    if not hold.is_found:
        return ()
    text = (
        f"the gyroscope repeated {hold.rate_rad_s:.4f} rad/s to the last digit while the treads "
        "turned otherwise: it counted as silent, the treads turned the robot, and what was "
        "learned since was forgotten"
    )
    return (FilterEvent("gyroscope_held", hold.off_since_s, stamp_s, text),)
