"""All that a filter watches of its sensors from step to step."""

import math
from typing import NamedTuple

from odometry.arrays import FloatArray
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent, gap_event
from odometry.estimation.measurement import Gaussian
from odometry.estimation.watches import (
    contrary_treads,
    frozen_treads,
    gyroscope_hold,
    gyroscope_watch,
    pose_watch,
    tread_watch,
)
from odometry.estimation.watches.bias_watch import BiasWatch
from odometry.estimation.watches.contrary_treads import ContraryTreads
from odometry.estimation.watches.frozen_treads import FrozenTreads
from odometry.estimation.watches.gyroscope_hold import GyroscopeHold
from odometry.estimation.watches.gyroscope_watch import GyroscopeWatch
from odometry.estimation.watches.pose_watch import PoseWatch
from odometry.estimation.watches.rest_watch import RestWatch
from odometry.estimation.watches.slip_watch import SlipWatch
from odometry.estimation.watches.stuck_watch import StuckWatch
from odometry.estimation.watches.tread_watch import TreadWatch
from odometry.recording.frames import Frame

Events = tuple[FilterEvent, ...]


class SensorWatch(NamedTuple):
    """What is remembered of each sensor.

    Attributes
    ----------
    treads : TreadWatch
    gyroscope : GyroscopeWatch
    poses : PoseWatch
    gap_since_s : float
        Stamp since when odometry has a gap; NaN where it has none.
    hold : GyroscopeHold or None
        Of the gyroscope; None before the first step.
    bias : BiasWatch
        Of the gyroscope against the poses.
    rest : RestWatch or None
        Of the poses while the treads stand.
    frozen : FrozenTreads or None
        While the gyroscope says that the robot does not turn as the treads do.
    slip : SlipWatch or None
        Of the slip factors; None before the first pose, and until the next one where no tread
        speed is known.
    contrary : ContraryTreads or None
        Of the treads against the gyroscope.
    held : StuckWatch or None
        Of poses that stay while the gyroscope turns.
    stuck : StuckWatch or None
        Of the poses while the treads drive.
    """

    treads: TreadWatch
    gyroscope: GyroscopeWatch
    poses: PoseWatch
    gap_since_s: float = math.nan
    hold: GyroscopeHold | None = None
    bias: BiasWatch = BiasWatch()
    rest: RestWatch | None = None
    frozen: FrozenTreads | None = None
    slip: SlipWatch | None = None
    contrary: ContraryTreads | None = None
    held: StuckWatch | None = None
    stuck: StuckWatch | None = None

    @property
    def is_doubtful(self) -> bool:
        """Whether a tread contradicts the rest, so that the ICRs are not to be updated."""
        return self.treads.is_doubtful or self.is_frozen or self.is_contrary

    @property
    def is_contrary(self) -> bool:
        """Whether no tread speed is known, because treads do not turn as the gyroscope says."""
        return self.contrary is not None and self.contrary.is_found

    @property
    def is_frozen(self) -> bool:
        """Whether no tread speed is known, because both are frozen or the robot is blocked."""
        return self.frozen is not None and self.frozen.is_found

    @property
    def is_stuck(self) -> bool:
        """Whether poses stay while the treads drive."""
        return self.stuck is not None and self.stuck.is_found

    @property
    def is_gyroscope_held(self) -> bool:
        """Whether the gyroscope repeats one value and counts as silent."""
        return self.hold is not None and self.hold.is_found


class Sensed(NamedTuple):
    """The sensor values that are used over a step, and from its end on.

    Attributes
    ----------
    watch : SensorWatch
    begin_s : float
        Stamp of its beginning.
    yaw_rate_rad_s : float
        Over the step; NaN where the treads turn the robot.
    pose : (3,) or None
        At its end.
    events : tuple of FilterEvent
    belief : (9,), (9, 9)
        At its beginning.
    terrain : str
        In force there.
    """

    watch: SensorWatch
    begin_s: float
    yaw_rate_rad_s: float
    pose: FloatArray | None
    events: Events
    belief: Gaussian
    terrain: str


def begun(frame: Frame, belief: Gaussian, config: IcrEkfConfig) -> SensorWatch | None:
    """At the first frame; None where sensors are not watched."""
    if not config.watch_sensors:
        return None
    poses = PoseWatch(rounded_m=config.position_step_m)
    poses = pose_watch.watched(poses, frame.pose, frame.stamp_s, (0.0, 0.0))[0]
    return SensorWatch(tread_watch.begun(frame, belief), GyroscopeWatch(), poses)


def sensed(
    watch: SensorWatch,
    frame: Frame,
    begin_s: float,
    *,
    speeds_m_s: FloatArray,
    yaw_rate: float,
    belief: Gaussian,
    terrain: str,
) -> Sensed:
    """Gyroscope and pose over the step that leads to a frame.

    Parameters
    ----------
    watch : SensorWatch
    frame : Frame
    begin_s : float
        Stamp of the beginning of the step.
    speeds_m_s : (2,)
        Tread speeds used over it.
    yaw_rate : float
        Of the gyroscope over it, as recorded [rad/s]; NaN where there is none.
    belief : (9,), (9, 9)
        At its beginning.
    terrain : str
        In force there.
    """
    hold = gyroscope_hold.watched(
        watch.hold,
        yaw_rate,
        begin_s,
        frame.stamp_s,
        speeds_m_s=speeds_m_s,
        belief=belief,
        terrain=terrain,
    )
    events: Events = ()
    if hold.is_found:
        gyroscope = GyroscopeWatch()
        if watch.is_gyroscope_held:
            yaw_rate = math.nan
        else:
            yaw_rate += hold.owed_rad / (frame.stamp_s - begin_s)
            belief = gyroscope_hold.forgotten(belief, hold, begin_s, watch.poses.fresh_s)
    else:
        gyroscope, yaw_rate, events = gyroscope_watch.watched(
            watch.gyroscope, yaw_rate, begin_s, frame.stamp_s
        )
        if watch.hold is not None:
            events += gyroscope_hold.ended(watch.hold, begin_s)
    moved_by = pose_watch.moved(watch.poses, speeds_m_s, yaw_rate, frame.stamp_s - begin_s)
    poses, pose, of_poses = pose_watch.watched(watch.poses, frame.pose, frame.stamp_s, moved_by)
    events += of_poses
    gap_since_s, of_gap = _gap(watch.gap_since_s, frame, begin_s)
    after = SensorWatch(watch.treads, gyroscope, poses, gap_since_s, hold, *watch[5:])
    return Sensed(after, begin_s, yaw_rate, pose, events + of_gap, belief, terrain)


def _gap(since_s: float, frame: Frame, begin_s: float) -> tuple[float, Events]:
    """Since when odometry has a gap (NaN: it has none), and the event of one that has ended."""
    if frame.in_gap:
        return begin_s if math.isnan(since_s) else since_s, ()
    return math.nan, () if math.isnan(since_s) else (gap_event(since_s, begin_s),)


def with_treads(
    before: Sensed, frame: Frame, speeds_m_s: FloatArray, belief: Gaussian, slip_scale: float
) -> tuple[SensorWatch, FloatArray, Events]:
    """The watch, the speeds (2,) to use from a frame on, and all events of the step to it.

    Parameters
    ----------
    before : Sensed
        Over the step.
    frame : Frame
    speeds_m_s : (2,)
        Used over it.
    belief : (9,), (9, 9)
        Predicted for its end.
    slip_scale : float
        Factor on the variance of slip: where treads slip much, a stuck one cannot be detected.
    """
    watch, yaw_rate, held_m_s = before.watch, before.yaw_rate_rad_s, speeds_m_s
    treads = watch.treads
    if not math.isnan(yaw_rate) and not frame.in_gap:
        treads = tread_watch.contradicted(treads, frame.stamp_s, belief, yaw_rate, slip_scale)
    step_s = frame.stamp_s - before.begin_s
    treads, speeds_m_s, spikes = tread_watch.watched(treads, frame, step_s, speeds_m_s, belief)
    treads, freed = tread_watch.freed(treads, frame.stamp_s)
    if treads.stuck >= 0 and not math.isnan(speeds_m_s[0]):
        speeds_m_s = tread_watch.with_implied(treads, speeds_m_s, belief, yaw_rate)
    frozen, thawed = frozen_treads.stepped(
        watch.frozen,
        frame,
        before.begin_s,
        speeds_m_s=held_m_s,
        yaw_rate=yaw_rate,
        belief=before.belief,
        before=watch.treads.before_both,
    )
    is_silent = frame.in_gap or gyroscope_hold.repeats(watch.hold, before.begin_s)
    is_known = not (is_silent or treads.is_doubtful)
    contrary, turned = contrary_treads.stepped(
        watch.contrary,
        before.begin_s,
        frame.stamp_s,
        speeds_m_s=held_m_s,
        yaw_rate=yaw_rate if is_known else math.nan,
        belief=before.belief,
        terrain=before.terrain,
    )
    watch = watch._replace(treads=treads, frozen=frozen, contrary=contrary)
    return watch, speeds_m_s, before.events + spikes + freed + thawed + turned
