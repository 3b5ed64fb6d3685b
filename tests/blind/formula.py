"""The papers' formulae in the frame of data/README.md, written from the papers alone."""

import math

import numpy as np


def icr_twist(left, right, y_left, y_right, x_icr):
    """Twist (v_x, v_y, omega) of treads turning about their ICRs (data/README.md)."""
    width = y_left - y_right
    omega = (right - left) / width
    return (right * y_left - left * y_right) / width, -x_icr * omega, omega


def martinez_attitude(roll, pitch):
    """Roll alpha and pitch phi of Martinez 2024 [rad]: Rz(psi) Ry(alpha) Rx(phi), Y forward."""
    alpha = math.asin(math.cos(pitch) * math.sin(roll))
    return alpha, -math.asin(math.sin(pitch) / math.cos(alpha))


def icrs_on_slope(left, right, icrs, attitude, p):
    """ICRs (y_left, y_right, x_icr) on a slope: Martinez 2024, eq. 5-10 and the limits.

    His x is ours to the right, so that x_l = -y_left and x_r = -y_right; his y_ICR is x_icr.
    """
    alpha, phi = attitude
    turn = (right > left) - (right < left)  # eq. 8
    common = turn * max(p["v_max"] - abs(right + left) / 2, 0.0)
    x_left, x_right, y = -icrs[0], -icrs[1], icrs[2]
    x_left += common * p["lambda_1"] * phi  # eq. 5
    x_right += common * p["lambda_1"] * phi  # eq. 6
    y += common * p["lambda_1"] * alpha  # eq. 7
    if abs(phi) > abs(alpha):
        more = (1 - abs(alpha / phi)) * common * p["lambda_2"] * phi
        if turn * phi < 0:
            x_left += more  # eq. 9
        else:
            x_right += more  # eq. 10
    x_left = min(x_left, -p["half_width"])
    x_right = max(x_right, p["half_width"])
    y = math.copysign(min(abs(y), p["half_length"]), y)
    return -x_left, -x_right, y


def half_width_by_curvature(left, right, p):
    """Half the effective width (N,): Baril 2020, eq. 10 and 11; the straight is their limit."""
    difference = np.abs(right - left)
    turning = difference > 1e-9
    curvature = np.abs(right + left) / np.where(turning, difference, 1.0)
    bend = p["beta_1"] / (1 + p["beta_2"] * np.sqrt(curvature))
    return p["track_width"] / 2 * (1 + np.where(turning, bend, 0.0))


def icrs_by_curvature(left, right, icrs, p):
    """ICRs as far apart as the law says, about the same middle."""
    half = half_width_by_curvature(left, right, p)
    middle = (icrs[0] + icrs[1]) / 2
    return middle + half, middle - half, icrs[2]


def icrs_by_force(left, right, icrs, force, p):
    """ICRs under a force of inertia [N]: Martinez 2017, eq. 14-15, 25-27 and 28-30."""
    across, along = np.sign(left - right), np.sign(left + p["h"] * right)
    width = p["track_width"]
    zeta = icrs[2] + p["zeta_1"] * force * along
    epsilon = -(icrs[0] + icrs[1]) / 2 + p["epsilon_1"] * force * across * along
    eta = (icrs[0] - icrs[1]) / width + p["eta_1"] * force * across * along
    eta = np.maximum(eta + p["eta_2"] * force**2, 0.3)
    return -epsilon + width * eta / 2, -epsilon - width * eta / 2, zeta


def force_of_inertia(twist, p):
    """|F| [N] of a twist: Martinez 2017, eq. 11, with our axes."""
    v_x, v_y, omega = twist
    return p["mass"] * np.abs(omega) * np.hypot(v_y + p["x_cm"] * omega, v_x - p["y_cm"] * omega)


def icrs_under_inertia(left, right, icrs, p):
    """ICRs (N,) under the force that their own motion makes, by bisection."""

    def made(force):
        return force_of_inertia(
            icr_twist(left, right, *icrs_by_force(left, right, icrs, force, p)), p
        )

    low = np.zeros_like(left)
    high = np.full_like(left, 4 * made(low).max() + 1.0)
    for _ in range(60):
        middle = (low + high) / 2
        more = made(middle) > middle
        low, high = np.where(more, middle, low), np.where(more, high, middle)
    return icrs_by_force(left, right, icrs, (low + high) / 2, p)
