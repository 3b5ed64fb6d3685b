"""A robot that stays where it is while its treads drive: stuck, or its wheels spin.

A filter would take what such treads do for slip. Poses that a receiver or a map holds look the same
until they come back to where treads and gyroscope have led.
"""

import math
from typing import NamedTuple

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian
from odometry.estimation.noise_scale import NoiseScale
from odometry.estimation.other_places import OtherPlace
from odometry.estimation.transition import (
    ALPHA_LEFT,
    ALPHA_RIGHT,
    GYRO_BIAS,
    Y_LEFT,
    Y_RIGHT,
    moved_pose,
)
from odometry.geometry import se2
from odometry.geometry.angles import wrap_one

NEAR_M, NEAR_RAD, SIGMAS = 0.1, 0.1, 4.0  # poses within the larger of these and of SIGMAS stay
TIMES = 4.0  # as far must treads have led
LEAST_S, LEAST_POSES = 0.8, 3  # that stay, once treads have led away: poses may be late
IN_A_ROW = 3  # poses elsewhere, before the robot is free
STUCK, HELD_POSES = "stuck", "held_poses"  # kinds of events, whose value is how far treads drove
JUMP_TIMES = 2.0  # the way of the treads meanwhile: farther from there poses jump


class StuckWatch(NamedTuple):
    """What is remembered of the place at which poses have stayed.

    Attributes
    ----------
    since_s : float
        Stamp of the first pose there.
    place : (3,)
        That pose, as measured.
    near : (float, float)
        Within which poses are there [m], [rad].
    before : (9,), (9, 9)
        State estimate then.
    scale : NoiseScale
        Estimated then.
    led, led_last : (3,)
        Pose to which treads and gyroscope have led since, and had when the last pose was there.
    treads_rad, gyroscope_rad : float
        Turn since then by either; NaN where no gyroscope measured one.
    out_s : float
        Stamp since when they have led away; NaN where they have not.
    stayed, away : int
        Poses there since `out_s`, and the latest in a row elsewhere.
    is_found : bool
        Whether the robot is stuck.
    """

    since_s: float
    place: FloatArray
    near: tuple[float, float]
    before: Gaussian
    scale: NoiseScale
    led: FloatArray
    led_last: FloatArray
    treads_rad: float = 0.0
    gyroscope_rad: float = math.nan
    out_s: float = math.nan
    stayed: int = 0
    away: int = 0
    is_found: bool = False

    @property
    def led_m(self) -> float:
        """How far treads and gyroscope have led."""
        return math.hypot(*(self.led - self.before[0][:3])[:2])

    @property
    def led_times(self) -> float:
        """How many times the distance or the turn within which poses stay."""
        is_yaw_known = not (math.isnan(self.place[2]) and math.isnan(self.gyroscope_rad))
        by_turn = abs(self.treads_rad) / self.near[1] if is_yaw_known else 0.0
        return max(self.led_m / self.near[0], by_turn)


def begun(
    pose: FloatArray,
    stamp_s: float,
    belief: Gaussian,
    scale: NoiseScale,
    pose_covariance: FloatArray,
) -> StuckWatch | None:
    """At a measured pose (3,), `pose_covariance` (3, 3) as scaled; None without a position."""
    if math.isnan(pose[0] + pose[1]):
        return None
    sigma_m, sigma_rad = math.sqrt(pose_covariance[0, 0]), math.sqrt(pose_covariance[2, 2])
    near = max(NEAR_M, SIGMAS * sigma_m), max(NEAR_RAD, SIGMAS * sigma_rad)
    led = belief[0][:3]
    return StuckWatch(stamp_s, pose, near, belief, scale, led, led)


def led_on(
    watch: StuckWatch, speeds_m_s: FloatArray, step_s: float, yaw_rate_rad_s: float
) -> StuckWatch:
    """The watch after a step at tread speeds (2,) and a yaw rate of the gyroscope, or NaN."""
    mean = watch.before[0]
    led = moved_pose(watch.led, mean, speeds_m_s, step_s, yaw_rate_rad_s=yaw_rate_rad_s)
    left, right = speeds_m_s.tolist()
    asked = float(mean[ALPHA_RIGHT]) * right - float(mean[ALPHA_LEFT]) * left
    treads_rad = watch.treads_rad + asked / float(mean[Y_LEFT] - mean[Y_RIGHT]) * step_s
    turned_rad = watch.gyroscope_rad
    if not math.isnan(yaw_rate_rad_s):
        before_rad = 0.0 if math.isnan(turned_rad) else turned_rad
        turned_rad = before_rad + (yaw_rate_rad_s - float(mean[GYRO_BIAS])) * step_s
    return watch._replace(led=led, treads_rad=treads_rad, gyroscope_rad=turned_rad)


def with_pose(watch: StuckWatch, pose: FloatArray, stamp_s: float) -> StuckWatch | None:
    """The watch after a measured pose (3,); None once the robot is elsewhere, or turns there."""
    if math.isnan(pose[0] + pose[1]):
        return watch
    if not is_there(watch, pose):
        away = watch.away + 1
        return watch._replace(away=away) if watch.is_found and away < IN_A_ROW else None
    if _is_turned(watch, pose, stamp_s):
        return None
    if watch.led_times < 1:
        return watch._replace(out_s=math.nan, stayed=0, away=0)
    out_s = stamp_s if math.isnan(watch.out_s) else watch.out_s
    stayed = watch.stayed + 1
    long_there = stamp_s - out_s >= LEAST_S and stayed >= LEAST_POSES
    found = watch.is_found or (long_there and watch.led_times >= TIMES)
    return watch._replace(led_last=watch.led, out_s=out_s, stayed=stayed, away=0, is_found=found)


def is_there(watch: StuckWatch, pose: FloatArray) -> bool:
    """Whether a pose (3,) is at the place."""
    near_m, near_rad = watch.near
    is_near = math.hypot(*(pose - watch.place)[:2]) <= near_m
    return is_near and abs(_turn_rad(watch, pose)) <= near_rad


def _is_turned(watch: StuckWatch, pose: FloatArray, stamp_s: float) -> bool:
    """Whether the gyroscope turned and a pose (3,) did not: then the pose is held."""
    if math.isnan(watch.gyroscope_rad):
        return False
    variance = float(watch.before[1][GYRO_BIAS, GYRO_BIAS])
    drift_rad = SIGMAS * math.sqrt(variance) * (stamp_s - watch.since_s)
    apart_rad = wrap_one(watch.gyroscope_rad - _turn_rad(watch, pose))
    return abs(apart_rad) > watch.near[1] / 2 + drift_rad


def _turn_rad(watch: StuckWatch, pose: FloatArray) -> float:
    """Measured turn to a pose (3,); 0 where none is known."""
    turn_rad = float(pose[2] - watch.place[2])
    return 0.0 if math.isnan(turn_rad) else wrap_one(turn_rad)


def where_treads_led(watch: StuckWatch, mean: FloatArray, near: int) -> OtherPlace:
    """Where the robot is if its poses are held, of an estimate with a mean (9,)."""
    motion = se2.compose(watch.led, se2.inverse(mean[:3]))
    return OtherPlace(watch.since_s, motion, watch.before[1][:3, :3], near)


def freed(watch: StuckWatch, pose: FloatArray, stamp_s: float) -> tuple[FilterEvent, ...]:
    """The event of a robot that was stuck until a pose (3,) elsewhere, or of poses held until it.

    Poses that were held jump: no robot goes farther than its treads.
    """
    went_m = math.hypot(*(watch.led - watch.led_last)[:2])
    jump_m = math.hypot(*(pose - watch.place)[:2])
    if jump_m <= 2 * watch.near[0] + JUMP_TIMES * went_m:
        return ended(watch, stamp_s)
    text = (
        f"{_stayed(watch, stamp_s)}, and jumped by {jump_m:.2f} m then: they were held, and the "
        "estimate stayed with them; the filter learned nothing of it"
    )
    return (FilterEvent(HELD_POSES, watch.since_s, stamp_s, text, (watch.led_m,)),)


def ended(watch: StuckWatch | None, stamp_s: float) -> tuple[FilterEvent, ...]:
    """The event of a robot that was stuck until a stamp."""
    if watch is None or not watch.is_found:
        return ()
    text = (
        f"{_stayed(watch, stamp_s)}: the robot was stuck, or its wheels spun; the filter learned "
        "nothing of it"
    )
    return (FilterEvent(STUCK, watch.since_s, stamp_s, text, (watch.led_m,)),)


def _stayed(watch: StuckWatch, stamp_s: float) -> str:
    return (
        f"the poses stayed within {watch.near[0]:.2f} m for {stamp_s - watch.since_s:.1f} s while "
        f"treads drove {watch.led_m:.2f} m and turned by "
        f"{math.degrees(abs(watch.treads_rad)):.0f} degrees"
    )
