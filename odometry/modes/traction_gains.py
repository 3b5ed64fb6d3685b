"""What is asked of traction modes, and what their gains make of it (Salvi 2024 eq. 3)."""

import numpy as np

from odometry.arrays import FloatArray, IntArray

LEFT_TURN, RIGHT_TURN = 0, 1


def requested(tread_speeds_m_s: FloatArray, track_width: float) -> FloatArray:
    """Speed u_1 [m/s] and turn rate u_2 [rad/s] of eq. 3, u_3, u_4 [m/s], u_5 [m^2/s^3] (..., 5).

    Where inertia does not count, the motion of all treads twice as fast is twice the motion, and
    backward it is the same: what is not linear in u_1 and u_2 depends on the tightness
    r = u_2 track_width / u_1 of the turn. Two such terms are u_3 = u_1 r^2 / (1 + r^2), and
    u_4 = u_1 r / (1 + r^2), which makes wide turns differ from those on the spot, where both are 0.

    Inertia asks for the lateral acceleration u_1 u_2 from the ground. Contacts that roll slip aside
    in proportion to force and speed, so that u_5 = |u_1| (u_1 u_2): the less friction, the more.
    Outward, also backward.
    """
    left, right = np.moveaxis(tread_speeds_m_s, -1, 0)
    speed, difference = (left + right) / 2, right - left
    size = speed**2 + difference**2
    share = speed * difference / np.where(size > 0, size, 1.0)
    turn = difference / track_width
    terms = [speed, turn, difference * share, speed * share, np.abs(speed) * speed * turn]
    return np.stack(terms, axis=-1)


def turns_of(tread_speeds_m_s: FloatArray) -> IntArray:
    """LEFT_TURN or RIGHT_TURN (...), by the side of the turning centre: also backward."""
    left, right = np.moveaxis(tread_speeds_m_s, -1, 0)
    return np.where((left + right) * (right - left) < 0, RIGHT_TURN, LEFT_TURN)


def twists_of(gains: FloatArray, tread_speeds_m_s: FloatArray, track_width: float) -> FloatArray:
    """Twists (..., 3) of gains (..., 2, 3, 5) at tread speeds (..., 2)."""
    to_right = (turns_of(tread_speeds_m_s) == RIGHT_TURN)[..., None, None]
    of_turn = np.where(to_right, gains[..., RIGHT_TURN, :, :], gains[..., LEFT_TURN, :, :])
    return np.asarray((of_turn @ requested(tread_speeds_m_s, track_width)[..., None])[..., 0])
