"""Whether a filter errs as much as it says: NEES and NIS over Monte Carlo runs.

Bar-Shalom, Li, Kirubarajan 2001, Estimation with Applications to Tracking and Navigation, section
5.4: where the filter is consistent, e' P^-1 e of its error e (NEES: state less truth under its own
covariance; NIS: measurement less prediction under S) is chi-squared with as many degrees of
freedom as e has entries, and its sum over N independent runs with N times as many.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray
from odometry.errors import TrajectoryError
from odometry.geometry.angles import wrap


@dataclass(frozen=True)
class Consistency:
    """Normalised squared errors of N runs, averaged over runs at each of K steps.

    Attributes
    ----------
    mean : float
        Over all runs and steps; `degrees` is expected.
    mean_bounds : (2,)
        For `mean`, if steps were independent. A consistent filter's innovations are; its state
        errors are not, and their mean spreads more than this.
    step_means : (K,)
        Over the runs; NaN at a step that has none.
    step_bounds : (K, 2)
        For each of `step_means`, as many runs as were averaged there.
    inside : float
        Share of steps whose mean lies within; the confidence is expected.
    degrees : int
    confidence : float
    """

    mean: float
    mean_bounds: FloatArray
    step_means: FloatArray
    step_bounds: FloatArray
    inside: float
    degrees: int
    confidence: float


def normalised_squared_errors(
    errors: FloatArray, covariances: FloatArray, angles: tuple[int, ...] = ()
) -> FloatArray:
    """Squared Mahalanobis lengths (...) of errors (..., n) under covariances (..., n, n).

    Parameters
    ----------
    errors, covariances : (..., n), (..., n, n)
    angles : tuple of int
        Entries that are angles [rad]: wrapped first.

    Raises
    ------
    TrajectoryError
        If shapes do not agree.
    """
    errors = np.array(errors, dtype=np.float64)
    if covariances.shape != (*errors.shape, errors.shape[-1]):
        raise TrajectoryError(
            f"errors of shape {errors.shape} and covariances of shape {covariances.shape}, "
            f"expected {(*errors.shape, errors.shape[-1])}"
        )
    errors[..., list(angles)] = wrap(errors[..., list(angles)])
    solved = np.linalg.solve(covariances, errors[..., None])[..., 0]
    return np.asarray(np.sum(errors * solved, axis=-1))


def consistency(squared: FloatArray, degrees: int, confidence: float = 0.95) -> Consistency:
    """Averages of normalised squared errors, with two-sided chi-squared bounds.

    Parameters
    ----------
    squared : (N, K)
        Of N independent runs at K steps; NaN where nothing was measured.
    degrees : int
        Entries of each error.
    confidence : float

    Raises
    ------
    TrajectoryError
        If the table is not of runs and steps, or holds no number.
    """
    if squared.ndim != 2 or np.isnan(squared).all():
        raise TrajectoryError(
            f"normalised squared errors of shape {squared.shape}, expected (runs, steps) with "
            "numbers among them"
        )
    counts = np.sum(~np.isnan(squared), axis=0)
    seen = counts > 0
    step_means = np.full(squared.shape[1], np.nan)
    step_means[seen] = np.nansum(squared[:, seen], axis=0) / counts[seen]
    step_bounds = np.full((squared.shape[1], 2), np.nan)
    step_bounds[seen] = chi_squared_bounds(degrees, counts[seen], confidence)
    low, high = step_bounds[seen].T
    within = (low <= step_means[seen]) & (step_means[seen] <= high)
    return Consistency(
        mean=float(np.nanmean(squared)),
        mean_bounds=chi_squared_bounds(degrees, counts.sum(), confidence),
        step_means=step_means,
        step_bounds=step_bounds,
        inside=float(within.mean()),
        degrees=degrees,
        confidence=confidence,
    )


def chi_squared_bounds(
    degrees: int, count: FloatArray | int, confidence: float = 0.95
) -> FloatArray:
    """Bounds (..., 2) of the mean of `count` (...) independent squared errors of `degrees`."""
    number = np.asarray(count, dtype=np.float64)[..., None]
    tails = np.array([(1 - confidence) / 2, (1 + confidence) / 2])
    return np.asarray(chi2.ppf(tails, degrees * number) / number)
