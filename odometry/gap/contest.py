"""Candidates compete on windows that they were not fitted to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t

from odometry.arrays import FloatArray
from odometry.effects.base import Effect
from odometry.gap.config import GapConfig
from odometry.gap.fit import Fitted, Fitter
from odometry.gap.statistic import gap_of

DIGITS = 6  # of evidence: what differs by less is a tie
SURE = 3.0  # standard deviations from doing nothing


@dataclass(frozen=True)
class Judged:
    """A hypothesis beside the one that it would replace.

    Attributes
    ----------
    effect : Effect
        What it adds.
    fitted : Fitted
        With all effects.
    gain : float
        Of held-out chi-squared, what the base had to move for it included.
    evidence : float
        Twice the log-likelihood gained on windows not fitted, less the penalty.
    least : float
        Lower bound of the evidence at 95 %: the pieces of the runs are a sample, and a gain of
        one moment is none.
    gap_after : float
        On the windows fitted [m].
    """

    effect: Effect
    fitted: Fitted
    gain: float
    evidence: float
    least: float
    gap_after: float


def judge(
    fitter: Fitter,
    before: Fitted,
    candidates: Sequence[Effect],
    config: GapConfig,
    progress: Callable[[], None],
) -> list[Judged]:
    """Fit each candidate beside the effects there are; most evidence first."""
    effects = [added.effect for added in before.effects]
    fits = []
    for candidate in candidates:
        fits.append(fitter.fit([*effects, candidate], before.effects, pin_slow=True))
        progress()
    return ranked(fitter, before, fits, config)


def ranked(
    fitter: Fitter, before: Fitted, fits: Sequence[Fitted], config: GapConfig
) -> list[Judged]:
    """Fits of one effect more, most evidence first.

    Log-likelihoods are divided by what chi-squared a degree of freedom the best of all leaves
    (at least 1): where nothing explains all, less is believed. Where evidence is equal but for
    rounding, more at its lower bound goes first, then fewer parameters.
    """
    rows = len(fitter.measured.window_of_row)
    spread = max(1.0, min(fit.held_out.sum() for fit in [before, *fits]) / rows)
    judged = [_judged(fitter, before, fit, spread, config) for fit in fits]
    return sorted(judged, key=_order)


def _order(one: Judged) -> tuple[float, float, int]:
    return -round(one.evidence, DIGITS), -round(one.least, DIGITS), one.fitted.freedom


def _judged(
    fitter: Fitter,
    before: Fitted,
    fit: Fitted,
    spread: float,
    config: GapConfig,
) -> Judged:
    gains = before.held_out - fit.held_out
    moved = before.base_moved - fit.base_moved
    gain = float(gains.sum()) + moved
    paid = penalty(fit.freedom - before.freedom, fit)
    return Judged(
        fit.effects[-1].effect,
        fit,
        gain,
        float(gain / spread - paid),
        float((gain - _uncertain(gains, fitter)) / spread - paid),
        gap_of(fit.base, fit.effects, fitter.measured.scenes, config.part_s).value,
    )


def _uncertain(gains: FloatArray, fitter: Fitter) -> float:
    """By how much the sum of gains may be less, at 95 % (Student's t over the pieces)."""
    _, piece = np.unique(fitter.measured.pieces, return_inverse=True)
    of_pieces = np.bincount(piece, weights=gains)
    count = len(of_pieces)
    if count < 2:
        return float("inf")
    return float(t.ppf(0.95, count - 1) * np.sqrt(count) * of_pieces.std(ddof=1))


def penalty(freedom: int, fit: Fitted) -> float:
    """For parameters, in units of chi-squared."""
    return float(freedom * np.log(len(fit.held_out)))


def is_there(fit: Fitted) -> bool:
    """Whether the last effect of a fit is more than an effect that does nothing.

    Its parameters are tested together (Wald), those that shape it held: each alone may be
    uncertain where only a product of them is known. Values that are not what its name says (a
    moment with nothing before it) are no such effect.
    """
    added = fit.effects[-1]
    if not added.effect.is_meant(added.values):
        return False
    absent = [parameter.absent for parameter in added.effect.parameters]
    known = np.array([value is not None for value in absent])
    if not known.any():
        return True
    away = np.array([a - b for a, b in zip(added.values, absent, strict=True) if b is not None])
    count = len(absent)
    scales = np.array([parameter.scale for parameter in added.effect.parameters])
    covariance = fit.covariance[-count:, -count:] / np.outer(scales, scales)
    information = np.linalg.pinv(covariance, hermitian=True)[np.ix_(known, known)]
    away = away / scales[known]
    return bool(away @ information @ away > SURE**2 * known.sum())
