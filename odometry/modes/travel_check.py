"""What the modes say the robot travelled, held against what measured positions say.

Yaw rate alone cannot tell a load that presses both tyres, or any other change of the wheels' size,
from another terrain: both turn by less for the same tread speeds. On another terrain the robot
still travels as far as that mode says.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.first_order_lag import lagged
from odometry.modes.measured_travel import MeasuredTravel
from odometry.modes.response import SLOWEST_HZ
from odometry.modes.signals import Signals
from odometry.modes.velocity import VelocityModes

WINDOW_S, EVERY_S = 10.0, 0.5
LEAST_STEPS = 10  # of a window
TOLERANCE = 0.01  # of the distance: no mode is identified better
OFF_SIGMAS = 3.0  # beyond which a mode travels by another distance than measured
HOLDS_S = 10.0  # what a window says, where no later one does
"""Chosen on seeds 50, 51, 60 and 61 of `tests/studies/modes_faults.py`."""


@dataclass(frozen=True)
class TravelCheck:
    """At the N stamps of a track.

    Attributes
    ----------
    off : (N, M)
        Modes that travel by another distance than was measured.
    ratio : (N, M)
        Measured distance by that of the mode; NaN where none was measured.
    """

    off: BoolArray
    ratio: FloatArray


def travel_check(signals: Signals, modes: VelocityModes) -> TravelCheck | None:
    """None without measured travel, or where modes were identified without it."""
    travel = signals.travel
    if travel is None or modes.speed_power is None:
        return None
    ends_s = np.arange(travel.begin_s[0] + WINDOW_S, travel.end_s[-1] + 1e-9, EVERY_S)
    first = np.searchsorted(travel.begin_s, ends_s - WINDOW_S)
    after = np.searchsorted(travel.end_s, ends_s + 1e-9, side="right")
    enough = after - first >= LEAST_STEPS
    if not enough.any():
        return None
    ends_s, windows = ends_s[enough], (first[enough], after[enough])
    of_modes = [
        _compared(travel, *_said(signals, travel, modes, place, power), windows)
        for place, power in enumerate(modes.speed_power)
    ]
    off, ratio = np.stack(of_modes, axis=-1)
    last = np.searchsorted(ends_s, signals.stamps_s, side="right") - 1
    known = (last >= 0) & (signals.stamps_s - ends_s[last] <= HOLDS_S)
    return TravelCheck(
        (np.abs(off[last]) > OFF_SIGMAS) & known[:, None],
        np.where(known[:, None], ratio[last], np.nan),
    )


def _said(
    signals: Signals, travel: MeasuredTravel, modes: VelocityModes, place: int, power: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """What a mode travels in each step (K,) [m], and the variance of its errors (K,)."""
    speed, yaw_rate = (
        lagged(
            signals.tread_speeds_m_s @ modes.steady_gains()[place, row],
            signals.stamps_s,
            1 / max(-modes.A[place, row, row], SLOWEST_HZ),
        )
        for row in range(2)
    )
    steady, turning = power
    said_m = _during(travel, signals.stamps_s, speed)
    return said_m, _during(travel, signals.stamps_s, steady + turning * yaw_rate**2)


def _compared(
    travel: MeasuredTravel,
    said_m: FloatArray,
    variance: FloatArray,
    windows: tuple[IntArray, IntArray],
) -> tuple[FloatArray, FloatArray]:
    """How far (W,) measured travel is from what a mode says, in sigmas, and their ratio (W,)."""
    side = np.sign(said_m)
    turns_back = np.append(0.0, side[1:] != side[:-1])
    columns = [np.abs(said_m), side * travel.ahead_m, *(side[:, None] * travel.turned_m).T]
    distance_m, ahead_m, along_m, across_m, variance, turned_back = (
        _over(windows, column) for column in (*columns, variance, turns_back)
    )
    # of both ways to know the direction the one that agrees: the other heading may be at fault
    measured_m = np.stack([ahead_m, np.hypot(along_m, across_m)])
    apart = np.where(np.isnan(measured_m), np.inf, np.abs(measured_m - distance_m))
    measured_m = measured_m[apart.argmin(axis=0), np.arange(len(distance_m))]
    variance = variance + 2 * travel.noise_m**2 * (1 + turned_back)
    off = (measured_m - distance_m) / np.sqrt(variance + (TOLERANCE * distance_m) ** 2)
    return np.nan_to_num(off), measured_m / np.maximum(distance_m, 1e-9)


def _during(travel: MeasuredTravel, stamps_s: FloatArray, rates: FloatArray) -> FloatArray:
    """Integrals (K,) of rates (N,) over each step."""
    means = (rates[1:] + rates[:-1]) / 2
    whole = np.append(0.0, np.cumsum(means * np.diff(stamps_s)))
    at_end, at_begin = (np.interp(at_s, stamps_s, whole) for at_s in (travel.end_s, travel.begin_s))
    return np.asarray(at_end - at_begin)


def _over(windows: tuple[IntArray, IntArray], values: FloatArray) -> FloatArray:
    """Sums (K,) of the values in each window; NaN where one of them is."""
    known = np.isfinite(values)
    first, after = windows
    whole = np.append(0.0, np.cumsum(np.where(known, values, 0.0)))
    missing = np.append(0, np.cumsum(~known))
    complete = missing[after] == missing[first]
    return np.where(complete, whole[after] - whole[first], np.nan)
