"""A robot that stays where it is while its treads drive: stuck, or its wheels spin.

A filter would take what such treads do for slip. Poses that a receiver or a map holds look the same
until they come back to where treads and gyroscope have led.
"""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian
from odometry.estimation.noise_scale import NoiseScale
from odometry.estimation.other_places import OtherPlace
from odometry.estimation.transition import GYRO_BIAS
from odometry.geometry import se2
from odometry.geometry.angles import wrap_one
from odometry.windows.recorded.stuck import LEAST_S, NEAR_M, NEAR_RAD, TIMES

SIGMAS = 4.0  # poses within these, or the distances by which windows leave poses out, stay
LEAST_POSES = 3  # that stay, once treads have led away
EVERY_S = 0.2  # a pose is looked at, until the robot is stuck
IN_A_ROW = 3  # poses elsewhere, before the robot is free
STUCK, HELD_POSES = "stuck", "held_poses"  # kinds of events, whose value is how far treads led
JUMP_TIMES = 2.0  # the way of the treads meanwhile: farther from there poses jump

Pose = tuple[float, float, float]  # x, y [m], yaw [rad], which may be NaN


class StuckWatch(NamedTuple):
    """What is remembered of the place at which poses have stayed.

    Attributes
    ----------
    since_s : float
        Stamp of the first pose there.
    place : (x, y, yaw)
        That pose, as measured.
    terrain : str
        In force then.
    near_m, near_rad : float
        Within which poses are there.
    before : (9,), (9, 9)
        State estimate then.
    scale : NoiseScale
        Estimated then.
    parameters : (y_left, y_right, x_icr, bias, alpha_left, alpha_right)
        Of the state estimate then.
    at_s : float
        Stamp up to which treads and gyroscope are followed.
    led, led_last : (x, y, yaw)
        Pose to which they have led since, and that when the last pose was there.
    led_m, treads_rad, gyroscope_rad : float
        How far that is, and the turn by either; NaN where no gyroscope measured one.
    travel_m : float
        Of the treads since.
    out_s : float
        Stamp since when they have led away; NaN where they have not.
    stayed, away : int
        Poses there since `out_s`, and the latest in a row elsewhere.
    is_found : bool
        Whether the robot is stuck.
    """

    since_s: float
    place: Pose
    terrain: str
    near_m: float
    near_rad: float
    before: Gaussian
    scale: NoiseScale
    parameters: tuple[float, ...]
    at_s: float
    led: Pose
    led_last: Pose
    led_m: float = 0.0
    treads_rad: float = 0.0
    gyroscope_rad: float = math.nan
    travel_m: float = 0.0
    out_s: float = math.nan
    stayed: int = 0
    away: int = 0
    is_found: bool = False


def begun(
    pose: Pose,
    stamp_s: float,
    belief: Gaussian,
    scale: NoiseScale,
    pose_covariance: FloatArray,
    *,
    terrain: str,
) -> StuckWatch | None:
    """At a measured pose, `pose_covariance` (3, 3) as scaled; None without a position."""
    if math.isnan(pose[0] + pose[1]):
        return None
    near_m = max(NEAR_M, SIGMAS * math.sqrt(pose_covariance[0, 0]))
    near_rad = max(NEAR_RAD, SIGMAS * math.sqrt(pose_covariance[2, 2]))
    x, y, yaw, *parameters = belief[0].tolist()
    led = x, y, yaw
    return StuckWatch(
        *(stamp_s, pose, terrain, near_m, near_rad, belief, scale, tuple(parameters), stamp_s),
        led=led,
        led_last=led,
    )


def led_on(
    watch: StuckWatch, speeds_m_s: tuple[float, float], yaw_rate_rad_s: float, stamp_s: float
) -> StuckWatch:
    """The watch at a stamp, after tread speeds and a yaw rate of the gyroscope, or NaN.

    Both are taken as those of all the time since `at_s`, and its way as a chord.
    """
    y_left, y_right, x_icr, bias, alpha_left, alpha_right = watch.parameters
    lasts_s = stamp_s - watch.at_s
    left, right = alpha_left * speeds_m_s[0], alpha_right * speeds_m_s[1]
    by_treads = omega = (right - left) / (y_left - y_right)
    turned_rad = watch.gyroscope_rad
    if not math.isnan(yaw_rate_rad_s):
        omega = yaw_rate_rad_s - bias
        turned_rad = omega * lasts_s + (0.0 if math.isnan(turned_rad) else turned_rad)
    along = ((left + right) / 2 + (y_left + y_right) / 2 * omega) * lasts_s
    aside = -x_icr * omega * lasts_s
    x, y, yaw = watch.led
    cosine, sine = math.cos(yaw + omega * lasts_s / 2), math.sin(yaw + omega * lasts_s / 2)
    x += cosine * along - sine * aside
    y += sine * along + cosine * aside
    begin_x, begin_y, _ = watch.before[0][:3].tolist()
    return watch._replace(
        at_s=stamp_s,
        led=(x, y, yaw + omega * lasts_s),
        led_m=math.hypot(x - begin_x, y - begin_y),
        treads_rad=watch.treads_rad + by_treads * lasts_s,
        gyroscope_rad=turned_rad,
        travel_m=watch.travel_m + (abs(left) + abs(right)) / 2 * lasts_s,
    )


def with_pose(watch: StuckWatch, pose: Pose, stamp_s: float) -> StuckWatch | None:
    """The watch after a measured pose; None once the robot is elsewhere, or turns there."""
    if math.isnan(pose[0] + pose[1]):
        return watch
    if not is_there(watch, pose):
        away = watch.away + 1
        return watch._replace(away=away) if watch.is_found and away < IN_A_ROW else None
    is_turned = by_gyroscope(watch, pose, stamp_s) > watch.near_rad / 2
    return None if is_turned else at_place(watch, stamp_s)


def at_place(watch: StuckWatch, stamp_s: float) -> StuckWatch:
    """The watch after a pose there."""
    led_times = _led_times(watch)
    if led_times < 1:
        return watch._replace(out_s=math.nan, stayed=0, away=0) if watch.stayed else watch
    out_s = stamp_s if math.isnan(watch.out_s) else watch.out_s
    stayed = watch.stayed + 1
    long_there = stamp_s - out_s >= LEAST_S and stayed >= LEAST_POSES
    found = watch.is_found or (long_there and led_times >= TIMES)
    return watch._replace(led_last=watch.led, out_s=out_s, stayed=stayed, away=0, is_found=found)


def _led_times(watch: StuckWatch) -> float:
    """How many times the distance or the turn within which poses stay treads have led."""
    is_yaw_known = not (math.isnan(watch.place[2]) and math.isnan(watch.gyroscope_rad))
    by_turn = abs(watch.treads_rad) / watch.near_rad if is_yaw_known else 0.0
    return max(watch.led_m / watch.near_m, by_turn)


def is_there(watch: StuckWatch, pose: Pose) -> bool:
    """Whether a pose is at the place."""
    x, y, _ = watch.place
    is_near = math.hypot(pose[0] - x, pose[1] - y) <= watch.near_m
    return is_near and abs(turn_rad(watch, pose)) <= watch.near_rad


def by_gyroscope(watch: StuckWatch, pose: Pose, stamp_s: float) -> float:
    """How far the gyroscope turned and a pose did not for certain [rad]: then the pose is held."""
    if math.isnan(watch.gyroscope_rad):
        return 0.0
    sigma_rad_s = math.sqrt(watch.before[1][GYRO_BIAS, GYRO_BIAS])
    drift_rad = SIGMAS * sigma_rad_s * (stamp_s - watch.since_s)
    return abs(wrap_one(watch.gyroscope_rad - turn_rad(watch, pose))) - drift_rad


def turn_rad(watch: StuckWatch, pose: Pose) -> float:
    """Measured turn to a pose; 0 where none is known."""
    turned_rad = pose[2] - watch.place[2]
    return 0.0 if math.isnan(turned_rad) else wrap_one(turned_rad)


def where_treads_led(watch: StuckWatch, mean: FloatArray, near: int) -> OtherPlace:
    """Where the robot is if its poses are held, of an estimate with a mean (9,)."""
    motion = se2.compose(np.array(watch.led), se2.inverse(mean[:3]))
    return OtherPlace(watch.since_s, motion, watch.before[1][:3, :3], near)


def freed(watch: StuckWatch, pose: Pose, stamp_s: float) -> tuple[FilterEvent, ...]:
    """The event of a robot that was stuck until a pose elsewhere, or of poses held until it.

    Poses that were held jump: no robot goes farther than its treads.
    """
    return (held_event(watch, pose, stamp_s),) if jumped(watch, pose) else ended(watch, stamp_s)


def jumped(watch: StuckWatch, pose: Pose) -> bool:
    """Whether a pose jumped from the place: farther than treads can have led since the last."""
    went_m = math.dist(watch.led[:2], watch.led_last[:2])
    return math.dist(pose[:2], watch.place[:2]) > 2 * watch.near_m + JUMP_TIMES * went_m


def held_event(watch: StuckWatch, pose: Pose, stamp_s: float) -> FilterEvent:
    """Of poses that were held until one elsewhere."""
    jump_m = math.dist(pose[:2], watch.place[:2])
    text = (
        f"{_stayed(watch, stamp_s)}, and jumped by {jump_m:.2f} m then: they were held, and the "
        "estimate stayed with them; the filter learned nothing of it"
    )
    return FilterEvent(HELD_POSES, watch.since_s, stamp_s, text, (watch.led_m,))


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
        f"the poses stayed within {watch.near_m:.2f} m for {stamp_s - watch.since_s:.1f} s while "
        f"treads would have moved the robot by {watch.led_m:.2f} m and turned it by "
        f"{math.degrees(abs(watch.treads_rad)):.0f} degrees"
    )
