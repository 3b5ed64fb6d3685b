"""Tread speed programmes: arrays (N, 2) of left and right speed [m/s], one row a stamp.

All start and end at rest, and change at the given acceleration. Turns are counter-clockwise where
the difference (right less left) is positive. `drive(speed, difference)` means the pair
speed -+ difference / 2.
"""

from collections.abc import Iterable

import numpy as np

from odometry.arrays import FloatArray
from odometry.simulation.errors import SimulationError

ACCELERATION_M_S2 = 1.0


def segments(
    pairs: Iterable[tuple[float, float, float]],
    step_s: float,
    acceleration_m_s2: float = ACCELERATION_M_S2,
) -> FloatArray:
    """Constant speeds one after another, joined by ramps.

    Parameters
    ----------
    pairs : iterable of (duration_s, left, right)
        A segment's ramp from the speeds before lies in its duration; the stop comes after the
        last one.
    step_s : float
        Time between stamps.
    acceleration_m_s2 : float
        Of the tread that changes most; both reach their speeds together.

    Returns
    -------
    (N, 2) array

    Raises
    ------
    SimulationError
        If a segment is too short for its ramp.
    """
    times, knots = [0.0], [(0.0, 0.0)]
    for duration, left, right in (*pairs, (None, 0.0, 0.0)):
        start, before = times[-1], knots[-1]
        ramp = max(abs(left - before[0]), abs(right - before[1])) / acceleration_m_s2
        length = ramp if duration is None else duration
        if ramp > length:
            raise SimulationError(
                f"a segment of {length:g} s is too short for a ramp of {ramp:g} s at "
                f"{acceleration_m_s2:g} m/s2"
            )
        times += [start + ramp, start + length]
        knots += [(left, right), (left, right)]
    stamps = np.arange(int(np.ceil(times[-1] / step_s)) + 1) * step_s
    places = np.array(knots)
    return np.stack([np.interp(stamps, times, places[:, i]) for i in (0, 1)], axis=-1)


def excitation(
    duration_s: float,
    step_s: float,
    *,
    max_speed_m_s: float,
    rng: np.random.Generator,
    hold_s: float = 4.0,
    acceleration_m_s2: float = ACCELERATION_M_S2,
) -> FloatArray:
    """Random pairs of speeds that cover the (left, right) plane evenly, as calibration drives do.

    Each of n holds draws left and right from strata of its own (a Latin hypercube), so that even
    few holds reach slow and fast, both turns and both directions. All seeds give one length.
    """
    stop_s = max_speed_m_s / acceleration_m_s2
    count = max(1, int((duration_s - stop_s) / hold_s))
    strata = np.stack([rng.permutation(count), rng.permutation(count)], axis=-1)
    pairs = max_speed_m_s * (2 * (strata + rng.uniform(size=(count, 2))) / count - 1)
    held = [(hold_s, float(left), float(right)) for left, right in pairs]
    rest_s = max(stop_s, duration_s - count * hold_s)
    return segments([*held, (rest_s, 0.0, 0.0)], step_s, acceleration_m_s2)


def spin(duration_s: float, step_s: float, *, speed_m_s: float) -> FloatArray:
    """Turn on the spot, counter-clockwise for positive speed."""
    return segments([(duration_s, -speed_m_s, speed_m_s)], step_s)


def figure_eight(
    duration_s: float,
    step_s: float,
    *,
    speed_m_s: float,
    difference_m_s: float,
    loop_s: float,
) -> FloatArray:
    """Circles to the left and to the right in turn, each of `loop_s`, of equal speeds.

    A loop closes where `loop_s` is the time of a full turn at this difference.
    """
    half = difference_m_s / 2
    left = (loop_s, speed_m_s - half, speed_m_s + half)
    right = (loop_s, speed_m_s + half, speed_m_s - half)
    return segments([(left, right)[i % 2] for i in range(_count(duration_s, loop_s))], step_s)


def tour(
    duration_s: float,
    step_s: float,
    *,
    speed_m_s: float,
    difference_m_s: float,
    turn_s: float,
    straight_s: float,
) -> FloatArray:
    """Straight legs joined by turns: left, left, right, right, and again.

    With `turn_s` the time of a quarter turn the way is a meander of parallel lanes.
    """
    half = difference_m_s / 2
    ahead = (straight_s, speed_m_s, speed_m_s)
    left = (turn_s, speed_m_s - half, speed_m_s + half)
    right = (turn_s, speed_m_s + half, speed_m_s - half)
    legs = _count(duration_s, straight_s + turn_s)
    pairs = [pair for i in range(legs) for pair in (ahead, (left, left, right, right)[i % 4])]
    return segments(pairs, step_s)


def _count(duration_s: float, part_s: float) -> int:
    return max(1, round(duration_s / part_s))
