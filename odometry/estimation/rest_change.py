"""A filter that follows the poses of a robot that is moved while its treads stand."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation import rest_watch
from odometry.estimation.estimate import Estimate
from odometry.estimation.measurement import Place
from odometry.estimation.new_start import started_anew
from odometry.estimation.pose_update import Seen
from odometry.estimation.rest_watch import RestWatch


def followed_at_rest(
    estimate: Estimate,
    pose: FloatArray | None,
    stamp_s: float,
    after: Seen,
    *,
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
    if watch is None:
        before = estimate.mean, estimate.covariance
        watch = RestWatch(estimate.stamp_s, before, estimate.scale)
    if pose is None or after.course is not None:
        return after, watch
    scaled = pose_covariance * watch.scale.pose
    watch, moved = rest_watch.watched(watch, pose, stamp_s, scaled)
    if not moved:
        return after, watch
    then_mean, then_covariance = watch.before
    mean, covariance = after.mean.copy(), np.zeros_like(after.covariance)
    mean[3:] = then_mean[3:]
    covariance[:3, :3], covariance[3:, 3:] = after.covariance[:3, :3], then_covariance[3:, 3:]
    anew = started_anew((mean, covariance), pose, scaled, lever_m)
    return after._replace(
        mean=anew[0], covariance=anew[1], refused=(), recent=(), scale=watch.scale
    ), watch
