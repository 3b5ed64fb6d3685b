"""Candidates compete on windows that they were not fitted to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.effects.interface.base import Effect
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.prepare.statistic import gap_m, sure_sum

DIGITS = 6  # of evidence: what differs by less is a tie


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
        Lower bound of the evidence, see `sure_sum`.
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
    (at least 1): where nothing explains all, evidence counts less. Where evidence is equal but for
    rounding, more at its lower bound goes first, then fewer parameters.
    """
    rows = fitter.measured.expected
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
        float((sure_sum(fitter.by_piece(gains), config.trimmed) + moved) / spread - paid),
        gap_m(fit.base, fit.effects, fitter.measured.scenes),
    )


def penalty(freedom: int, fit: Fitted) -> float:
    """For parameters, in units of chi-squared."""
    return float(freedom * np.log(len(fit.held_out)))


def margin_of(config: GapConfig, spread: float, closed: float) -> float:
    """By how much a smooth function must cost less than names that close so much of the cost."""
    return max(config.general_margin * max(1.0, spread), config.least_better * closed)


def cost_of(fit: Fitted) -> float:
    """Held-out chi-squared, the move of the base and a penalty for freedom included."""
    return fit.cost + penalty(fit.freedom, fit)
