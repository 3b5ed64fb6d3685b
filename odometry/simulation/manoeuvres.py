"""Tread speed programmes of given curvature: the drives of Salvi 2024, sections III and V.

Arrays (N, 2) of left and right speed [m/s], one row a stamp; all start and end at rest. A curvature
c (to the left where it is positive) is commanded by the pair speed (1 -+ c width / 2): a vehicle
whose effective width that is drives it.
"""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import SimulationError
from odometry.simulation.commands import ACCELERATION_M_S2, segments


def skidpad(
    duration_s: float,
    step_s: float,
    *,
    width_m: float,
    radius_m: float,
    speeds_m_s: Sequence[float],
) -> FloatArray:
    """Turns of one radius from rest to rest, to the left and to the right at each speed.

    All have equal times: a robot that starts in a turn slips by more than one that turns steadily.

    Raises
    ------
    SimulationError
        If the duration does not suffice to reach the speeds.
    """
    half = width_m / 2 / radius_m
    ramps_s = [speed * (1 + half) / ACCELERATION_M_S2 for speed in speeds_m_s]
    turn_s, least_s = duration_s / 2 / len(ramps_s), 2 * max(ramps_s)
    if turn_s < least_s:
        raise SimulationError(
            f"a skidpad of {duration_s:g} s: expected {2 * len(ramps_s) * least_s:.3g} s or more "
            f"for {2 * len(ramps_s)} turns from rest to rest"
        )
    turns = []
    for speed, ramp_s in zip(speeds_m_s, ramps_s, strict=True):
        for side in (1, -1):
            left, right = speed * (1 - side * half), speed * (1 + side * half)
            turns += [(turn_s - ramp_s, left, right), (ramp_s, 0.0, 0.0)]
    return segments(turns, step_s)


def clothoid(
    duration_s: float,
    step_s: float,
    *,
    width_m: float,
    speed_m_s: float,
    smallest_radius_m: float,
) -> FloatArray:
    """Curvature that rises linearly with the way and falls back, to the left, then to the right.

    The ramps of start and stop are straight.
    """
    speeds = _trapezoid(duration_s, step_s, speed_m_s, 0.0)
    way, ramp_m = _way(speeds, step_s), speed_m_s**2 / ACCELERATION_M_S2 / 2
    knots = np.linspace(ramp_m, way[-1] - ramp_m, 5)
    curvature = np.interp(way, knots, np.array([0, 1, 0, -1, 0]) / smallest_radius_m)
    return _steered(speeds, curvature, width_m, step_s)


def sinusoid(
    duration_s: float,
    step_s: float,
    *,
    speed_m_s: float,
    difference_m_s: float,
    period_s: float,
) -> FloatArray:
    """A steady speed, and a difference of speeds (right less left) that is a sine.

    The sine has as many full periods as fit between the ramps of start and stop.
    """
    ramp = speed_m_s / ACCELERATION_M_S2
    periods = max(1, int((duration_s - 2 * ramp) / period_s))
    total = 2 * ramp + periods * period_s
    speeds = _trapezoid(total, step_s, speed_m_s, 0.0)
    since = np.clip(np.arange(len(speeds)) * step_s - ramp, 0.0, periods * period_s)
    half = difference_m_s / 2 * np.sin(2 * np.pi * since / period_s)
    return _checked(np.stack([speeds - half, speeds + half], axis=-1), step_s)


def outward_spiral(
    duration_s: float,
    step_s: float,
    *,
    width_m: float,
    speed_m_s: float,
    radii_m: tuple[float, float],
    side: int = 1,
) -> FloatArray:
    """A radius of turn that grows at a constant rate from the first to the last of `radii_m`.

    `side` is 1 to the left, -1 to the right.
    """
    speeds = _trapezoid(duration_s, step_s, speed_m_s, width_m / radii_m[0])
    radius = np.linspace(*radii_m, len(speeds))
    return _steered(speeds, side / radius, width_m, step_s)


def _trapezoid(
    duration_s: float, step_s: float, speed_m_s: float, most_turned: float
) -> FloatArray:
    """Mean of the treads (N,): up, steady, down.

    The ramps are so slow that the outer tread keeps to the acceleration where the treads differ
    by `most_turned` times their mean.
    """
    stamps = np.arange(round(duration_s / step_s) + 1) * step_s
    ramp = speed_m_s * (1 + most_turned / 2) / ACCELERATION_M_S2
    if 2 * ramp > stamps[-1] + step_s:
        raise SimulationError(
            f"{duration_s:g} s are too short for two ramps of {ramp:g} s to and from "
            f"{speed_m_s:g} m/s"
        )
    return np.asarray(speed_m_s * np.clip(np.minimum(stamps, stamps[-1] - stamps) / ramp, 0, 1))


def _way(speeds_m_s: FloatArray, step_s: float) -> FloatArray:
    """Way (N,) at each stamp; the speed changes linearly between stamps."""
    steps = (speeds_m_s[1:] + speeds_m_s[:-1]) / 2 * step_s
    return np.concatenate([[0.0], np.cumsum(steps)])


def _steered(
    speeds_m_s: FloatArray, curvature_1_m: FloatArray, width_m: float, step_s: float
) -> FloatArray:
    half = curvature_1_m * width_m / 2
    pairs = np.stack([speeds_m_s * (1 - half), speeds_m_s * (1 + half)], axis=-1)
    return _checked(pairs, step_s)


def _checked(speeds: FloatArray, step_s: float) -> FloatArray:
    most = float(np.abs(np.diff(speeds, axis=0)).max()) / step_s
    if most > 1.001 * ACCELERATION_M_S2:
        raise SimulationError(
            f"the treads change by {most:.3g} m/s2, at most {ACCELERATION_M_S2:g} m/s2 is meant: "
            "take a lower speed, a wider turn or more time"
        )
    return speeds
