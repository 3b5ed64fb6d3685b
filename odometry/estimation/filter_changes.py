"""A filter that takes another gyroscope bias, or the poses of a robot moved while treads stand."""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.estimate import Estimate
from odometry.estimation.filter_start import started_anew
from odometry.estimation.measured_updates import Seen
from odometry.estimation.measurement import Gaussian, Place, turned_by_treads
from odometry.estimation.other_places import SHIFTED_POSES, left
from odometry.estimation.prediction import Predicted
from odometry.estimation.transition import GYRO_BIAS, YAW
from odometry.estimation.watches import bias_watch, rest_watch
from odometry.estimation.watches.bias_watch import SPANS, BiasWatch, Rates
from odometry.estimation.watches.rest_watch import RestWatch
from odometry.estimation.watches.sensor_watch import Events, SensorWatch
from odometry.geometry.angles import wrap_one


def followed_at_rest(
    estimate: Estimate,
    pose: FloatArray | None,
    stamp_s: float,
    after: Seen,
    *,
    yaw_rate_rad_s: float,
    pose_covariance: FloatArray,
    lever_m: Place,
) -> tuple[Seen, RestWatch | None]:
    """State estimate after a pose, and the watch of a stationary robot; None while treads move.

    Where the poses show that it was moved, its pose is theirs, and all else is as it was when
    the treads came to stand.

    Parameters
    ----------
    estimate : Estimate
        At the beginning of the step.
    pose : (3,) or None
        Measured at its end; what is to be used of it.
    stamp_s : float
        Of the end.
    after : Seen
        State estimate there.
    yaw_rate_rad_s : float
        Of the gyroscope over the step; NaN where there is none.
    pose_covariance : (3, 3)
        Of a measured pose.
    lever_m : (x, y)
        Place of the measured point in the robot frame.
    """
    watch = None if estimate.watch is None else estimate.watch.rest
    if not rest_watch.stand(estimate.tread_speeds_m_s):
        if watch is None:
            return after, None
        return after._replace(events=(*after.events, *rest_watch.ended(watch, stamp_s))), None
    came_back = any(event.kind == SHIFTED_POSES for event in after.events)
    if watch is None or came_back:
        watch = RestWatch(estimate.stamp_s, estimate.certain, estimate.scale)
    if math.isfinite(yaw_rate_rad_s):
        turn_rad = (yaw_rate_rad_s - watch.before[0][GYRO_BIAS]) * (stamp_s - estimate.stamp_s)
        watch = watch._replace(turned_rad=watch.turned_rad + float(turn_rad))
    if pose is None or after.course is not None:
        return after, watch
    scaled = pose_covariance * watch.scale.pose
    watch, moved = rest_watch.watched(watch, pose, stamp_s, scaled)
    if not moved:
        return after, watch
    then_mean, then_covariance = watch.before
    mean, covariance = after.mean.copy(), np.zeros_like(after.covariance)
    mean[3:] = then_mean[3:]
    # steps of a carried antenna that is off the centre look like turns: the gyroscope knows better
    mean[YAW] = wrap_one(float(then_mean[YAW]) + watch.turned_rad)
    covariance[:3, :3], covariance[3:, 3:] = after.covariance[:3, :3], then_covariance[3:, 3:]
    drift = then_covariance[GYRO_BIAS, GYRO_BIAS] * (stamp_s - watch.since_s) ** 2
    covariance[YAW, YAW] = then_covariance[YAW, YAW] + drift
    anew = started_anew((mean, covariance), pose, scaled, lever_m)
    others = after.others
    if not others or others[-1].since_s < watch.since_s:
        others = left(others, watch.before, anew, stamp_s)
    return after._replace(
        others=others, mean=anew[0], covariance=anew[1], refused=(), recent=(), scale=watch.scale
    ), watch


def bias_followed(
    estimate: Estimate, predicted: Predicted, after: Seen, stamp_s: float
) -> tuple[Gaussian, SensorWatch | None, Events]:
    """State estimate, watch and events at the end of a step.

    Parameters
    ----------
    estimate : Estimate
        At its beginning.
    predicted : Predicted
    after : Seen
        With its pose.
    stamp_s : float
    """
    belief, watch = (after.mean, after.covariance), predicted.watch
    if watch is None:
        return belief, watch, ()
    begins_anew = after.course is not None or bool(after.events)
    if begins_anew or watch.is_gyroscope_held or watch.is_stuck:
        return belief, _with_bias(watch, BiasWatch(walk=watch.bias.walk)), ()
    step_s = stamp_s - estimate.stamp_s
    is_silent = not watch.bias.lasts_s and math.isnan(predicted.yaw_rate_rad_s)
    if is_silent or not step_s:
        return belief, watch, ()
    rates = Rates(
        predicted.yaw_rate_rad_s,
        wrap_one(float(after.mean[YAW] - estimate.mean[YAW])) / step_s,
        turned_by_treads(estimate.mean, *estimate.tread_speeds_m_s.tolist()),
    )
    posed = after.innovation is not None and after.innovation.accepted
    bias = bias_watch.watched(watch.bias, rates, step_s, stamp_s, posed=posed)
    estimated_rad_s = float(after.mean[GYRO_BIAS])
    if bias.biases_rad_s is watch.bias.biases_rad_s:
        return belief, _with_bias(watch, bias), ()
    found, bias = _another_bias(bias, estimated_rad_s)
    if found is None:
        return belief, _with_bias(watch, bias), ()
    event = bias_watch.change_event(estimated_rad_s, found[0], stamp_s)
    return bias_watch.changed(belief, found), _with_bias(watch, bias), (event,)


def _with_bias(watch: SensorWatch, bias: BiasWatch) -> SensorWatch:
    return watch._replace(bias=bias)


def _another_bias(
    watch: BiasWatch, estimated_rad_s: float
) -> tuple[tuple[float, float] | None, BiasWatch]:
    """Another bias and its standard deviation [rad/s] if spans determine one; the watch with it."""
    stepped = bias_watch.changed_bias(watch, estimated_rad_s)
    if stepped is not None:
        return stepped, watch._replace(since=0)
    drift = drifted_bias(watch, estimated_rad_s)
    if drift is None:
        return None, watch
    return drift.bias_rad_s, watch._replace(since=STILL_OF_IT, walk=drift.walk)


COUNT = 16  # last spans, of which either half must show a drift, ...
SIGMAS, LEAST_RAD_S = 4.0, 0.003  # ... by so much in the mean, and half of it in either half
NOISY_RAD_S, MOST_WALK = 0.05, 10.0  # scatter at which the walk stays as given; largest factor
STILL_OF_IT = COUNT // 2  # spans that belong to the bias of the later half


class Drift(NamedTuple):
    """A drift that was found.

    Attributes
    ----------
    bias_rad_s : (float, float)
        The bias of the last spans and its standard deviation [rad/s].
    walk : float
        Factor on the noise of the bias's random walk from now on.
    """

    bias_rad_s: tuple[float, float]
    walk: float


def drifted_bias(watch: BiasWatch, estimated_rad_s: float) -> Drift | None:
    """The bias where the last spans show a drift.

    The scatter of all spans about a line gives the error of the mean of some, as if it had no
    memory. Treads are not used: the estimates of their slip follow a slow drift. A reference whose
    own yaw drifts by so much is taken for the gyroscope's. Count and sigmas were chosen on the 19
    recordings of data/motion that are not among the seven on which the odometer is evaluated: no
    clean one shows a drift.
    """
    biases = np.array(watch.biases_rad_s)
    if len(biases) < SPANS or watch.since < COUNT:
        return None
    moments = np.arange(len(biases)) - (len(biases) - 1) / 2
    slope = float(moments @ biases) / float(moments @ moments)
    scatter = float((biases - slope * moments).std())
    halves = biases[-COUNT:].reshape(2, -1).mean(axis=1) - estimated_rad_s
    mean = float(halves.mean())
    least = max(SIGMAS * scatter / math.sqrt(COUNT), LEAST_RAD_S)
    if abs(mean) < least or halves.prod() < 0 or np.abs(halves).min() < least / 2:
        return None
    found = estimated_rad_s + float(halves[1]), scatter / math.sqrt(STILL_OF_IT)
    return Drift(found, min(max(NOISY_RAD_S / scatter, 1.0), MOST_WALK) if scatter else MOST_WALK)
