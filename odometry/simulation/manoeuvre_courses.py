"""The manoeuvres of Salvi 2024 at the size and speed that suit a vehicle."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.simulation.commands import ACCELERATION_M_S2
from odometry.simulation.contact.steady_state import steady_state
from odometry.simulation.contact.vehicle import ContactVehicle
from odometry.simulation.manoeuvres import clothoid, outward_spiral, sinusoid, skidpad

MANOEUVRES = ("skidpad", "clothoid", "sinusoid", "outward_spiral")
TIGHT_WIDTHS = 1.5  # smallest radius of skidpad and clothoid, in effective widths
SPIRAL_WIDTHS = (1.0, 20.0)  # radii of a spiral's start and end: there the treads differ by 5 %
SLOW_SPEEDS = (1 / 3, 2 / 3, 1.0)  # of a skidpad, as shares of its fastest
WIDE_TURN_M_S = (0.45, 0.55)


def manoeuvre(
    name: str,
    vehicle: ContactVehicle,
    *,
    duration_s: float,
    step_s: float,
    max_speed_m_s: float,
    rng: np.random.Generator,
) -> FloatArray:
    """Tread speeds (N, 2) of one of MANOEUVRES, whose outer tread reaches the largest speed.

    The generator chooses the side of an outward spiral.
    """
    if name == "sinusoid":
        return sinusoid(
            duration_s,
            step_s,
            speed_m_s=0.6 * max_speed_m_s,
            difference_m_s=0.8 * max_speed_m_s,
            period_s=4.0 + 4.0 * max_speed_m_s / ACCELERATION_M_S2,
        )
    width = effective_width_m(vehicle)
    if name == "outward_spiral":
        return outward_spiral(
            duration_s,
            step_s,
            width_m=width,
            speed_m_s=max_speed_m_s / (1 + 0.5 / SPIRAL_WIDTHS[0]),
            radii_m=(SPIRAL_WIDTHS[0] * width, SPIRAL_WIDTHS[1] * width),
            side=int(rng.choice([1, -1])),
        )
    radius, speed = TIGHT_WIDTHS * width, max_speed_m_s / (1 + 0.5 / TIGHT_WIDTHS)
    if name == "clothoid":
        return clothoid(
            duration_s, step_s, width_m=width, speed_m_s=speed, smallest_radius_m=radius
        )
    speeds = [share * speed for share in SLOW_SPEEDS]
    return skidpad(duration_s, step_s, width_m=width, radius_m=radius, speeds_m_s=speeds)


def effective_width_m(vehicle: ContactVehicle) -> float:
    """Difference of tread speeds by yaw rate in a slow wide turn on level ground [m]."""
    twists, _ = steady_state(vehicle, np.array([WIDE_TURN_M_S]))
    return float((WIDE_TURN_M_S[1] - WIDE_TURN_M_S[0]) / twists[0, 2])
