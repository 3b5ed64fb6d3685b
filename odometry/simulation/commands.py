"""Tread speed programmes: arrays (N, 2) of left and right speed [m/s], one row a stamp.

All start and end at rest, and change at the given acceleration. Turns are counter-clockwise where
the difference (right less left) is positive. `drive(speed, difference)` means the pair
speed -+ difference / 2.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import SimulationError

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


@dataclass(frozen=True)
class WeavingDriver:
    """Steers smooth alternating turns about world +x at a changing speed.

    The driver sees the true pose and corrects the heading as a person would; the correction
    knows nothing of ICRs.

    Attributes
    ----------
    speed_m_s, speed_swing : float
        Mean tread speed, and the relative amplitude of its slow change.
    weave_rad, weave_period_s : float
        Amplitude and period of the desired heading's main swing.
    phases_rad : (float, float, float)
        Phases of the main swing, of a second and faster swing, and of the speed.
    steering_m : float
        Difference of tread speeds the driver gives for a desired yaw rate [m/s per rad/s].
    heading_gain_hz : float
        Yaw rate desired per radian of heading error.
    return_rad_per_m : float
        Heading turned back towards the middle of the way per metre away from it.
    largest_difference_m_s : float
        Limit of the difference of tread speeds.
    start_s : float
        Time taken to reach full speed from rest.
    """

    speed_m_s: float = 0.68
    speed_swing: float = 0.12
    weave_rad: float = 0.35
    weave_period_s: float = 12.0
    phases_rad: tuple[float, float, float] = (0.0, 0.0, 0.0)
    steering_m: float = 0.75
    heading_gain_hz: float = 1.5
    return_rad_per_m: float = 0.15
    largest_difference_m_s: float = 0.6
    start_s: float = 2.0

    def tread_speeds_m_s(self, time_s: float, pose_world: FloatArray) -> FloatArray:
        """Tread speeds (left, right) [m/s] at a time and true pose (x, y, yaw)."""
        main, second, pace = self.phases_rad
        rate = 2 * np.pi / self.weave_period_s
        swing = np.array([self.weave_rad, 0.3 * self.weave_rad])
        rates = np.array([rate, 2.3 * rate])
        angles = rates * time_s + [main, second]
        heading = swing @ np.sin(angles) - self.return_rad_per_m * pose_world[1]
        error = np.arctan2(np.sin(heading - pose_world[2]), np.cos(heading - pose_world[2]))
        yaw_rate = (swing * rates) @ np.cos(angles) + self.heading_gain_hz * error
        difference = np.clip(
            self.steering_m * yaw_rate, -self.largest_difference_m_s, self.largest_difference_m_s
        )
        mean = self.speed_m_s * (1 + self.speed_swing * np.sin(0.4 * rate * time_s + pace))
        start = min(1.0, time_s / self.start_s) if self.start_s > 0 else 1.0
        return np.asarray(start * (mean + difference / 2 * np.array([-1.0, 1.0])))
