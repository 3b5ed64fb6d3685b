"""What the filter does while poses stay and treads drive: its pose is theirs, all else stays."""

import math
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.estimate import Estimate
from odometry.estimation.filter_start import started_anew
from odometry.estimation.measured_updates import Seen
from odometry.estimation.measurement import Gaussian, Place
from odometry.estimation.other_places import SHIFTED_POSES
from odometry.estimation.prediction import Predicted
from odometry.estimation.watches import stuck_watch
from odometry.estimation.watches.rest_watch import STILL_M_S
from odometry.estimation.watches.sensor_watch import SensorWatch
from odometry.estimation.watches.stuck_watch import StuckWatch
from odometry.recording.frames import Frame


@dataclass(frozen=True)
class StuckUpdate:
    """Follows the poses of a robot that is stuck.

    Attributes
    ----------
    pose_covariance : (3, 3)
        Of a measured pose.
    lever_m : (x, y)
        Place of the measured point in the robot frame.
    """

    pose_covariance: FloatArray
    lever_m: Place

    def followed(
        self, estimate: Estimate, predicted: Predicted, frame: Frame, terrain: str, after: Seen
    ) -> tuple[Seen, Predicted]:
        """State estimate and watch at the end of a step, with its pose.

        Parameters
        ----------
        estimate : Estimate
            At its beginning.
        predicted : Predicted
            With the pose to use, and the watch of the sensors.
        frame : Frame
            At its end.
        terrain : str
            In force there.
        after : Seen
            State estimate with its pose.
        """
        assert predicted.watch is not None  # noqa: S101 - for the type checker: it has no other
        sensors, pose = predicted.watch, predicted.pose
        watch = sensors.stuck
        if not frame.in_gap and _is_early(watch, pose, frame.stamp_s):
            return after, predicted
        cells = None if pose is None else cells_of(pose)
        if watch is not None and is_over(watch, estimate, frame, terrain, after):
            watch = None
        if watch is not None:
            left, right = (estimate.tread_speeds_m_s + estimate.added_speeds_m_s).tolist()
            yaw_rate = predicted.yaw_rate_rad_s
            watch = stuck_watch.led_on(watch, (left, right), yaw_rate, frame.stamp_s)
        before = watch
        if watch is not None and cells is not None:
            watch = stuck_watch.with_pose(watch, cells, frame.stamp_s)
            if watch is None and before is not None and stuck_watch.is_there(before, cells):
                sensors = sensors._replace(held=sensors.held or before)
        if watch is not None and watch.is_found:
            after = self._held(estimate, watch, pose, after)
        elif before is not None and before.is_found and pose is not None:
            after = self._freed(before, frame, pose, after)
        if watch is None and cells is not None and after.course is None:
            scaled = self.pose_covariance * after.scale.pose
            belief = after.mean, after.covariance
            watch = stuck_watch.begun(
                cells, frame.stamp_s, belief, after.scale, scaled, terrain=terrain
            )
        return after, predicted._replace(watch=SensorWatch(*sensors[:-1], watch))

    def _held(
        self, estimate: Estimate, watch: StuckWatch, pose: FloatArray | None, after: Seen
    ) -> Seen:
        """At the pose measured there, or at the one before."""
        there = None if watch.away else pose
        held = self._as_before(watch, estimate.certain, there, after)
        near = next((each.near for each in after.others if each.since_s == watch.since_s), 0)
        led = stuck_watch.where_treads_led(watch, held.mean, near)
        return held._replace(others=(*held.others, led))

    def _freed(self, watch: StuckWatch, frame: Frame, pose: FloatArray, after: Seen) -> Seen:
        """Where the robot was stuck and a pose is elsewhere: it is there, and nowhere else."""
        if stuck_watch.is_there(watch, cells_of(pose)):
            return after
        events = (*after.events, *stuck_watch.freed(watch, cells_of(pose), frame.stamp_s))
        freed = self._as_before(watch, (after.mean, after.covariance), pose, after)
        return freed._replace(events=events)

    def _as_before(
        self, watch: StuckWatch, belief: Gaussian, pose: FloatArray | None, after: Seen
    ) -> Seen:
        """At a measured pose (3,), or that of a belief, and all else as before it was stuck."""
        belief = _with_pose_of(watch.before, *belief)
        if pose is not None:
            scaled = self.pose_covariance * watch.scale.pose
            belief = started_anew(belief, pose, scaled, self.lever_m, lost_yaw_rad=0.0)
        return gone_on(watch, belief, after)


def gone_on(watch: StuckWatch, belief: Gaussian, after: Seen) -> Seen:
    """The filter goes on from a belief, and forgets what it had of poses since the watch began."""
    return after._replace(
        mean=belief[0],
        covariance=belief[1],
        refused=(),
        recent=(),
        scale=watch.scale,
        others=tuple(each for each in after.others if each.since_s < watch.since_s),
    )


def _is_early(watch: StuckWatch | None, pose: FloatArray | None, stamp_s: float) -> bool:
    """Whether nothing is to be looked at yet, of a robot that is not stuck."""
    if watch is None:
        return pose is None
    return not watch.is_found and (pose is None or stamp_s - watch.at_s < stuck_watch.EVERY_S)


def is_over(watch: StuckWatch, estimate: Estimate, frame: Frame, terrain: str, after: Seen) -> bool:
    """Whether nothing is known of the way since the last pose, or all begins anew."""
    left, right = estimate.tread_speeds_m_s.tolist()
    if frame.in_gap or math.isnan(left + right) or terrain != watch.terrain:
        return True
    if after.course is not None or any(each.kind == SHIFTED_POSES for each in after.events):
        return True
    stand = -STILL_M_S <= left <= STILL_M_S and -STILL_M_S <= right <= STILL_M_S
    return stand and not watch.is_found


def cells_of(pose: FloatArray) -> stuck_watch.Pose:
    """A pose (3,) as a tuple."""
    x, y, yaw = pose.tolist()
    return x, y, yaw


def _with_pose_of(before: Gaussian, mean: FloatArray, covariance: FloatArray) -> Gaussian:
    """A state estimate with the pose of another one, uncorrelated with the rest."""
    held, held_covariance = before[0].copy(), np.zeros_like(before[1])
    held[:3] = mean[:3]
    held_covariance[:3, :3], held_covariance[3:, 3:] = covariance[:3, :3], before[1][3:, 3:]
    return held, held_covariance
