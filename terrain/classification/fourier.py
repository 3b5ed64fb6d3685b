"""Random Fourier features: linear discriminants of them are smooth curved ones."""

from typing import Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin

from odometry.arrays import AnyArray, FloatArray

MOST = 500
WIDTH = 0.2  # of the kernel; 0.1 to 1 give the same accuracy in cross-validation


class FourierFeatures(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Append cosines of random projections to scaled features.

    Their products approach the kernel ``exp(-WIDTH |x - y|^2 / F)``. There are 500 of them, or as
    many as samples; the same number of features and samples draws the same ones.

    Parameters
    ----------
    most : int
        Cosines at the most; with 0 the features stay as they are.

    Attributes
    ----------
    frequencies_ : FloatArray, shape (F, m)
    phases_ : FloatArray, shape (m,)

    References
    ----------
    Rahimi and Recht 2007, "Random features for large-scale kernel machines", algorithm 1.
    """

    frequencies_: FloatArray
    phases_: FloatArray

    def __init__(self, most: int = MOST) -> None:
        self.most = most

    def fit(self, X: FloatArray, y: AnyArray | None = None) -> Self:  # noqa: ARG002
        """Draw frequencies for features `X` (n, F)."""
        rng = np.random.default_rng(0)
        count, size = X.shape
        spread = np.sqrt(2 * WIDTH / size)
        self.frequencies_ = rng.normal(0.0, spread, (size, min(self.most, count)))
        self.phases_ = 2 * np.pi * rng.random((self.frequencies_.shape[1],))
        return self

    def transform(self, X: FloatArray) -> FloatArray:
        """Map features (n, F) to (n, F + m)."""
        cosines = np.sqrt(2) * np.cos(X @ self.frequencies_ + self.phases_)
        return np.hstack([X, cosines])
