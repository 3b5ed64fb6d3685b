"""Whether a mode of the set fits at all: each mode against the hypothesis "none of these".

Evidence between modes is relative: of models that are all wrong, the least wrong one wins. Here the
innovations of each mode's own filter are held against their own covariance, in a window that moves
with time: the sum of what is left in it, in the standard deviation that it has where the mode is
true, is large where innovations keep their sign or are too large. "None of these" says that such
sums are SPREAD times as large. It competes from the start: a hidden Markov chain over all modes and
it, whose prior is `ModesConfig.misfit_share`. Over a long window the innovations of whichever mode
leads are summed: a misfit that is small and lasts is hidden in a short one.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.estimation.imm.markov import ModeChain

WINDOW_S = 0.5  # of the rolling test
SPREAD = 4.0  # standard deviation of a window's sum where no mode fits; 1 where one does
MOST_EVIDENCE = 3.0  # [nat] of a window for none: less than it takes to be sure of it
CLIP = 4.0  # of one innovation: a single outlier is no window
MISFIT_LASTS_S = 20.0
LONG_WINDOW_S = 6.0  # in which a small misfit shows that lasts
LONG_EVIDENCE = 30.0  # [nat] of a long window for none, at most
LONG_CLIP = 2.0  # of one innovation: what is large shows in a short window
"""Chosen on seeds of `tests/studies/modes/modes_faults.py`: SPREAD and the long window on 10 and
20, else 0 to 2; `long_sigmas` of `ModesConfig` on 50, 51, 60 and 61."""


@dataclass(frozen=True)
class Innovations:
    """What is left of each measurement.

    Attributes
    ----------
    normalised : (N, M, m)
        Of the own filter of each mode, in its standard deviation; NaN: not measured.
    leading : (N,)
        The most probable mode.
    stamps_s : (N,)
    independent : float
        The share of an innovation that is news, where errors of a model last.
    """

    normalised: FloatArray
    leading: IntArray
    stamps_s: FloatArray
    independent: float

    @property
    def of_leading(self) -> FloatArray:
        """Those (N, m) of the most probable mode."""
        return np.asarray(self.normalised[np.arange(len(self.leading)), self.leading])

    def summed(
        self, values: FloatArray, window_s: float, clip: float
    ) -> tuple[FloatArray, FloatArray]:
        """Sums of values (N, ..., m) over a window, in standard deviations; mean squares."""
        known = np.isfinite(values)
        clipped = np.where(known, np.clip(np.nan_to_num(values), -clip, clip), 0.0)
        count, sums, squares = (
            windowed(of, self.stamps_s, window_s)
            for of in (known.astype(float), clipped, clipped**2)
        )
        variance = np.minimum(count**2, count / self.independent)
        some = np.where(count > 0, count, np.nan)
        return sums / np.sqrt(np.maximum(variance, 1.0)) + 0 * some, squares / some


@dataclass(frozen=True)
class ModeFit:
    """How well each mode fits by itself.

    Attributes
    ----------
    sums : (N, M, m)
        Sum of the innovations of each mode and measured entry in the window up to each stamp, in
        its standard deviation if the mode is true; NaN where none was measured.
    lasting : (N, m)
        The same over a long window, of whichever mode was in the lead at each stamp.
    log_probabilities : (N, M + 1)
        Of each mode and, last, of none.
    """

    sums: FloatArray
    lasting: FloatArray
    log_probabilities: FloatArray

    @property
    def none(self) -> FloatArray:
        """Probability (N,) that no mode fits."""
        return np.asarray(np.exp(self.log_probabilities[:, -1]))

    @property
    def against_none(self) -> FloatArray:
        """Probability (N, M) of each mode, if it is that one or none."""
        odds = self.log_probabilities[:, -1:] - self.log_probabilities[:, :-1]
        return np.asarray(1 / (1 + np.exp(np.minimum(odds, 500.0))))

    @property
    def best(self) -> FloatArray:
        """The sums (N, m) of the mode that fits best."""
        place = self.log_probabilities[:, :-1].argmax(axis=1)
        return np.asarray(self.sums[np.arange(len(place)), place])


def mode_fit(innovations: Innovations, dwell_s: FloatArray, misfit_share: float) -> ModeFit:
    """The test of innovations of modes that last (M,) [s], with the share of the time of none."""
    stamps_s = innovations.stamps_s
    sums, mean_squares = innovations.summed(innovations.normalised, WINDOW_S, CLIP)
    lasting, _ = innovations.summed(innovations.of_leading, LONG_WINDOW_S, LONG_CLIP)
    chain = _chain(dwell_s, misfit_share)
    steps_s = np.diff(stamps_s, prepend=stamps_s[0])
    # a window is one measurement, whatever the rate of the stamps
    weights = np.minimum(steps_s / WINDOW_S, 1.0)[:, None]
    evidence = weights * _log_likelihoods(np.maximum(sums**2, mean_squares), MOST_EVIDENCE)
    long = _log_likelihoods(lasting[:, None] ** 2, LONG_EVIDENCE)
    weights = np.minimum(steps_s / LONG_WINDOW_S, 1.0)
    evidence[:, -1] += weights * (long[:, 1] - long[:, 0])
    logs = np.empty((len(stamps_s), chain.modes))
    share = np.full(chain.modes, (1 - misfit_share) / (chain.modes - 1))
    share[-1] = misfit_share
    for row, step_s in enumerate(steps_s):
        share = share @ chain.transition(float(step_s))
        share = share * np.exp(evidence[row] - evidence[row].max())
        share = share / share.sum()
        logs[row] = np.log(np.maximum(share, 1e-300))
    return ModeFit(sums, lasting, logs)


def windowed(values: FloatArray, stamps_s: FloatArray, window_s: float) -> FloatArray:
    """Sums of values (N, ...) over a window up to each stamp (N,)."""
    first = np.searchsorted(stamps_s, stamps_s - window_s + 1e-9, side="right")
    whole = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
    return np.asarray(whole[1:] - whole[first])


def _log_likelihoods(squared: FloatArray, most: float) -> FloatArray:
    """Of each mode and of none (N, M + 1), from squared sums (N, M, m) of unit variance."""
    measured = np.isfinite(squared).any(axis=1)
    squared = np.nan_to_num(squared)
    of_modes = -squared.sum(axis=2) / 2
    # the broad one is centred on the mode that is nearest
    least = squared.min(axis=1)
    variance = SPREAD**2
    none = (-(least / variance + np.log(variance)) / 2 * measured).sum(axis=1)
    # in a window in which the mode changes, no mode fits: that means little
    of_modes = np.maximum(of_modes, none[:, None] - most)
    return np.column_stack([of_modes, none])


def _chain(dwell_s: FloatArray, misfit_share: float) -> ModeChain:
    """Modes as they change, and none: it holds for MISFIT_LASTS_S and as often as its share."""
    modes = len(dwell_s)
    rates = np.zeros((modes + 1, modes + 1))
    if modes > 1:
        rates[:-1, :-1] = (1 - np.eye(modes)) / dwell_s[:, None] / (modes - 1)
    rates[:-1, -1] = misfit_share / (1 - misfit_share) / MISFIT_LASTS_S
    rates[-1, :-1] = 1 / MISFIT_LASTS_S / modes
    leaving = rates.sum(axis=1)
    return ModeChain(1 / leaving, rates / leaving[:, None])
