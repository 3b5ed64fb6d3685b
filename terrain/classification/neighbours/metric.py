"""The spaces in which nearest neighbours are sought, and features that make them curved."""

from typing import Self

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.covariance import ledoit_wolf, shrunk_covariance
from sklearn.decomposition import PCA
from sklearn.preprocessing import StandardScaler

from odometry.arrays import AnyArray, FloatArray, IntArray

CLIP = 3.0
SMALLEST_SHRINKAGE = 0.01
APPEARANCE_DIMENSIONS = 10

MOST = 500
WIDTH = 0.2  # of the kernel; 0.1 to 1 give the same accuracy in cross-validation


class ClippedScaler(StandardScaler):  # type: ignore[misc]
    """Standardise each feature, then clip it to three standard deviations.

    A count or dimension of an empty region is far from all others; the clip keeps one such
    feature from outvoting the rest.
    """

    def transform(self, X: FloatArray, copy: bool | None = None) -> FloatArray:  # noqa: ARG002
        """Map features (n, F) to the same shape; whether they are finite is not checked."""
        return np.asarray(np.clip((X - self.mean_) / self.scale_, -CLIP, CLIP))


class DiscriminantMetric(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Project on linear discriminants: distances in units of the spread within a class.

    Fisher's linear discriminant analysis. The covariance within classes, of all classes
    together, is shrunk towards a multiple of the identity by Ledoit and Wolf's share, at least
    1 %: it stays defined with fewer samples than features. With S that covariance and B the
    weighted class means, discriminants w solve B B^T w = v S w; they are S^-1 B u, where u are the
    eigenvectors of the small matrix B^T S^-1 B. Each has unit length within classes. Samples count
    for their `shares`, all the same where none are given.

    Attributes
    ----------
    projection_ : FloatArray, shape (F, classes - 1)

    References
    ----------
    Ledoit and Wolf 2004, "A well-conditioned estimator for large-dimensional covariance matrices".
    """

    def fit(self, X: FloatArray, y: AnyArray, shares: FloatArray | None = None) -> Self:
        """Fit to features `X` (n, F), labels `y` (n,) and `shares` (n,) that add up to 1.

        Raises
        ------
        LinAlgError
            If the samples within each class are all equal.
        """
        classes, codes = np.unique(y, return_inverse=True)
        weights = np.full(len(X), 1 / len(X)) if shares is None else shares
        sums = np.bincount(codes, weights)
        rows = [codes == c for c in range(len(classes))]
        means = np.array([weights[of] @ X[of] for of in rows]) / sums[:, None]
        within = np.sqrt(len(X) * weights)[:, None] * (X - means[codes])
        _, share = ledoit_wolf(within, assume_centered=True)
        covariance = shrunk_covariance(within.T @ within / len(X), max(share, SMALLEST_SHRINKAGE))
        between = (means - sums @ means).T * np.sqrt(sums)  # times its transpose: covariance
        sharpened = cho_solve(cho_factor(covariance), between)
        values, vectors = np.linalg.eigh(between.T @ sharpened)  # as many as classes, ascending
        kept = slice(-1, -len(classes), -1)
        lengths = np.sqrt(np.maximum(values[kept], np.finfo(float).tiny))
        self.projection_ = np.ascontiguousarray(sharpened @ vectors[:, kept] / lengths)
        return self

    def transform(self, X: FloatArray) -> FloatArray:
        """Map features (n, F) to discriminants (n, classes - 1)."""
        return np.asarray(X @ self.projection_)


def equal_shares(codes: IntArray, groups: AnyArray) -> FloatArray:
    """What samples (n,) count for: every class the same, and every group of a class.

    Patches of one photograph have much in common: of many of them most say the same once more.
    """
    _, of_group = np.unique(groups, return_inverse=True)
    parts, part = np.unique(np.column_stack([codes, of_group]), axis=0, return_inverse=True)
    in_class = np.bincount(parts[:, 0])
    shares = 1 / (np.bincount(part.ravel())[part.ravel()] * in_class[codes])
    return np.asarray(shares / shares.sum())


class AppearanceMetric(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Project on whitened principal components: what patches look like, whatever their class.

    Attributes
    ----------
    offset_ : FloatArray, shape (F,)
    projection_ : FloatArray, shape (F, up to 10)
    """

    def fit(self, X: FloatArray, y: AnyArray | None = None) -> Self:  # noqa: ARG002
        """Fit the components to features `X` (n, F)."""
        count, size = X.shape
        solver = "full" if 2 * count < size else "covariance_eigh"  # the same, the faster one
        analysis = PCA(min(APPEARANCE_DIMENSIONS, count, size), svd_solver=solver).fit(X)
        spread = np.sqrt(analysis.explained_variance_)
        kept = spread > 1e-6 * spread[0]
        self.offset_ = analysis.mean_
        self.projection_ = np.ascontiguousarray(analysis.components_[kept].T / spread[kept])
        return self

    def transform(self, X: FloatArray) -> FloatArray:
        """Map features (n, F) to components of unit variance."""
        return np.asarray((X - self.offset_) @ self.projection_)


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
