"""Treads that turn the robot much less than the gyroscope reads, or to the other side.

Slip makes treads turn more than the robot does, not less. So a tread reports what is not its own
speed (a driver that mirrors an encoder, channels that are exchanged, a sign that is lost), or the
robot slides on by itself: no speed is known, and nothing is learned of it.
"""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian, tread_yaw_rate, turned_by_treads
from odometry.estimation.transition import (
    ALPHA_LEFT,
    ALPHA_RIGHT,
    GYRO_BIAS,
    X_ICR,
    Y_LEFT,
    Y_RIGHT,
    YAW,
    X,
    Y,
)
from odometry.estimation.watches.rest_watch import STILL_M_S

SMOOTH_S = 0.3  # over which speeds and yaw rates are averaged: a body follows its treads
SHARE = 0.5  # of the turn of the gyroscope, which treads must reach, less what follows
AT_REST_RAD_S = 0.05
BY_SPEED = 0.1  # of speed over width
SIGMAS = 2.5  # of ICRs and slip factors
FOUND_RAD, MOST_RAD = 0.3, 0.6  # a sum of what is missing: no speed is known; it grows no more
SLOW_S = 20.0  # within which it must be found: else ICRs are learned
MOST_S = 20.0  # in all, until as many seconds of turns agree: then ICRs or slip factors are others
SLIP = 100.0  # factor on the variance of slip meanwhile: as much as the way itself
OF_TREADS = np.array([Y_LEFT, Y_RIGHT, X_ICR, ALPHA_LEFT, ALPHA_RIGHT])
OF_THE_REST = np.array([X, Y, YAW, GYRO_BIAS])
Rates = tuple[float, float, float]


class ContraryTreads(NamedTuple):
    """What is remembered of treads against the gyroscope.

    Attributes
    ----------
    rates : (left [m/s], right [m/s], yaw rate [rad/s])
        Averaged; NaN where one of them is not known.
    terrain : str
        In force.
    found_s : float
        For how long no speed was known, less the time of turns that agreed.
    is_believed : bool
        Whether that was for too long, and the treads are believed until it is 0.
    since_s : float
        Stamp since when turns of the treads are missing; NaN where none are.
    before : (9,), (9, 9) or None
        State estimate then.
    missing_rad, travel_m : float
        Sum of these turns, from 0 to `MOST_RAD`, and the way of the treads meanwhile.
    is_found : bool
        Whether no speed is known.
    """

    rates: Rates
    terrain: str
    found_s: float = 0.0
    is_believed: bool = False
    since_s: float = math.nan
    before: Gaussian | None = None
    missing_rad: float = 0.0
    travel_m: float = 0.0
    is_found: bool = False


def stepped(
    watch: ContraryTreads | None,
    begin_s: float,
    stamp_s: float,
    *,
    speeds_m_s: FloatArray,
    yaw_rate: float,
    belief: Gaussian,
    terrain: str,
) -> tuple[ContraryTreads | None, tuple[FilterEvent, ...]]:
    """The watch after a step, and the event of a stretch that ended there.

    Parameters
    ----------
    watch : ContraryTreads or None
    begin_s, stamp_s : float
    speeds_m_s : (2,)
        Tread speeds used over the step; NaN where they are not known.
    yaw_rate : float
        Of the gyroscope over it [rad/s]; NaN where there is none.
    belief, terrain : ((9,), (9, 9)), str
        At its beginning.
    """
    left, right = speeds_m_s.tolist()
    is_known = not math.isnan(left + right + yaw_rate)
    was_known = watch is not None and not math.isnan(sum(watch.rates))
    if not is_known and not was_known:
        return watch, ()
    if watch is None or watch.terrain != terrain or not (is_known and was_known):
        return _begun(watch, (left, right, yaw_rate), terrain), ended(watch, begin_s)
    step_s = stamp_s - begin_s
    share = step_s / (SMOOTH_S + step_s)
    was_left, was_right, was_rate = watch.rates
    rates = (
        was_left + share * (left - was_left),
        was_right + share * (right - was_right),
        was_rate + share * (yaw_rate - was_rate),
    )
    before = belief if watch.before is None else watch.before
    missing_rad_s = _missing_rad_s(before, rates, are_same=left == right)
    found_s, is_believed = watch.found_s, watch.is_believed
    if watch.is_found:
        found_s += step_s
        is_believed = found_s > MOST_S
    elif found_s and missing_rad_s < -AT_REST_RAD_S:
        found_s = max(found_s - step_s, 0.0)
        is_believed &= found_s > 0
    missing_rad = watch.missing_rad + missing_rad_s * step_s
    is_slow = not watch.is_found and begin_s - watch.since_s > SLOW_S
    if missing_rad <= 0 or is_believed or is_slow:
        return ContraryTreads(rates, terrain, found_s, is_believed), ended(watch, stamp_s)
    return ContraryTreads(
        *(rates, terrain, found_s, False),
        since_s=begin_s if watch.before is None else watch.since_s,
        before=before,
        missing_rad=min(missing_rad, MOST_RAD),
        travel_m=watch.travel_m + (abs(left) + abs(right)) / 2 * step_s,
        is_found=watch.is_found or missing_rad > FOUND_RAD,
    ), ()


def _begun(watch: ContraryTreads | None, rates: Rates, terrain: str) -> ContraryTreads:
    """A watch that begins, also after a gap: what was found before counts to `MOST_S`."""
    if watch is None:
        return ContraryTreads(rates, terrain)
    return ContraryTreads(rates, terrain, watch.found_s, watch.is_believed)


def _missing_rad_s(before: Gaussian, rates: Rates, *, are_same: bool) -> float:
    """By how much treads turn less than they must [rad/s].

    Treads whose speeds are the same to the last digit must reach all of the turn. It is
    -AT_REST_RAD_S where nothing turns, and less where treads turn enough.
    """
    left, right, yaw_rate = rates
    mean, covariance = before
    speed_m_s = (abs(left) + abs(right)) / 2
    turned = yaw_rate - mean.item(GYRO_BIAS)
    if speed_m_s <= STILL_M_S or abs(turned) < AT_REST_RAD_S:
        return -AT_REST_RAD_S
    allowed = AT_REST_RAD_S
    if not are_same:
        allowed += BY_SPEED * speed_m_s / (mean.item(Y_LEFT) - mean.item(Y_RIGHT))
        if abs(turned) < allowed:
            return -AT_REST_RAD_S
    asked = turned_by_treads(mean, left, right)
    agreed = math.copysign(asked, asked * turned)
    missing = (1.0 if are_same else SHARE) * abs(turned) - agreed
    if missing <= allowed:
        return min(missing - allowed, -AT_REST_RAD_S)
    by_state = tread_yaw_rate(mean, np.array([left, right]), yaw_rate).by_state
    sigma = math.sqrt(max(float(by_state.dot(covariance).dot(by_state)), 0.0))
    return max(missing - allowed - SIGMAS * sigma, 0.0)


def parted(belief: Gaussian, watch: ContraryTreads, *, newly_found: bool) -> Gaussian:
    """State estimate of which a pose corrects pose and bias, no ICR and no slip factor.

    Once it is found, these are as they were before turns were missing, and the place is less
    certain by the way since then.
    """
    mean, covariance = belief[0].copy(), belief[1].copy()
    if newly_found and watch.before is not None:
        then_mean, then_covariance = watch.before
        mean[3:], covariance[3:, 3:] = then_mean[3:], then_covariance[3:, 3:]
        covariance[:3, 3:], covariance[3:, :3] = 0.0, 0.0
        covariance[X, X] += watch.travel_m**2
        covariance[Y, Y] += watch.travel_m**2
    covariance[np.ix_(OF_THE_REST, OF_TREADS)] = 0.0
    covariance[np.ix_(OF_TREADS, OF_THE_REST)] = 0.0
    return mean, covariance


def ended(watch: ContraryTreads | None, stamp_s: float) -> tuple[FilterEvent, ...]:
    """The event of a stretch that was found."""
    if watch is None or not watch.is_found:
        return ()
    text = (
        "the treads turned the robot by less than half of what the gyroscope read, or to the other "
        "side: a tread reported what was not its own speed, the robot slid on by itself, or the "
        "gyroscope erred; the ICRs were not updated"
    )
    return (FilterEvent("contrary_treads", watch.since_s, stamp_s, text),)
