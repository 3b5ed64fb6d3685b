"""What the modes say the robot travelled, held against what measured positions say.

Yaw rate alone cannot distinguish a load that presses both tyres, or any other change of the wheels'
size, from another terrain: both turn by less for the same tread speeds. On another terrain the
robot still travels as far as that mode says.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.models.response import SLOWEST_HZ, lagged
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals
from odometry.modes.recorded.measured_steps import MeasuredTravel, StepWindows, during, step_windows

WINDOWS_S = (5.0, 10.0)
TOLERANCE = 0.01  # of the distance: no mode is identified better


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


def travel_check(
    signals: Signals, modes: VelocityModes, config: ModesConfig | None = None
) -> TravelCheck | None:
    """None without measured travel, or where modes were identified without it.

    What a window says holds for as long as it is, where no later one does. `travel_sigmas` of the
    settings were chosen on seeds 50, 51, 60 and 61 of `tests/studies/modes/modes_faults.py`.
    """
    config = config or ModesConfig()
    travel = signals.travel
    if travel is None or modes.speed_power is None:
        return None
    said = [
        _said(signals, travel, modes, place, power) for place, power in enumerate(modes.speed_power)
    ]
    off = np.zeros((len(signals), len(modes.names)), dtype=np.bool_)
    ratio = np.full(off.shape, np.nan)
    for window_s in WINDOWS_S:
        windows = step_windows(travel.begin_s, travel.end_s, window_s)
        if not len(windows):
            continue
        sigmas, ratios = np.stack([_compared(travel, *of, windows) for of in said], axis=-1)
        last, known = windows.in_force(signals.stamps_s, window_s)
        off |= (np.abs(sigmas[last]) > config.travel_sigmas) & known[:, None]
        ratio = np.where(known[:, None], ratios[last], ratio)
    return TravelCheck(off, ratio) if np.isfinite(ratio).any() else None


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
    said_m = during(travel.begin_s, travel.end_s, signals.stamps_s, speed)
    return said_m, during(
        travel.begin_s, travel.end_s, signals.stamps_s, steady + turning * yaw_rate**2
    )


def _compared(
    travel: MeasuredTravel,
    said_m: FloatArray,
    variance: FloatArray,
    windows: StepWindows,
) -> tuple[FloatArray, FloatArray]:
    """How far (W,) measured travel is from what a mode says, in sigmas, and their ratio (W,)."""
    side = np.sign(said_m)
    turns_back = np.append(0.0, side[1:] != side[:-1])
    columns = [np.abs(said_m), side * travel.ahead_m, *(side[:, None] * travel.turned_m).T]
    distance_m, ahead_m, along_m, across_m, variance, turned_back = (
        windows.sums(column) for column in (*columns, variance, turns_back)
    )
    # of both ways to know the direction the one that agrees: the other heading may be at fault
    measured_m = np.stack([ahead_m, np.hypot(along_m, across_m)])
    apart = np.where(np.isnan(measured_m), np.inf, np.abs(measured_m - distance_m))
    measured_m = measured_m[apart.argmin(axis=0), np.arange(len(distance_m))]
    variance = variance + 2 * travel.noise_m**2 * (1 + turned_back)
    off = (measured_m - distance_m) / np.sqrt(variance + (TOLERANCE * distance_m) ** 2)
    return np.nan_to_num(off), measured_m / np.maximum(distance_m, 1e-9)
