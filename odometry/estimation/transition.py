"""Motion of the filter's state over one time step, and its derivative."""

import math

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry.angles import wrap_one
from odometry.geometry.se2 import SMALL_ANGLE

STATES = 9  # see `transition`
X, Y, YAW, Y_LEFT, Y_RIGHT, X_ICR, GYRO_BIAS, ALPHA_LEFT, ALPHA_RIGHT = range(STATES)
UNCHANGED = np.eye(STATES)
NO_SPEEDS, NO_TWIST = np.zeros(2), np.zeros(3)


def transition(
    state: FloatArray,
    tread_speeds: FloatArray,
    step_s: float,
    *,
    yaw_rate_rad_s: float = math.nan,
    added_speeds: FloatArray = NO_SPEEDS,
    added_twist: FloatArray = NO_TWIST,
) -> tuple[FloatArray, FloatArray]:
    """Carry a state along at constant tread speeds.

    Parameters
    ----------
    state : (9,)
        x, y [m], yaw [rad], y_left, y_right, x_icr [m], bias of the gyroscope [rad/s],
        alpha_left, alpha_right.
    tread_speeds : (2,)
        As measured, left and right [m/s].
    step_s : float
    yaw_rate_rad_s : float
        Of the gyroscope; where it is NaN, the treads turn the robot.
    added_speeds, added_twist : (2,), (3,)
        What effects add to the tread speeds before slip, and to the body twist of the ICRs.

    Returns
    -------
    next_state : (9,)
        Chen 2023 eq. 1 and 4, integrated exactly along the arc instead of by the Euler step of
        eq. 5 and 6, so that splitting a step changes nothing. All but the pose stay; yaw in
        (-pi, pi].
    jacobian : (9, 9)
        Its derivative by `state`: I + dT df/dX of eq. 8 in the limit of small steps.

    Notes
    -----
    The two treads pass over the same ICR line: v_x = alpha_left v_left + y_left omega =
    alpha_right v_right + y_right omega (Baril 2020 eq. 4 to 6). Where the gyroscope measures omega,
    the two disagree by slip, and v_x is their mean.
    """
    x, y, yaw, y_left, y_right, x_icr, bias, alpha_left, alpha_right = state.tolist()
    left, right = tread_speeds.tolist()
    added_left, added_right = added_speeds.tolist()
    left, right = left + added_left, right + added_right
    added_x, added_y, added_omega = added_twist.tolist()
    if math.isnan(yaw_rate_rad_s):
        width = y_left - y_right
        omega = (alpha_right * right - alpha_left * left) / width  # Chen 2023 eq. 3, third row
        by_bias = 0.0
        by_width, by_left, by_right = -omega / width, -left / width, right / width
    else:
        omega = yaw_rate_rad_s - bias - added_omega
        by_bias = -1.0
        by_width = by_left = by_right = 0.0
    middle = (y_left + y_right) / 2
    ahead = (alpha_left * left + alpha_right * right) / 2 + middle * omega + added_x
    angle = (omega + added_omega) * step_s
    along, across = ahead * step_s, (added_y - x_icr * omega) * step_s
    sine_ratio, cosine_ratio, sine_slope, cosine_slope = _arc(angle)
    cosine, sine = math.cos(yaw), math.sin(yaw)
    # displacement in the world by (along, across, angle): rotation times derivative of the arc
    end_x = sine_ratio * along - cosine_ratio * across
    end_y = cosine_ratio * along + sine_ratio * across
    turn_x = sine_slope * along - cosine_slope * across
    turn_y = cosine_slope * along + sine_slope * across
    one, two = cosine * sine_ratio - sine * cosine_ratio, cosine * cosine_ratio + sine * sine_ratio
    three, four = cosine * turn_x - sine * turn_y, sine * turn_x + cosine * turn_y
    moved_x, moved_y = cosine * end_x - sine * end_y, sine * end_x + cosine * end_y
    # by omega: v_x changes by `middle`, v_y by -x_icr
    by_omega_x = (one * middle + two * x_icr + three) * step_s
    by_omega_y = (two * middle - one * x_icr + four) * step_s
    half, across_step = step_s / 2, -omega * step_s
    jacobian = UNCHANGED.copy()
    jacobian[0, 2:] = (
        -moved_y,  # Chen 2023 eq. 9: d(Xdot)/d(theta) = -Ydot
        by_omega_x * by_width + one * omega * half,
        -by_omega_x * by_width + one * omega * half,
        -two * across_step,
        by_omega_x * by_bias,
        by_omega_x * by_left + one * left * half,
        by_omega_x * by_right + one * right * half,
    )
    jacobian[1, 2:] = (
        moved_x,  # Chen 2023 eq. 9: d(Ydot)/d(theta) = +Xdot
        by_omega_y * by_width + two * omega * half,
        -by_omega_y * by_width + two * omega * half,
        one * across_step,
        by_omega_y * by_bias,
        by_omega_y * by_left + two * left * half,
        by_omega_y * by_right + two * right * half,
    )
    if math.isnan(yaw_rate_rad_s):
        jacobian[2, 3:] = (
            by_width * step_s,
            -by_width * step_s,
            0.0,
            0.0,
            by_left * step_s,
            by_right * step_s,
        )
    else:
        jacobian[2, GYRO_BIAS] = -step_s
    ends = x + moved_x, y + moved_y, wrap_one(yaw + angle)
    return np.array([*ends, y_left, y_right, x_icr, bias, alpha_left, alpha_right]), jacobian


def moved_pose(
    pose: FloatArray,
    state: FloatArray,
    tread_speeds: FloatArray,
    step_s: float,
    *,
    yaw_rate_rad_s: float = math.nan,
    added_speeds: FloatArray = NO_SPEEDS,
    added_twist: FloatArray = NO_TWIST,
) -> FloatArray:
    """The pose (3,) that `transition` carries another pose (3,) to, without the derivative.

    The parameters are those of `transition`; of the state all but the pose counts.
    """
    x, y, yaw = pose.tolist()
    _, _, _, y_left, y_right, x_icr, bias, alpha_left, alpha_right = state.tolist()
    left, right = (tread_speeds + added_speeds).tolist()
    added_x, added_y, added_omega = added_twist.tolist()
    if math.isnan(yaw_rate_rad_s):
        omega = (alpha_right * right - alpha_left * left) / (y_left - y_right)
    else:
        omega = yaw_rate_rad_s - bias - added_omega
    ahead = (alpha_left * left + alpha_right * right) / 2 + (y_left + y_right) / 2 * omega + added_x
    angle = (omega + added_omega) * step_s
    along, across = ahead * step_s, (added_y - x_icr * omega) * step_s
    sine_ratio, cosine_ratio, _, _ = _arc(angle)
    cosine, sine = math.cos(yaw), math.sin(yaw)
    end_x = sine_ratio * along - cosine_ratio * across
    end_y = cosine_ratio * along + sine_ratio * across
    moved_x, moved_y = cosine * end_x - sine * end_y, sine * end_x + cosine * end_y
    return np.array([x + moved_x, y + moved_y, wrap_one(yaw + angle)])


def _arc(angle: float) -> tuple[float, float, float, float]:
    """sin(a)/a, (1 - cos(a))/a, and their derivatives by a."""
    if abs(angle) < SMALL_ANGLE:
        return 1.0 - angle**2 / 6, angle / 2, -angle / 3, 0.5 - angle**2 / 8
    sine, cosine = math.sin(angle), math.cos(angle)
    sine_ratio, cosine_ratio = sine / angle, 2 * math.sin(angle / 2) ** 2 / angle
    return (
        sine_ratio,
        cosine_ratio,
        (cosine - sine_ratio) / angle,
        (sine - cosine_ratio) / angle,
    )
