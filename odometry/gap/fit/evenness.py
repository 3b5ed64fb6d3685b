"""By how much the strength of an effect differs from one piece of the runs to the next.

An effect that is what its name says has one strength. One that stands for something else fits each
piece with another: a constant delay in the place of a clock that was set, for instance.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray, IntArray
from odometry.gap.fit.fitter import Fitted, Fitter

LEAST_SHARE = 1e-6  # of what an effect does: a piece in which it does less does not count
LEAST_PIECES = 3


@dataclass(frozen=True)
class Unevenness:
    """Standard deviation of an effect's strength between pieces, as a share of it.

    Attributes
    ----------
    share : float
        Of DerSimonian and Laird 1986 (Controlled Clinical Trials 7, eq. 8), at least 0.
    probability : float
        Of pieces that scatter as much by chance (Cochran's Q).
    """

    share: float
    probability: float


def unevenness(fitter: Fitter, fit: Fitted, place: int) -> Unevenness:
    """Of one effect of a fit; the piece that differs most is left out, as it may be a disturbance.

    The strength of a piece is the factor of what the effect does there that fits best. Its error is
    taken from the scatter of windows within pieces.
    """
    measured = fitter.measured
    rows = measured.rows(fit.base, fit.effects)
    others = (*fit.effects[:place], *fit.effects[place + 1 :])
    does = measured.rows(fit.base, others) - rows
    weights = np.bincount(measured.window_of_row, weights=does**2)
    scores = np.bincount(measured.window_of_row, weights=does * rows)
    acts = weights > LEAST_SHARE * weights.sum()
    return between_pieces(scores[acts] / weights[acts], weights[acts], measured.pieces[acts])


def between_pieces(strengths: FloatArray, weights: FloatArray, pieces: IntArray) -> Unevenness:
    """Of strengths (K,) of windows, of inverse variances (K,) but for a factor, in pieces (K,)."""
    numbers, piece = np.unique(pieces, return_inverse=True)
    if len(numbers) <= LEAST_PIECES:
        return Unevenness(0.0, 1.0)
    summed = np.bincount(piece, weights=weights)
    means = np.bincount(piece, weights=weights * strengths) / summed
    within = float(weights @ (strengths - means[piece]) ** 2)
    of_pieces = summed / max(1.0, within / max(1, len(strengths) - len(numbers)))
    apart = of_pieces * (means - np.average(means, weights=of_pieces)) ** 2
    kept = np.arange(len(means)) != np.argmax(apart)
    means, of_pieces = means[kept], of_pieces[kept]
    scatter = float(of_pieces @ (means - np.average(means, weights=of_pieces)) ** 2)
    freedom, total = len(means) - 1, float(of_pieces.sum())
    variance = (scatter - freedom) / (total - float(of_pieces @ of_pieces) / total)
    return Unevenness(float(np.sqrt(max(0.0, variance))), float(chi2.sf(scatter, freedom)))
