"""What the filter does while poses stay and treads drive: its pose is theirs, all else stays."""

import math
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation import stuck_watch
from odometry.estimation.estimate import Estimate
from odometry.estimation.filter_start import started_anew
from odometry.estimation.measured_updates import Seen
from odometry.estimation.measurement import Gaussian, Place
from odometry.estimation.other_places import SHIFTED_POSES
from odometry.estimation.prediction import Predicted
from odometry.estimation.rest_watch import stand
from odometry.estimation.stuck_watch import StuckWatch
from odometry.frames import Frame


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
        watch = self._led_on(estimate, predicted, frame, terrain, after)
        before, pose = watch, predicted.pose
        if watch is not None and pose is not None:
            watch = stuck_watch.with_pose(watch, pose, frame.stamp_s)
        if watch is not None and watch.is_found:
            after = self._held(estimate, watch, pose, after)
        elif watch is None and before is not None and pose is not None:
            after = self._freed(before, frame, pose, after)
        if watch is None and pose is not None and after.course is None:
            scaled = self.pose_covariance * after.scale.pose
            belief = after.mean, after.covariance
            watch = stuck_watch.begun(pose, frame.stamp_s, belief, after.scale, scaled)
        return after, predicted._replace(watch=predicted.watch._replace(stuck=watch))

    def _led_on(
        self, estimate: Estimate, predicted: Predicted, frame: Frame, terrain: str, after: Seen
    ) -> StuckWatch | None:
        """The watch of before with the step; None where it is at an end."""
        watch = None if estimate.watch is None else estimate.watch.stuck
        speeds_m_s = estimate.tread_speeds_m_s
        is_known = not frame.in_gap and not math.isnan(speeds_m_s[0] + speeds_m_s[1])
        is_known &= after.course is None and terrain == estimate.terrain
        came_back = any(event.kind == SHIFTED_POSES for event in after.events)
        if watch is None or not is_known or came_back:
            return None
        if stand(speeds_m_s):
            return watch if watch.is_found else None
        step_s = frame.stamp_s - estimate.stamp_s
        return stuck_watch.led_on(
            watch, speeds_m_s + estimate.added_speeds_m_s, step_s, predicted.yaw_rate_rad_s
        )

    def _held(
        self, estimate: Estimate, watch: StuckWatch, pose: FloatArray | None, after: Seen
    ) -> Seen:
        """The pose measured there, or the one before, beside all else as it was."""
        belief = _with_pose_of(watch.before, estimate.mean, estimate.covariance)
        if pose is not None and not watch.away:
            scaled = self.pose_covariance * watch.scale.pose
            belief = started_anew(belief, pose, scaled, self.lever_m, lost_yaw_rad=0.0)
        near = next((each.near for each in after.others if each.since_s == watch.since_s), 0)
        others = tuple(each for each in after.others if each.since_s < watch.since_s)
        led = stuck_watch.where_treads_led(watch, belief[0], near)
        return after._replace(
            mean=belief[0],
            covariance=belief[1],
            refused=(),
            recent=(),
            scale=watch.scale,
            others=(*others, led),
        )

    def _freed(self, watch: StuckWatch, frame: Frame, pose: FloatArray, after: Seen) -> Seen:
        """Where the robot was stuck and a pose is elsewhere: it is there, and nowhere else."""
        if not watch.is_found or stuck_watch.is_there(watch, pose):
            return after
        events = (*after.events, *stuck_watch.freed(watch, pose, frame.stamp_s))
        others = tuple(each for each in after.others if each.since_s < watch.since_s)
        belief = _with_pose_of(watch.before, after.mean, after.covariance)
        scaled = self.pose_covariance * watch.scale.pose
        belief = started_anew(belief, pose, scaled, self.lever_m, lost_yaw_rad=0.0)
        return after._replace(
            mean=belief[0],
            covariance=belief[1],
            refused=(),
            recent=(),
            scale=watch.scale,
            others=others,
            events=events,
        )


def _with_pose_of(before: Gaussian, mean: FloatArray, covariance: FloatArray) -> Gaussian:
    """A state estimate with the pose of another one, uncorrelated with the rest."""
    held, held_covariance = before[0].copy(), np.zeros_like(before[1])
    held[:3] = mean[:3]
    held_covariance[:3, :3], held_covariance[3:, 3:] = covariance[:3, :3], before[1][3:, 3:]
    return held, held_covariance
