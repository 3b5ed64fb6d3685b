"""Candidates compete on windows that they were not fitted to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Effect
from odometry.gap.config import GapConfig
from odometry.gap.fit import Fitted, Fitter
from odometry.gap.statistic import gap_of


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
    without_best : float
        The evidence without the piece of the runs that gains most: a gain of one moment is none.
    gap_after : float
        On the windows fitted [m].
    """

    effect: Effect
    fitted: Fitted
    gain: float
    evidence: float
    without_best: float
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
    (at least 1): where nothing explains all, less is believed.
    """
    rows = len(fitter.measured.window_of_row)
    spread = max(1.0, min(fit.held_out.sum() for fit in [before, *fits]) / rows)
    judged = [_judged(fitter, before, fit, spread, config) for fit in fits]
    return sorted(judged, key=lambda one: -one.evidence)


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
        gain / spread - paid,
        (gain - _best_piece(gains, fitter)) / spread - paid,
        gap_of(fit.base, fit.effects, fitter.measured.scenes, config.part_s).value,
    )


def _best_piece(gains: FloatArray, fitter: Fitter) -> float:
    """Gain of the piece of the runs that gains most."""
    return float(np.bincount(fitter.measured.pieces, weights=gains).max())


def penalty(freedom: int, fit: Fitted) -> float:
    """For parameters, in units of chi-squared."""
    return float(freedom * np.log(len(fit.held_out)))
