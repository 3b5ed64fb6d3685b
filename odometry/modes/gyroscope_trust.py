"""Whether the gyroscope is good enough for its yaw rates to distinguish the modes."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.bias_reading import JUMP_SIGMAS, BiasReading, bias_is_open
from odometry.modes.heading_check import WINDOW_S, HeadingCheck
from odometry.modes.modes_config import ModesConfig
from odometry.modes.signals import Signals

HOLDS_S = 2 * WINDOW_S  # the scale of a window where later ones determine none


@dataclass(frozen=True)
class GyroscopeTrust:
    """At the N stamps of a track.

    Attributes
    ----------
    bias_is_open : (N,)
        Whether the bias lies beyond its expected range, by the evidence of a mode alone; or
        measured headings contradict it.
    scale : (N,)
        The gyroscope reads so many times what measured headings turn; NaN where they do not say
        that it is off.
    """

    bias_is_open: BoolArray
    scale: FloatArray


def gyroscope_trust(
    signals: Signals,
    biases_rad_s: FloatArray,
    sigmas_rad_s: FloatArray,
    readings: Mapping[int, BiasReading],
    config: ModesConfig | None = None,
) -> GyroscopeTrust:
    """Of the estimated biases (N,) with deviations (N,) of the filters, and of their readings."""
    open_, stamps_s = bias_is_open(biases_rad_s, readings, config), signals.stamps_s
    check = signals.heading_check
    if check is None:
        return GyroscopeTrust(open_, np.full(len(stamps_s), np.nan))
    last = np.searchsorted(check.stamps_s, stamps_s, side="right") - 1
    known = (last >= 0) & (stamps_s - check.stamps_s[last] <= WINDOW_S)
    off = np.abs(biases_rad_s - check.bias_rad_s[last])
    contradicted = off > JUMP_SIGMAS * np.hypot(sigmas_rad_s, check.bias_sigma_rad_s[last])
    scale = np.where(last >= 0, scale_in_force(check)[last], np.nan)
    return GyroscopeTrust(open_ | (known & contradicted), scale)


def scale_in_force(check: HeadingCheck) -> FloatArray:
    """The scale (K,) of the last window in which it is off.

    NaN once a later one shows it right, or none showed it off for HOLDS_S.
    """
    says = check.scale_is_off | check.scale_is_right
    last = np.maximum.accumulate(np.where(says, np.arange(len(says)), 0))
    holds = check.scale_is_off[last] & (check.stamps_s - check.stamps_s[last] <= HOLDS_S)
    return np.where(holds, check.scale[last], np.nan)
