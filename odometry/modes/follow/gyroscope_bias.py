"""The bias of the gyroscope where the modes do not matter, and whether it distinguishes them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import BIAS_SIGMA_RAD_S, STANDING_M_S, Signals
from odometry.modes.recorded.heading_check import WINDOW_S, HeadingCheck

JUMP_SIGMAS = 4.0  # from the estimated bias: farther off it is another one

STANDING_SHARE = 0.05  # of the fastest: slow robots drive at what is rest of others

SETTLES_S = 0.5  # after the treads stopped
LEAST_S = 0.5  # of what is read after that
MOST_RAD_S = 0.1  # of a bias: more is another fault, or the robot turns though no tread does

HOLDS_S = 2 * WINDOW_S  # the scale of a window where later ones determine none


@dataclass(frozen=True)
class BiasReading:
    """A bias that was read.

    Attributes
    ----------
    bias_rad_s, variance : float
        Mean and its variance.
    tolerance_rad_s : float
        An estimate that is no farther off stays: models of modes turn as much too far on straights.
    """

    bias_rad_s: float
    variance: float
    tolerance_rad_s: float = 0.0


def bias_readings(signals: Signals, fastest_m_s: float = np.inf) -> dict[int, BiasReading]:
    """By row: from the headings of measured poses, and where the robot stood from that.

    `fastest_m_s` is as for `moving`.
    """
    found = {}
    check = signals.heading_check
    if check is not None:
        rows = np.searchsorted(signals.stamps_s, check.stamps_s)
        for place in check.bias_windows:
            if rows[place] < len(signals):
                variance = float(check.bias_sigma_rad_s[place]) ** 2
                found[int(rows[place])] = BiasReading(
                    float(check.bias_rad_s[place]), variance, BIAS_SIGMA_RAD_S
                )
    stood = standing_biases(signals, fastest_m_s)
    return found | {row: BiasReading(*of) for row, of in stood.items()}


def with_reading(
    mean: FloatArray, covariance: FloatArray, read: BiasReading, independent: float
) -> tuple[FloatArray, FloatArray]:
    """Mean (n,) and covariance (n, n) over all modes with a reading; the bias is the last entry.

    The reading is weighed with the estimate; where the two are JUMP_SIGMAS apart the bias is
    another one, and the earlier estimate counts no more. A filter holds the variance of the bias
    less by the share `independent` (see `start` of the modes).
    """
    mean, covariance = mean.copy(), covariance.copy()
    believed = covariance[-1, -1] / independent
    off = read.bias_rad_s - mean[-1]
    if abs(off) <= read.tolerance_rad_s:
        return mean, covariance
    gain = believed / (believed + read.variance)
    if off**2 > JUMP_SIGMAS**2 * (believed + read.variance):
        gain, believed = 1.0, np.inf
    mean[-1] += gain * off
    covariance[-1, -1] = independent / (1 / believed + 1 / read.variance)
    return mean, covariance


def bias_is_open(
    biases_rad_s: FloatArray, readings: Mapping[int, BiasReading], config: ModesConfig | None = None
) -> BoolArray:
    """Where (N,) the estimated bias (N,) of the filters lies beyond its expected range.

    That is 0, and after a reading what was read. A mode that is not the true one explains a turn
    by such a bias, and nothing but that mode is evidence of one.
    """
    expected = np.zeros(len(biases_rad_s))
    for row in sorted(readings):
        expected[row:] = readings[row].bias_rad_s
    least = (config or ModesConfig()).bias_sigmas * BIAS_SIGMA_RAD_S
    return np.asarray(np.abs(biases_rad_s - expected) > least)


def moving(signals: Signals, fastest_m_s: float = np.inf) -> BoolArray:
    """Where (N,) a tread turned before the stamp: at rest nothing depends on the terrain.

    Of a robot whose treads turn at `fastest_m_s` at most, less is rest than of others.
    """
    least_m_s = min(STANDING_M_S, STANDING_SHARE * fastest_m_s)
    turning = np.abs(signals.tread_speeds_m_s).max(axis=1) > least_m_s
    return np.append(False, turning[:-1])


def standing_biases(
    signals: Signals, fastest_m_s: float = np.inf
) -> dict[int, tuple[float, float]]:
    """Mean and its variance, by the last row of each rest that is long enough.

    None of a value that is held. The yaw rate is the last measured entry.
    """
    found: dict[int, tuple[float, float]] = {}
    rows = np.flatnonzero(~moving(signals, fastest_m_s))
    for stand in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1) if len(rows) else []:
        stamps_s = signals.stamps_s[stand]
        readings = signals.measured[stand, -1]
        read = np.isfinite(readings) & (stamps_s >= stamps_s[0] + SETTLES_S)
        readings = readings[read]
        if len(readings) < 2 or np.ptp(stamps_s[read]) < LEAST_S:
            continue
        bias, variance = float(readings.mean()), float(readings.var(ddof=1)) / len(readings)
        if variance > 0 and abs(bias) < MOST_RAD_S:
            found[int(stand[-1])] = (bias, variance)
    return found


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
    open_: BoolArray,
) -> GyroscopeTrust:
    """Of the estimated biases (N,) with deviations (N,) of the filters, which may be open (N,)."""
    stamps_s, check = signals.stamps_s, signals.heading_check
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
