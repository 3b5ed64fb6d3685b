"""What the filter found of the gyroscope's bias, and whether the gyroscope shows it at rest."""

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.transition import GYRO_BIAS, YAW
from odometry.estimation.watches.rest_watch import SETTLED_S, STILL_M_S
from odometry.geometry.angles import wrap
from odometry.replays.estimates import Replay

BIAS_RAD_S, BIAS_SIGMAS = 0.005, 4.0  # 0.3 degrees per second
REST_SIGMAS = 2.0  # of a bias, by which the gyroscope at rest may read otherwise besides
DRIFT_RAD_S = 0.02  # four standard deviations of a bias that counts as found
KNOWN_BIAS_RAD_S = 0.005  # standard deviation from which on the bias is one that was found
FOLLOWED_SIGMAS = 2.0  # of the bias, by which one that was followed may be off in the mean
REST_S = 2.0  # of rest that says what the gyroscope reads without a turn
CONTRADICTED_RAD_S = 0.01  # by which an estimated bias may differ from that
BACK, BACK_SHARE = 3, 0.2  # corrections to one value within a share of what was estimated
DRIFT_FOLLOWED = "gyroscope_drift_followed"


def bias_events(replay: Replay) -> list[FilterEvent]:
    """A bias of the gyroscope that is clearly none of zero, or one that drifts.

    The filter finds it by poses and treads. Where the gyroscope reads otherwise at rest, these
    are at fault, and not the gyroscope.
    """
    of = slice(GYRO_BIAS, GYRO_BIAS + 1)
    biases = replay.numbers("mean", columns=of)[:, 0]
    sigmas = replay.sigmas_of(of)[:, 0]
    known = np.flatnonzero((sigmas > 0) & (sigmas < KNOWN_BIAS_RAD_S))
    if not len(known):
        return []
    if np.ptp(biases[known]) > DRIFT_RAD_S:
        return [_drift(replay, biases, float(sigmas[known].mean()), known)]
    if abs(biases[-1]) > max(BIAS_RAD_S, BIAS_SIGMAS * sigmas[-1]):
        return [_constant(replay, float(biases[-1]), float(sigmas[-1]), known)]
    return []


def _constant(replay: Replay, bias: float, sigma: float, known: IntArray) -> FilterEvent:
    text = f"the gyroscope has a bias of {bias:.4f} +- {sigma:.4f} rad/s"
    _, rates = _rates_at_rest(replay)
    if not len(rates):
        text += " by poses and treads (no rest shows it: a yaw that drifts looks the same)"
    elif abs(bias - (at_rest := float(np.median(rates)))) > (
        CONTRADICTED_RAD_S + REST_SIGMAS * sigma
    ):
        return _contradicted(replay, known, text, at_rest)
    return _event(replay, known, "gyroscope_bias", f"{text}: it was removed")


def _drift(replay: Replay, biases: FloatArray, stated: float, known: IntArray) -> FilterEvent:
    least, most = float(biases[known].min()), float(biases[known].max())
    text = f"the estimated bias of the gyroscope went from {least:.4f} to {most:.4f} rad/s"
    steps, rates = _rates_at_rest(replay)
    later = steps >= known[0]
    apart = rates[later] - biases[steps[later]]
    if len(apart) and abs(float(np.median(apart))) > CONTRADICTED_RAD_S:
        return _contradicted(replay, known, text, float(np.median(rates[later])))
    again = [of.values[0] for of in replay.events if of.kind == "gyroscope_bias_changed"]
    if len(again) >= BACK and np.ptp(again) < BACK_SHARE * (most - least):
        text += (
            f", and the poses brought it back to {float(np.median(again)):.4f} {len(again)} times: "
            "the treads turn otherwise than gyroscope and poses, it is no drift of the gyroscope"
        )
        return _event(replay, known, "treads_contradicted", text)
    off = bias_error(replay, int(known[0]))
    if abs(off) <= FOLLOWED_SIGMAS * stated:
        return _event(replay, known, DRIFT_FOLLOWED, f"{text}: the filter followed a drift")
    text += (
        f" and was off by {abs(off):.4f} rad/s in the mean, where the filter states "
        f"{stated:.4f}: a drift that was not followed"
    )
    return _event(replay, known, "gyroscope_drift", text)


def _contradicted(replay: Replay, known: IntArray, text: str, at_rest_rad_s: float) -> FilterEvent:
    """The event of a bias that the gyroscope does not have where the robot stands."""
    text += (
        f" for the filter, but at rest it reads {at_rest_rad_s:.4f} rad/s: the yaw of the poses "
        "drifts or the treads are at fault, and estimate and odometer turn wrongly"
    )
    return _event(replay, known, "gyroscope_contradicted", text)


def _event(replay: Replay, known: IntArray, kind: str, text: str) -> FilterEvent:
    begin_s, end_s = replay.stamps_s[[known[0], -1]].tolist()
    return FilterEvent(kind, begin_s, end_s, text)


def _rates_at_rest(replay: Replay) -> tuple[IntArray, FloatArray]:
    """Steps (K,) in which the treads stand, a second after they moved, and yaw rates [rad/s].

    None where that lasts less than `REST_S` in all.
    """
    stamps_s, rates = replay.stamps_s, replay.yaw_rates_rad_s
    speeds = replay.numbers("tread_speeds_m_s")[: len(rates)]
    stood = (np.abs(speeds) <= STILL_M_S).all(axis=1)
    moved_s = np.maximum.accumulate(np.where(stood, -np.inf, stamps_s[1:]))
    settled = np.flatnonzero(stood & np.isfinite(rates) & (stamps_s[:-1] > moved_s + SETTLED_S))
    if np.diff(stamps_s)[settled].sum() < REST_S:
        settled = settled[:0]
    return settled, rates[settled]


def bias_error(replay: Replay, first: int) -> float:
    """Mean error of the estimated bias since an estimate [rad/s].

    How much more the gyroscope less that bias turned than the estimate, which follows the poses.
    """
    steps_s = np.diff(replay.stamps_s[first:])
    yaws, biases = (
        replay.numbers("mean", slice(first, None), slice(state, state + 1))[:, 0]
        for state in (YAW, GYRO_BIAS)
    )
    rates = replay.believed_yaw_rates_rad_s[first:]
    known = np.isfinite(rates) & (steps_s > 0)
    off = (rates - biases[:-1]) * steps_s - wrap(np.diff(yaws))
    duration_s = float(steps_s[known].sum())
    return float(off[known].sum()) / duration_s if duration_s > 0 else 0.0
