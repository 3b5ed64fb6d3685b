"""A filter that takes another bias of its gyroscope where the poses tell one."""

import math

from odometry.estimation import bias_watch
from odometry.estimation.bias_drift import STILL_OF_IT, drifted_bias
from odometry.estimation.bias_watch import BiasWatch, Rates
from odometry.estimation.estimate import Estimate
from odometry.estimation.measurement import Gaussian, turned_by_treads
from odometry.estimation.pose_update import Seen
from odometry.estimation.prediction import Predicted
from odometry.estimation.sensor_watch import Events, SensorWatch, with_bias
from odometry.estimation.transition import GYRO_BIAS, YAW
from odometry.geometry.angles import wrap_one


def bias_followed(
    estimate: Estimate, predicted: Predicted, after: Seen, stamp_s: float
) -> tuple[Gaussian, SensorWatch | None, Events]:
    """Belief, watch and events at the end of a step.

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
    if after.course is not None or after.events or watch.is_gyroscope_held:
        return belief, with_bias(watch, BiasWatch(walk=watch.bias.walk)), ()
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
    believed_rad_s = float(after.mean[GYRO_BIAS])
    if bias.biases_rad_s is watch.bias.biases_rad_s:
        return belief, with_bias(watch, bias), ()
    told, bias = _another_bias(bias, believed_rad_s)
    if told is None:
        return belief, with_bias(watch, bias), ()
    event = bias_watch.change_event(believed_rad_s, told[0], stamp_s)
    return bias_watch.changed(belief, told), with_bias(watch, bias), (event,)


def _another_bias(
    watch: BiasWatch, believed_rad_s: float
) -> tuple[tuple[float, float] | None, BiasWatch]:
    """Another bias and its standard deviation [rad/s] if spans tell one; the watch with it."""
    stepped = bias_watch.told_bias(watch, believed_rad_s)
    if stepped is not None:
        return stepped, watch._replace(since=0)
    drift = drifted_bias(watch, believed_rad_s)
    if drift is None:
        return None, watch
    return drift.told, watch._replace(since=STILL_OF_IT, walk=drift.walk)
