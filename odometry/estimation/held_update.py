"""What the filter does once poses that were held come back to where treads and gyroscope led."""

from dataclasses import dataclass

from odometry.arrays import FloatArray
from odometry.estimation.estimate import Estimate
from odometry.estimation.filter_start import started_anew
from odometry.estimation.measured_updates import Seen
from odometry.estimation.measurement import Place
from odometry.estimation.other_places import AWAY, SHIFTED_POSES
from odometry.estimation.prediction import Predicted
from odometry.estimation.stuck_update import cells_of, gone_on, is_over
from odometry.estimation.watches import held_watch, stuck_watch
from odometry.estimation.watches.stuck_watch import StuckWatch
from odometry.recording.frames import Frame


@dataclass(frozen=True)
class HeldUpdate:
    """Follows treads and gyroscope while poses are held.

    Meanwhile the filter goes on with the poses, and where treads led is another place.

    Attributes
    ----------
    pose_covariance : (3, 3)
        Of a measured pose.
    lever_m : (x, y)
        Place of the measured point in the robot frame.
    slip_noise : float
        See `IcrEkfConfig`.
    """

    pose_covariance: FloatArray
    lever_m: Place
    slip_noise: float

    def followed(
        self, estimate: Estimate, predicted: Predicted, frame: Frame, terrain: str, after: Seen
    ) -> tuple[Seen, Predicted]:
        """State estimate and watch at the end of a step, see `StuckUpdate.followed`.

        `predicted` has a watch of poses that are held.
        """
        sensors, pose = predicted.watch, predicted.pose
        assert sensors is not None and sensors.held is not None  # noqa: S101, PT018 - for the types
        others = tuple(each for each in after.others if each.since_s != sensors.held.since_s)
        after = after._replace(others=others)
        watch: StuckWatch | None = None
        if not is_over(sensors.held, estimate, frame, terrain, after._replace(events=())):
            left, right = (estimate.tread_speeds_m_s + estimate.added_speeds_m_s).tolist()
            speeds, rate = (left, right), predicted.yaw_rate_rad_s
            watch = stuck_watch.led_on(sensors.held, speeds, rate, frame.stamp_s)
        if watch is not None and pose is not None:
            watch = held_watch.with_pose(
                watch, pose, frame.stamp_s, self.lever_m, slip_noise=self.slip_noise
            )
            if watch is not None and watch.away >= held_watch.IN_A_ROW:
                sensors = sensors._replace(rest=None, slip=None, held=None, stuck=None)
                after = self._came_back(watch, pose, frame.stamp_s, after)
                return after, predicted._replace(watch=sensors)
        if any(event.kind == SHIFTED_POSES for event in after.events):
            watch = None
        if watch is not None and watch.is_found:
            led = stuck_watch.where_treads_led(watch, after.mean, AWAY)
            after = after._replace(others=(*others, led))
        return after, predicted._replace(watch=sensors._replace(held=watch))

    def _came_back(self, watch: StuckWatch, pose: FloatArray, stamp_s: float, after: Seen) -> Seen:
        """At the measured pose, and all else as before the poses were held.

        What else the filter made of that pose does not count.
        """
        scaled = self.pose_covariance * watch.scale.pose
        belief = started_anew(held_watch.led_belief(watch), pose, scaled, self.lever_m)
        event = stuck_watch.held_event(watch, cells_of(pose), stamp_s)
        return gone_on(watch, belief, after)._replace(events=(event,))
