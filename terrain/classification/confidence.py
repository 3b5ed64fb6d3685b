"""How probable an answer is, by how far its image is from training: logistic calibration."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from sklearn.linear_model import LogisticRegression
from sklearn.preprocessing import StandardScaler

from odometry.arrays import AnyArray, BoolArray, FloatArray

MOST_ODDS = 200.0
DISTANCES, DISPLACEMENTS = (-4.0, 2.0), (-3.0, 3.0)  # logarithms of shares of their limits
MOST = 0.99
LEAST = 0.01  # of the difference from chance, so that the likeliest terrain stays the likeliest
# of what is calibrated on: half as in training, a quarter altered, a quarter of things; chosen on
# ground/, measured on pavements/
WEIGHTS = (0.5, 0.25, 0.25)
FEW_TERRAINS = 3  # of a model: how sure it is of others cannot be learned from those that it knows


def weight_of_others(terrains: int) -> float:
    """Of terrain that a model of few terrains does not know, beside `WEIGHTS`; 0 of many terrains.

    After so many different ones the next is another one with a probability of 1 / (terrains + 1),
    by Laplace's rule of succession.
    """
    return WEIGHTS[0] / terrains if terrains <= FEW_TERRAINS else 0.0


def evidence(
    probabilities: FloatArray, distances: FloatArray, displacements: FloatArray
) -> FloatArray:
    """What distinguishes right answers from wrong ones, (n, 3).

    Parameters
    ----------
    probabilities : FloatArray, shape (n, classes)
        By the votes.
    distances, displacements : FloatArray, shape (n,)
        Of features and of looks, over their limits.
    """
    odds = np.clip(1 / np.maximum(1 - probabilities.max(axis=1), 1e-9) - 1, 1e-9, MOST_ODDS)
    logs = [np.log(np.maximum(of, 1e-9)) for of in (distances, displacements)]
    clipped = [
        np.clip(of, *most) for of, most in zip(logs, (DISTANCES, DISPLACEMENTS), strict=True)
    ]
    return np.column_stack([np.log(odds), *clipped])


@dataclass(frozen=True)
class AnswerConfidence:
    """The probability that the likeliest terrain is the right one.

    The share of votes is calibrated for images of the camera of training: another camera, another
    light and images of something else get the same share. This probability falls with the distance
    among the features and with the displacement of the look. It is learned from images whose
    photograph was held out: as they are, altered as `augmentation` does it, and squares of things,
    and for few terrains of other terrain, for which every answer is wrong.

    Attributes
    ----------
    weights : FloatArray, shape (4,)
        Of one and of the three columns of `evidence`, in log-odds.

    References
    ----------
    Platt 1999, "Probabilistic outputs for support vector machines"; calibrated on altered copies
    as in Tomani and others 2021, "Post-hoc uncertainty calibration for domain drift scenarios".
    """

    weights: FloatArray

    @classmethod
    def of(cls, tables: Sequence[tuple[float, FloatArray, BoolArray]]) -> Self | None:
        """Of tables of a weight, `evidence` (n, 3) and which answers are right (n,).

        None where all answers are right, or all are wrong.
        """
        shares, evidences, right = zip(*tables, strict=True)
        rows, truth = np.concatenate(evidences), np.concatenate(right)
        if truth.all() or not truth.any():
            return None
        scale = len(truth) / sum(shares)
        each = [
            np.full(len(of), scale * share / len(of))
            for share, of in zip(shares, right, strict=True)
        ]
        scaler = StandardScaler().fit(rows)
        found = LogisticRegression().fit(scaler.transform(rows), truth, np.concatenate(each))
        weights = found.coef_[0] / scaler.scale_
        return cls(np.array([found.intercept_[0] - weights @ scaler.mean_, *weights]))

    def of_being_right(
        self, probabilities: FloatArray, distances: FloatArray, displacements: FloatArray
    ) -> FloatArray:
        """Probability (n,) that the likeliest terrain is the right one; arguments of `evidence`."""
        numbers = evidence(probabilities, distances, displacements)
        return np.asarray(1 / (1 + np.exp(-self.weights[0] - numbers @ self.weights[1:])))

    def applied(
        self, probabilities: FloatArray, distances: FloatArray, displacements: FloatArray
    ) -> FloatArray:
        """Probabilities (n, classes) whose largest is the probability of being right.

        It is no less than chance. The others keep their ratios where it grows, and approach chance
        where it falls. Distances and displacements (n,) are over their limits.
        """
        chance = 1 / probabilities.shape[1]
        before = probabilities.max(axis=1, keepdims=True)
        least = chance + LEAST * (before - chance)
        right = self.of_being_right(probabilities, distances, displacements)[:, None]
        sure = np.clip(right, least, np.maximum(MOST, least))
        flat = chance + (probabilities - chance) * (sure - chance) / np.maximum(
            before - chance, 1e-9
        )
        sharp = probabilities * (1 - sure) / np.maximum(1 - before, 1e-9)
        sharp[np.arange(len(sharp)), probabilities.argmax(axis=1)] = sure[:, 0]
        return np.asarray(np.where(sure < before, flat, sharp))

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        return {"confidence_weights": self.weights}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> Self | None:
        """Rebuild from what `arrays` gave; None of files before version 0.16, which have none.

        Raises
        ------
        ValueError
            If the array does not fit.
        """
        if "confidence_weights" not in arrays:
            return None
        weights = arrays["confidence_weights"]
        if weights.shape != (4,) or not np.isfinite(weights).all():
            raise ValueError(f"weights of the confidence of shape {weights.shape}")
        return cls(weights)
