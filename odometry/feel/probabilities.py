"""Evidence of windows as probabilities, among them that of an unknown terrain."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.feel.held_out import Scores
from odometry.feel.model import FeelModel
from odometry.feel.strangeness import unknown_probability
from odometry.feel.windows import STEPS


@dataclass(frozen=True)
class Summed:
    """Sums over windows, for N answers.

    Attributes
    ----------
    evidence, novelty, offsets : (N, K), (N,), (N, K, C)
        See `evidence.Stretches`.
    counts : (N,)
        Of windows; where it is 0 nothing is said.
    """

    evidence: FloatArray
    novelty: FloatArray
    offsets: FloatArray
    counts: FloatArray

    @classmethod
    def over(
        cls, evidence: FloatArray, scores: Scores, felt: BoolArray, spans: IntArray
    ) -> "Summed":
        """Over those of W windows that are felt, from the first to before the end of spans (N, 2).

        `evidence` (W, K) is bounded, see `Calibration`. A span has a window or more, and its sum
        depends on its windows alone, not on those before.
        """

        def of(values: FloatArray) -> FloatArray:
            kept = np.concatenate([(values.T * felt).T, np.zeros((1, *values.shape[1:]))])
            return np.asarray(np.add.reduceat(kept, spans.ravel(), axis=0)[::2])

        return cls(of(evidence), of(scores.novelty), of(scores.offsets), of(np.ones(len(felt))))

    def mean(self, sums: FloatArray) -> FloatArray:
        """Of the windows."""
        return np.asarray((sums.T / np.maximum(self.counts, 1)).T)


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
        Whether each is beyond the limits of the training windows.
    """

    probabilities: FloatArray
    unknown: FloatArray
    is_novel: BoolArray

    @classmethod
    def of(cls, model: FeelModel, summed: Summed, unknown_share: float) -> "Probabilities":
        """From sums over overlapping windows, and prior probabilities."""
        windows = np.maximum((summed.counts + STEPS - 1) / STEPS, 1.0)
        among = model.calibration.probabilities(summed.mean(summed.evidence), windows)
        novelty, offsets = summed.mean(summed.novelty), summed.mean(summed.offsets)
        odds = model.limits.log_odds(model.strangeness, windows, offsets)
        any_felt = summed.counts > 0
        unknown = unknown_probability(np.where(any_felt, odds, 0.0), unknown_share)
        refused = model.limits.refused(windows, novelty, offsets)
        return cls(among * (1 - unknown)[:, None], unknown, any_felt & refused)
