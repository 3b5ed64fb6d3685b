"""Evidence of windows as probabilities, among them that of a terrain never felt."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.feel.model import FeelModel
from odometry.feel.strangeness import terms, unknown_probability
from odometry.feel.windows import STEPS


@dataclass(frozen=True)
class Probabilities:
    """Of N windows or stretches.

    Attributes
    ----------
    probabilities : (N, K)
        Of the terrains of the model.
    unknown : (N,)
        Of a terrain that it does not know; adds up to 1 with them.
    is_novel : (N,)
        Whether each is beyond the limits of what was felt.
    """

    probabilities: FloatArray
    unknown: FloatArray
    is_novel: BoolArray

    @classmethod
    def of(cls, model: FeelModel, summed: FloatArray, unknown_share: float) -> "Probabilities":
        """From sums over overlapping windows, and of what is probable before anything is felt.

        Parameters
        ----------
        model : FeelModel
        summed : (N, K + 3)
            Of bounded evidence, novelty and nearness, and the number of windows; where that is 0
            nothing is said.
        unknown_share : float
        """
        counts, limits, weights = summed[:, -1], model.limits, model.strangeness
        means = summed[:, :-1] / np.maximum(counts, 1)[:, None]
        windows = np.maximum((counts + STEPS - 1) / STEPS, 1.0)
        among = model.calibration.probabilities(means[:, :-2], windows)
        novelty, nearness = means[:, -2], means[:, -1]
        single, any_felt = counts <= 1, counts > 0
        rows = terms(among, novelty, nearness)
        odds = np.where(single, rows @ weights.window, rows @ weights.stretch)
        far = novelty > np.where(single, limits.window, limits.stretch)
        strange = odds > np.where(single, limits.strange_window, limits.strange_stretch)
        unknown = unknown_probability(np.where(any_felt, odds, 0.0), unknown_share)
        return cls(among * (1 - unknown)[:, None], unknown, any_felt & (far | strange))
