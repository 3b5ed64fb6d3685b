"""Whether the robot turns as the most probable traction mode does, by the spread of its gain.

A terrain that was not calibrated is named for the mode that is nearest to it: filters allow errors
as large as those of single turns, however long these last. Over the last seconds in which a mode
led, its gain is off by a share that least squares finds; how far a gain is off on drives that it
was not identified from, `identify-modes` has measured (`gain_spread`, `gain_power`).
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.identify.held_out_gains import WINDOW_S, gain_sums
from odometry.modes.models.traction import TractionModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals

# Chosen with `gain_sigmas` of `ModesConfig` on eight worlds of a generator in planar motion and on
# husky_wheels of seeds 85 to 87 (tests/studies/modes.md): windows of 8 s as well bring nothing.
WINDOWS_S = (4.0, 16.0)
TOLERANCE = 0.01  # as a share: no gain is identified better


@dataclass(frozen=True)
class GainCheck:
    """At the N stamps of a track.

    Attributes
    ----------
    off : (N,)
        Where the gain of the most probable mode is off by more than its spread.
    excess : (N,)
        By what share the robot turns more than that mode says, over the longest window; NaN where
        it did not turn.
    """

    off: BoolArray
    excess: FloatArray


def gain_check(
    signals: Signals,
    modes: TractionModes,
    leading: IntArray,
    biases_rad_s: FloatArray,
    config: ModesConfig | None = None,
) -> GainCheck | None:
    """Follow by how much the gain of the most probable mode is off.

    Parameters
    ----------
    signals : Signals
        Measured where it depends on the modes.
    modes : TractionModes
    leading : (N,)
        The most probable mode.
    biases_rad_s : (N,)
        Of the filters.
    config : ModesConfig, optional

    Returns
    -------
    GainCheck or None
        None of a set that does not state how far its gains are off.
    """
    config = config or ModesConfig()
    if modes.gain_spread is None:
        return None
    predicted = modes.yaw_rates_rad_s(signals.stamps_s, signals.tread_speeds_m_s)
    off, excess = np.zeros(len(signals), dtype=np.bool_), np.full(len(signals), np.nan)
    for mode in np.unique(leading):
        leads = leading == mode
        errors = signals.measured[:, -1] - biases_rad_s - predicted[:, mode]
        errors[~leads] = np.nan  # what another mode left says nothing of this one
        for window_s in WINDOWS_S:
            share, information, turned_s = gain_sums(
                predicted[:, mode], errors, signals.stamps_s, window_s
            )
            # turns differ from one to the next: the mean of several differs less
            turns = np.maximum(turned_s / WINDOW_S, 1.0)
            spread = (
                modes.gain_spread[mode] ** 2 / turns + modes.gain_power / information + TOLERANCE**2
            )
            off |= leads & (np.abs(share) > config.gain_sigmas * np.sqrt(spread))
        excess[leads] = share[leads]
    return GainCheck(off, excess)
