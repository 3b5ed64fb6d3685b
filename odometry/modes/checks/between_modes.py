"""A terrain that was not calibrated, whose turns lie between those of two modes that were.

The measured yaw rate is held against a mixture of what two neighbouring modes say: with
`w = w_A + s (w_B - w_A) + b`, the share s and a bias b of the gyroscope are estimated over a window
by linear least squares. Where s lies between 0 and 1 beyond its errors, the terrain is neither A
nor B. A change from A to B within the window leaves such a mean as well, so that both halves of
the window must lie between the two by themselves.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.models.innovation_test import windowed
from odometry.modes.models.traction import TractionModes
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals

WINDOW_S = 16.0
TOLERANCE = 0.01  # of the yaw rate: no mode is identified better
LEAST_INFORMATION = 1.0  # on the share: less determines none
SURE_SHARE = 0.25  # standard deviation of the share of a mode, at most
LEFT_BIAS_RAD_S = 0.003  # standard deviation of the bias beyond that of the filters
"""Chosen on clean runs of seeds 50, 51 and 60 to 63 of `tests/studies/modes/modes_faults.py`, of
which none is taken for a terrain between two; windows of 10 and 12 s take one of 18."""


@dataclass(frozen=True)
class BetweenModes:
    """At the N stamps of a track.

    Attributes
    ----------
    pairs : tuple of (str, str)
        Modes that are next to each other by how much they turn, the one that turns less first.
    place : (N,)
        Of the pair between which the robot turns; -1 where it does not.
    share : (N,)
        How far from the first to the second it turns, 0 to 1; NaN where between no pair.
    """

    pairs: tuple[tuple[str, str], ...]
    place: IntArray
    share: FloatArray

    @property
    def holds(self) -> BoolArray:
        """Where (N,) the robot turns between two modes."""
        return np.asarray(self.place >= 0)


def between_modes(
    signals: Signals,
    modes: VelocityModes | TractionModes,
    biases_rad_s: FloatArray,
    independent: float,
    config: ModesConfig | None = None,
    *,
    stay_s: float = np.inf,
) -> BetweenModes | None:
    """Follow where turns lie between two modes.

    Parameters
    ----------
    signals : Signals
        Measured where it depends on the modes.
    modes : VelocityModes or TractionModes
    biases_rad_s : (N,)
        Of the filters.
    independent : float
        Share of a measurement that is news.
    config : ModesConfig, optional
    stay_s : float
        For which a terrain may last: a part of the window so long that is surely of a mode, or
        beyond, is of no terrain between two. By default only a change within the window is.

    Returns
    -------
    BetweenModes or None
        None of a single mode, and of modes of which one turns more in some turns and less in
        others: what lies between two of them may be a third.
    """
    config = config or ModesConfig()
    of_turns = modes.turn_gains()
    gains = of_turns.mean(axis=1)
    order = np.argsort(gains)
    if (np.diff(of_turns[order], axis=0) < 0).any():
        return None
    pairs = list(zip(order[:-1].tolist(), order[1:].tolist(), strict=True))
    if not pairs:
        return None
    said = modes.yaw_rates_rad_s(signals.stamps_s, signals.tread_speeds_m_s)
    measured = signals.measured[:, -1] - biases_rad_s
    variances = modes.yaw_rate_variances()
    place, share = np.full(len(signals), -1), np.full(len(signals), np.nan)
    for row, (first, second) in enumerate(pairs):
        apart, off = said[:, second] - said[:, first], measured - said[:, first]
        worth = independent / variances[[first, second]].max()
        error = TOLERANCE * gains[second] / max(gains[second] - gains[first], 1e-12)
        (whole,), halves, stays = (
            [of * worth for of in _sums(apart, off, signals.stamps_s, parts)]
            for parts in (1, 2, int(WINDOW_S / stay_s))
        )
        holds = _inside(whole, error, config.between_sigmas)
        for part in halves:
            holds &= _inside(part, error, config.between_half_sigmas)
        for part in stays:
            holds &= ~_is_a_mode(part)
        place[holds], share[holds] = row, share_of(whole)[0][holds]
    names = tuple((modes.names[first], modes.names[second]) for first, second in pairs)
    return BetweenModes(names, place, share)


def _sums(apart: FloatArray, off: FloatArray, stamps_s: FloatArray, parts: int) -> list[FloatArray]:
    """Sums (5, N) of the normal equations over each part of a window up to each stamp."""
    if not parts:  # a stay is longer than the window
        return []
    found = []
    sums = normal_sums(apart, off, stamps_s, WINDOW_S / parts)
    for part in range(parts):
        ends_s = stamps_s - part * WINDOW_S / parts
        rows = np.searchsorted(stamps_s, ends_s, side="right") - 1
        found.append(np.where(rows >= 0, sums[:, rows], np.nan))
    return found


def normal_sums(
    inputs: FloatArray, wanted: FloatArray, stamps_s: FloatArray, window_s: float
) -> FloatArray:
    """Sums (5, N) of the normal equations of a share of inputs (N,), and a bias, in a window."""
    known = np.isfinite(wanted)
    d, y = np.where(known, inputs, 0.0), np.where(known, wanted, 0.0)
    columns = np.column_stack([known, d, d * d, y, d * y])
    return windowed(columns, stamps_s, window_s).T


def share_of(
    sums: FloatArray, bias_sigma_rad_s: FloatArray | float = LEFT_BIAS_RAD_S
) -> tuple[FloatArray, FloatArray]:
    """Share (N,) and its variance from weighted sums (5, N); NaN: undetermined.

    The bias lies about 0 by a standard deviation.
    """
    count, d, dd, y, dy = sums
    of_bias = count + np.asarray(bias_sigma_rad_s) ** -2.0
    left = dd - d**2 / of_bias
    left = np.where(left > LEAST_INFORMATION, left, np.nan)
    return (dy - d * y / of_bias) / left, 1 / left


def _inside(sums: FloatArray, error: float, bound: float) -> BoolArray:
    """Where (N,) the share lies between 0 and 1, farther than errors that stay and that do not."""
    share, variance = share_of(sums)
    margin = bound * np.sqrt(variance + error**2)
    return np.asarray((share - margin > 0) & (share + margin < 1))


def _is_a_mode(sums: FloatArray) -> BoolArray:
    """Where (N,) the share is surely that of a mode or beyond."""
    share, variance = share_of(sums)
    return np.asarray(((share <= 0) | (share >= 1)) & (variance < SURE_SHARE**2))
