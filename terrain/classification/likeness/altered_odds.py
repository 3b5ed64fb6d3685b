"""How probably a patch is one of training that was altered, by a few numbers of it."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from sklearn.linear_model import LogisticRegression
from sklearn.preprocessing import StandardScaler

from odometry.arrays import FloatArray

REGULARITY = 0.1
MOST_ODDS = 50.0  # logarithm: no exponential of it overflows


@dataclass(frozen=True)
class AlteredOdds:
    """Log-odds that a patch was altered: a logistic regression with products of numbers.

    Attributes
    ----------
    scales : FloatArray, shape (2, F)
        Mean and deviation of the F numbers of a patch.
    weights : FloatArray, shape (1 + F + F (F + 1) / 2,)
        Of one, of the numbers in deviations from their mean, and of their products.
    """

    scales: FloatArray
    weights: FloatArray

    @classmethod
    def learned(cls, own: FloatArray, altered: FloatArray) -> Self:
        """From n patches as a of each are shown (n, a, F), and b altered ones of each (n, b, F).

        Both kinds weigh as much.
        """
        rows = np.concatenate([of.reshape(-1, of.shape[2]) for of in (own, altered)])
        is_altered = np.arange(len(rows)) >= own.shape[0] * own.shape[1]
        scaler = StandardScaler().fit(rows)
        shares = np.where(is_altered, 1 / altered.shape[1], 1 / own.shape[1])
        terms = _with_products(scaler.transform(rows))
        fitted = LogisticRegression(C=REGULARITY, max_iter=3000).fit(terms, is_altered, shares)
        weights = np.concatenate([fitted.intercept_, fitted.coef_[0]])
        return cls(np.array([scaler.mean_, scaler.scale_]), weights)

    def of(self, numbers: FloatArray) -> FloatArray:
        """Of each row of numbers (m, F), (m,)."""
        terms = _with_products((numbers - self.scales[0]) / self.scales[1])
        odds = self.weights[0] + terms @ self.weights[1:]
        return np.asarray(np.clip(odds, -MOST_ODDS, MOST_ODDS))

    def fits(self, numbers: int) -> bool:
        """Whether the arrays are those of so many numbers."""
        terms = numbers + numbers * (numbers + 1) // 2
        return self.scales.shape == (2, numbers) and self.weights.shape == (1 + terms,)


def _with_products(numbers: FloatArray) -> FloatArray:
    """Numbers (m, n) and the products of any two of them."""
    first, second = np.triu_indices(numbers.shape[1])
    return np.column_stack([numbers, numbers[:, first] * numbers[:, second]])
