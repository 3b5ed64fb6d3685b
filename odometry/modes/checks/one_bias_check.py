"""Whether the robot turns as the most probable velocity mode does, if the gyroscope has one bias.

A robot that turns slowly turns by as much as the bias of its gyroscope may be. A mode that is not
the true one then explains a left turn by one bias and the next right turn by another, and filters
follow: at each moment hardly anything is left. On a circle the bias goes away with time. Over a
minute it is one bias, near what was believed of it before. It is found together with the share by
which the gain of the mode is off.
"""

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.checks.between_modes import normal_sums, share_of
from odometry.modes.checks.turn_gain_check import ways_to_next
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals

# Chosen with `one_bias_sigmas` of `ModesConfig` on robots of any pace (tests/studies/modes.md).
WINDOW_S = 60.0  # turns to both sides lie in it
# What was believed of the bias so long ago came of other turns, and by how much it may be off now.
BEFORE_S, WALKS_RAD_S = 120.0, 0.002
TOLERANCE = 0.01  # as a share: no gain is identified better
# Of the way to the next mode: by less even a mode that is known well differs from drive to drive.
LEAST_WAY = 0.1
MOST_SIGMAS = 6.0  # of one error about the bias: a spike is no gain


def one_bias_check(
    signals: Signals,
    modes: VelocityModes,
    leading: IntArray,
    believed: tuple[FloatArray, FloatArray, float],
    config: ModesConfig | None = None,
) -> BoolArray:
    """Where (N,) the gain of the most probable mode is off, whatever constant bias there is.

    Parameters
    ----------
    signals : Signals
        Measured where it depends on the modes.
    modes : VelocityModes
    leading : (N,)
        The most probable mode: what was measured while another one led says nothing of it.
    believed : (N,), (N,), float
        Biases of the filters and their standard deviations [rad/s]; and the share of a measurement
        that is news.
    config : ModesConfig, optional
    """
    config = config or ModesConfig()
    biases_rad_s, sigmas_rad_s, independent = believed
    measured, stamps_s = signals.measured[:, -1], signals.stamps_s
    before = np.searchsorted(stamps_s, stamps_s - BEFORE_S)
    sigmas_before = np.hypot(sigmas_rad_s[before], WALKS_RAD_S)
    predicted = modes.yaw_rates_rad_s(stamps_s, signals.tread_speeds_m_s)
    off = np.zeros(len(signals), dtype=np.bool_)
    for mode in np.unique(leading):
        leads, said = leading == mode, predicted[:, mode]
        more, less = LEAST_WAY * ways_to_next(modes, mode, config.alike_sigmas)
        variance = modes.yaw_rate_variances()[mode]
        bound = MOST_SIGMAS * np.sqrt(variance)
        errors = biases_rad_s + np.clip(measured - said - biases_rad_s, -bound, bound)
        sums = normal_sums(said, np.where(leads, errors, np.nan), stamps_s, WINDOW_S)
        sums[3:] -= sums[:2] * biases_rad_s[before]
        share, of_share = share_of(sums * independent / variance, sigmas_before)
        spread = np.sqrt(of_share + modes.lasting_share()[mode] ** 2 + TOLERANCE**2)
        beyond = np.abs(share) > config.one_bias_sigmas * spread
        off |= leads & beyond & ((share > more) | (share < -less))
    return off
