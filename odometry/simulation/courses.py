"""Courses: tread speed programmes that suit a vehicle, and the ground under them."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import SimulationError
from odometry.simulation.commands import (
    ACCELERATION_M_S2,
    excitation,
    figure_eight,
    segments,
    spin,
    tour,
)
from odometry.simulation.contact.slope import Ground, Plane, Zones
from odometry.simulation.contact.steady_state import steady_state
from odometry.simulation.contact.vehicle import ContactVehicle
from odometry.simulation.manoeuvres import clothoid, outward_spiral, sinusoid, skidpad

MANOEUVRES = ("skidpad", "clothoid", "sinusoid", "outward_spiral")
TIGHT_WIDTHS = 1.5  # smallest radius of skidpad and clothoid, in effective widths
SPIRAL_WIDTHS = (1.0, 20.0)  # radii of a spiral's start and end: there the treads differ by 5 %
SLOW_SPEEDS = (1 / 3, 2 / 3, 1.0)  # of a skidpad, as shares of its fastest
WIDE_TURN_M_S = (0.45, 0.55)

STEP_S = 0.02
CRUISE, TURN = 0.6, 0.8  # mean speed and difference of speeds, as shares of the largest speed
LIMITS = {
    "duration_s": (1.0, 86400.0),
    "max_speed_m_s": (0.01, 100.0),
    "slope_rad": (-1.0, 1.0),
    "uphill_rad": (-100.0, 100.0),
}
COURSE_NAMES = ("excitation", "spin", "figure_eight", "tour", *MANOEUVRES)


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
    """Difference of tread speeds by yaw rate in a slow wide turn on level terrain [m]."""
    twists, _ = steady_state(vehicle, np.array([WIDE_TURN_M_S]))
    return float((WIDE_TURN_M_S[1] - WIDE_TURN_M_S[0]) / twists[0, 2])


@dataclass(frozen=True, eq=False)
class Course:
    """What is driven, and where.

    Attributes
    ----------
    tread_speeds_m_s : (N, 2) array
        Left and right at stamps STEP_S apart.
    ground : Ground
    """

    tread_speeds_m_s: FloatArray
    ground: Ground


def make_course(
    name: str,
    vehicle: ContactVehicle,
    *,
    duration_s: float,
    max_speed_m_s: float,
    slope_rad: float,
    uphill_rad: float,
    rng: np.random.Generator,
) -> Course:
    """Make one of COURSE_NAMES; it starts and ends at rest.

    The ground is a plane. That of a tour has three zones, each a third of its way uphill: the
    slope, half of it, and one and a half times it.

    Parameters
    ----------
    name : str
        One of COURSE_NAMES.
    vehicle : ContactVehicle
        Its turning on level terrain decides how long turns take.
    duration_s, max_speed_m_s : float
        About how long, and the largest tread speed.
    slope_rad, uphill_rad : float
        Steepest slope, and the world direction in which the ground rises.
    rng : numpy.random.Generator
        For the excitation, and the side of an outward spiral.

    Raises
    ------
    SimulationError
        If a number is beyond LIMITS, or the name or the course is not possible.
    """
    given = {
        "duration_s": duration_s,
        "max_speed_m_s": max_speed_m_s,
        "slope_rad": slope_rad,
        "uphill_rad": uphill_rad,
    }
    for key, value in given.items():
        low, high = LIMITS[key]
        if not low <= value <= high:
            raise SimulationError(f"{key} = {value:g}, expected {low:g} to {high:g}")
    plane = Plane(slope_rad, uphill_rad)
    if name in MANOEUVRES:
        speeds = manoeuvre(
            name,
            vehicle,
            duration_s=duration_s,
            step_s=STEP_S,
            max_speed_m_s=max_speed_m_s,
            rng=rng,
        )
        return Course(speeds, plane)
    if name == "excitation":
        hold = 2.0 + 2 * max_speed_m_s / ACCELERATION_M_S2
        return Course(
            excitation(duration_s, STEP_S, max_speed_m_s=max_speed_m_s, rng=rng, hold_s=hold), plane
        )
    if name == "spin":
        return Course(spin(duration_s, STEP_S, speed_m_s=max_speed_m_s), plane)
    cruise, turn = CRUISE * max_speed_m_s, TURN * max_speed_m_s
    full_turn_s = 2 * np.pi / turn_rate(vehicle, cruise, turn)
    turning = {"speed_m_s": cruise, "difference_m_s": turn}
    if name == "figure_eight":
        return Course(figure_eight(duration_s, STEP_S, loop_s=full_turn_s, **turning), plane)
    lanes = tour(duration_s, STEP_S, turn_s=full_turn_s / 4, straight_s=full_turn_s, **turning)
    length = cruise * full_turn_s
    legs = duration_s / (1.25 * full_turn_s)
    return Course(lanes, _three_zones(slope_rad, uphill_rad, length, length * legs / 2))


def _three_zones(slope_rad: float, uphill_rad: float, x_m: float, y_m: float) -> Zones:
    """Zones that part the rectangle (0, 0) to (x, y) in thirds along the uphill direction."""
    corners = np.array([0.0, x_m, 1j * y_m, x_m + 1j * y_m])
    along = (corners * np.exp(-1j * uphill_rad)).real
    low, third = float(along.min()), float(np.ptp(along)) / 3
    slopes = (slope_rad, slope_rad / 2, 1.5 * slope_rad)
    return Zones(slopes, (low + third, low + 2 * third), uphill_rad, crease_m=third / 5)


def slope_paths(vehicle: ContactVehicle) -> dict[str, Course]:
    """Three paths shaped like those of Martinez 2024, Fig. 7, for a vehicle like its J8.

    The slopes of the first two are printed. Open are the starts (here across the slope, heading
    along world x, uphill along y), the speeds but that of the spin, and the third path's zones.
    The durations are about those of the paper's N poses at 10 Hz (Table II): 48, 62 and 88 s.
    """
    uphill = np.pi / 2
    rate = turn_rate(vehicle, 0.5, 0.6)
    quarter = np.pi / 2 / rate
    climb = [
        (8.0, 0.5, 0.5),
        (quarter, 0.2, 0.8),
        (28.0, 0.6, 0.6),
        (quarter, 0.8, 0.2),
        (8.0, 0.5, 0.5),
        (quarter, 0.8, 0.2),
    ]
    left = 88.0 - sum(duration for duration, _, _ in climb)
    return {
        "spin": Course(
            segments([(47.7, 0.3, -0.3)], STEP_S), Plane(float(np.deg2rad(3.6)), uphill)
        ),
        "figure_eight": Course(
            figure_eight(
                61.6,
                STEP_S,
                speed_m_s=0.5,
                difference_m_s=0.6,
                loop_s=2 * np.pi / rate,
            ),
            Plane(float(np.deg2rad(5.3)), uphill),
        ),
        "three_zones": Course(
            segments([*climb, (left, 0.6, 0.6)], STEP_S),
            Zones(tuple(np.deg2rad([5.3, 3.6, 7.0]).tolist()), (6.0, 12.0), uphill, crease_m=1.0),
        ),
    }


def turn_rate(vehicle: ContactVehicle, speed_m_s: float, difference_m_s: float) -> float:
    """Yaw rate [rad/s] of the steady left turn on level terrain."""
    half = difference_m_s / 2
    twists, _ = steady_state(vehicle, np.array([[speed_m_s - half, speed_m_s + half]]))
    return float(twists[0, 2])
