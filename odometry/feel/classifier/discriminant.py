"""Shrunk linear discriminants from means and covariances by run, without the effect of speed."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class Moments:
    """Of R parts, each the windows of one run on one terrain.

    Attributes
    ----------
    labels : (R,) of str
    runs : (R,)
        Number of the run of each part.
    means, covariances : (R, D), (R, D, D)
        Of the columns and then the covariates, within each part.
    """

    labels: AnyArray
    runs: IntArray
    means: FloatArray
    covariances: FloatArray

    def where(self, chosen: BoolArray) -> "Moments":
        """Some of the parts."""
        return Moments(
            self.labels[chosen], self.runs[chosen], self.means[chosen], self.covariances[chosen]
        )


def moments_of(table: FloatArray, labels: AnyArray, runs: IntArray) -> Moments:
    """Means and covariances of windows (W, D) by run and label; those without a part are none.

    NaN counts as the mean of the part, or of all where a part has no number.
    """
    parts = sorted(set(zip(runs.tolist(), labels.tolist(), strict=True)))
    usual = means_of(table)
    means, covariances = [], []
    for run, label in parts:
        rows = table[(runs == run) & (labels == label)]
        there = np.isfinite(rows)
        mean = np.where(there.any(axis=0), means_of(rows), usual)
        left = np.where(there, rows, mean) - mean
        means.append(mean)
        covariances.append(left.T @ left / len(rows))
    return Moments(
        np.array([label for _, label in parts], dtype=object),
        np.array([run for run, _ in parts]),
        np.stack(means),
        np.stack(covariances),
    )


def means_of(table: FloatArray) -> FloatArray:
    """Mean (D,) of the numbers of each column; 0 without one."""
    there = np.isfinite(table)
    return np.asarray(np.where(there, table, 0.0).sum(axis=0) / np.maximum(there.sum(axis=0), 1))


RIDGE = 1e-3  # of the covariates' own variances: one that does not vary has no effect


@dataclass(frozen=True)
class Discriminant:
    """K classes in d columns with one covariance.

    Attributes
    ----------
    slopes : (q, d)
        What each covariate adds to a column within a class.
    means : (K, d)
        Of the columns without that.
    whitening : (d, d)
        Upper triangle that makes the covariance of a new run's windows the identity.
    """

    slopes: FloatArray
    means: FloatArray
    whitening: FloatArray

    def left(self, table: FloatArray) -> FloatArray:
        """What a window (W, d + q) leaves of each class, (W, K, d), in standard deviations."""
        covariates = len(self.slopes)
        columns = table[:, : table.shape[1] - covariates]
        if covariates:
            columns = columns - table[:, -covariates:] @ self.slopes
        whitened, centres = columns @ self.whitening.T, self.means @ self.whitening.T
        return np.asarray(whitened[:, None] - centres)

    @cached_property
    def between(self) -> FloatArray:
        """Directions (K - 1, d) of the space that the whitened means lie in; orthonormal."""
        centres = self.means @ self.whitening.T
        _, _, directions = np.linalg.svd(centres - centres.mean(axis=0), full_matrices=False)
        return np.asarray(directions[: len(centres) - 1])


@dataclass(frozen=True)
class Pooled:
    """Moments of K classes in D columns and covariates, of which every run has the same weight.

    Attributes
    ----------
    means : (K, D)
    whole : (D, D)
        Covariance of a window of a new run.
    of_runs : (D, D)
        Covariance of the mean of a run among the runs of its class.
    usual : (D,)
        Mean over runs.
    """

    means: FloatArray
    whole: FloatArray
    of_runs: FloatArray
    usual: FloatArray

    def columns(self, places: Sequence[int]) -> "Pooled":
        """Some of the columns."""
        rows = np.asarray(places)
        square = (rows[:, None], rows)
        return Pooled(
            self.means[:, rows], self.whole[square], self.of_runs[square], self.usual[rows]
        )


def pooled(moments: Moments, names: tuple[str, ...]) -> Pooled:
    """Pool the moments of K classes with equal weights.

    The covariance is that of a window of a new run: within runs, plus that of run
    means B (1 + 1 / n), n runs of a class. That of run means alone counts the covariance within
    runs as one run more, so that few runs do not seem alike in a column by chance.
    """
    rows = [np.flatnonzero(moments.labels == name) for name in names]
    means = np.stack([moments.means[of].mean(axis=0) for of in rows])
    weights = np.zeros(len(moments.labels))
    for of in rows:
        weights[of] = 1 / (len(of) * len(names))
    used = np.concatenate(rows)
    within = np.tensordot(weights[used], moments.covariances[used], axes=1)
    off = [moments.means[of] - mean for of, mean in zip(rows, means, strict=True)]
    free = max(sum(len(of) - 1 for of in off), 1)
    squares = np.asarray(sum(of.T @ of for of in off))
    new = float(np.mean([1 + 1 / len(of) for of in off]))
    whole, of_runs = within + new * squares / free, (squares + within) / (free + 1)
    return Pooled(means, whole, of_runs, moments.means[used].mean(axis=0))


def fitted_discriminant(of: Pooled, covariates: int, shrinkage: float) -> Discriminant:
    """Fit a discriminant in which all runs of a class, and all classes, have equal weights.

    Covariates are taken out by their slopes within classes (analysis of covariance), and what they
    say of a class themselves is not used; then correlations are shrunk towards none.

    Parameters
    ----------
    of : Pooled
    covariates : int
        q: so many last columns.
    shrinkage : float
        0 to 1.

    References
    ----------
    Friedman 1989, "Regularized discriminant analysis", eq. 18, with one covariance.
    """
    return _discriminant(of.means, of.whole, _slopes(of.whole, covariates), shrinkage)


def fitted_to_means(of: Pooled, covariates: int, shrinkage: float) -> Discriminant:
    """The same, whitened by the covariance of the means of runs; slopes are those of windows."""
    return _discriminant(of.means, of.of_runs, _slopes(of.whole, covariates), shrinkage)


def _slopes(whole: FloatArray, covariates: int) -> FloatArray:
    size = len(whole) - covariates
    own = whole[size:, size:]
    return np.asarray(np.linalg.solve(own + RIDGE * _diagonal(own), whole[size:, :size]))


def _discriminant(
    means: FloatArray, covariance: FloatArray, slopes: FloatArray, shrinkage: float
) -> Discriminant:
    size = len(covariance) - len(slopes)
    columns, cross, own = (
        covariance[:size, :size],
        covariance[size:, :size],
        covariance[size:, size:],
    )
    residual = columns - cross.T @ slopes - slopes.T @ cross + slopes.T @ own @ slopes
    scale = np.sqrt(np.maximum(np.diag(residual), 1e-12))
    correlation = (1 - shrinkage) * residual / np.outer(scale, scale)
    correlation[np.diag_indices(size)] = 1.0
    lower = np.linalg.cholesky(correlation + 1e-9 * np.eye(size))
    # in the order in which a file gives it back, so that products round in the same way
    whitening = np.ascontiguousarray(solve_triangular(lower, np.diag(1 / scale), lower=True))
    centres = np.asarray(means[:, :size] - means[:, size:] @ slopes)
    return Discriminant(slopes, centres, whitening)


def _diagonal(matrix: FloatArray) -> FloatArray:
    return np.diag(np.maximum(np.diag(matrix), 1e-9))
