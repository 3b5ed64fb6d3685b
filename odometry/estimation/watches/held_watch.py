"""Poses that stay while the gyroscope turns: a receiver or a map holds them, and the robot moves.

Treads and gyroscope lead on from the belief of before, however often the filter starts anew at the
place where the poses are held. It is the watch of a robot that is stuck, which goes on.
"""

import math

from odometry.arrays import FloatArray
from odometry.estimation.measurement import Gaussian, Place, pose_measurement
from odometry.estimation.transition import ALPHA_LEFT, ALPHA_RIGHT, YAW
from odometry.estimation.watches import stuck_watch
from odometry.estimation.watches.stuck_watch import Pose, StuckWatch
from odometry.geometry.angles import wrap_one
from odometry.windows.recorded.stuck import TIMES

# A pose is where treads and gyroscope led within so many standard deviations of slip, and at most
# these shares of the travel and of the turn: of 89 that came back in development 73 were within the
# shares, and 72 of these within the deviations
SIGMAS, NEAR, NEAR_TURN = 3.0, 0.2, 0.05
IN_A_ROW = 2  # poses there, before they are believed


def with_pose(
    watch: StuckWatch, pose: FloatArray, stamp_s: float, lever_m: Place, *, slip_noise: float
) -> StuckWatch | None:
    """The watch after a measured pose (3,); None once it is neither held nor where treads led.

    `slip_noise` [m per square root of metre] is that of the filter.
    """
    x, y, yaw = pose.tolist()
    if math.isnan(x + y):
        return watch
    if stuck_watch.is_there(watch, (x, y, yaw)):
        return _with_held(watch, (x, y, yaw), stamp_s)
    came_back = watch.is_found and (watch.away > 0 or _jumped(watch, (x, y, yaw)))
    if not (came_back and _is_where_led(watch, pose, lever_m, slip_noise)):
        return None
    return watch._replace(away=watch.away + 1)


def led_belief(watch: StuckWatch) -> Gaussian:
    """The belief of before, at the place to which treads and gyroscope have led."""
    mean = watch.before[0].copy()
    mean[:3] = watch.led
    return mean, watch.before[1]


def _with_held(watch: StuckWatch, pose: Pose, stamp_s: float) -> StuckWatch:
    """The watch after a pose at the place: found where the gyroscope turned for certain."""
    after = stuck_watch.at_place(watch, stamp_s)
    turned = stuck_watch.by_gyroscope(after, pose, stamp_s) > watch.near_rad
    if math.isnan(pose[YAW]):  # then a robot that turns on the spot is there as well
        turned = turned and after.led_m >= TIMES * watch.near_m
    return after if turned or watch.is_found else after._replace(is_found=False)


def _jumped(watch: StuckWatch, pose: Pose) -> bool:
    """Whether a pose or its yaw jumped from the place."""
    went_rad = abs(wrap_one(watch.led[YAW] - watch.led_last[YAW]))
    most_rad = 2 * watch.near_rad + stuck_watch.JUMP_TIMES * went_rad
    return stuck_watch.jumped(watch, pose) or abs(stuck_watch.turn_rad(watch, pose)) > most_rad


def _is_where_led(watch: StuckWatch, pose: FloatArray, lever_m: Place, slip_noise: float) -> bool:
    """Whether a pose is where treads and gyroscope led, and much nearer there than to the place."""
    mean, covariance = led_belief(watch)
    x, y, *turn = pose_measurement(mean, pose, covariance[:3, :3], lever_m).residual.tolist()
    apart_m, apart_rad = math.hypot(x, y), abs(sum(turn))
    of_factors = max(covariance[ALPHA_LEFT, ALPHA_LEFT], covariance[ALPHA_RIGHT, ALPHA_RIGHT])
    by_slip = slip_noise**2 * watch.scale.slip * watch.travel_m
    sigma_m = math.sqrt(by_slip + of_factors * watch.travel_m**2)
    if apart_m > watch.near_m + min(SIGMAS * sigma_m, NEAR * watch.travel_m):
        return False
    if apart_rad > watch.near_rad + NEAR_TURN * abs(watch.gyroscope_rad):
        return False
    cells = tuple(pose.tolist())
    return (
        apart_m < math.dist(cells[:2], watch.place[:2]) / 2
        or apart_rad + watch.near_rad < abs(stuck_watch.turn_rad(watch, cells)) / 2
    )
