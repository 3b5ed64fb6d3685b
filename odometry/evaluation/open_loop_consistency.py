"""Whether filters and open-loop odometers err as much as their covariance says."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray, IntArray
from odometry.errors import TrajectoryError
from odometry.evaluation.odometer_noise import OdometerNoise, measured_noise, motion_errors
from odometry.evaluation.open_loop_errors import OpenLoopPath
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.windows.travel.horizons import spatial_horizons

DISTANCES_M = (5.0, 20.0, 100.0)
STRIDE = 0.25  # from start to start, in distances
DEGREES = 3


@dataclass(frozen=True)
class OpenLoopConsistency:
    """Normalised squared errors (NEES) of motions over one distance.

    Attributes
    ----------
    distance_m : float
        Wheel travel.
    windows, independent : int
        How many motions were taken, and how many lie end to end.
    mean : float
        3 is expected of x, y and yaw.
    bounds : (2,)
        95 % of the means of `independent` motions lie within, where the covariance is right.
    """

    distance_m: float
    windows: int
    independent: int
    mean: float
    bounds: FloatArray

    @property
    def is_consistent(self) -> bool:
        """Whether the mean lies within the bounds."""
        return bool(self.bounds[0] <= self.mean <= self.bounds[1])


def open_loop_consistency(
    path: OpenLoopPath, rows: IntArray, truth: FloatArray, noise: OdometerNoise
) -> list[OpenLoopConsistency]:
    """NEES of the motions of a path against true poses, by a noise that was estimated elsewhere.

    Parameters
    ----------
    path : OpenLoopPath
    rows : (M,)
        Poses of the path at which there is a true one.
    truth : (M, 3)
    noise : OdometerNoise
        With `reference` of the poses in `truth`.

    Returns
    -------
    list of OpenLoopConsistency
        Of the distances that the path holds.
    """
    found = []
    for distance_m in DISTANCES_M:
        squared, independent = _squared(path, rows, truth, noise, distance_m)
        if independent:
            found.append(_pooled(distance_m, [squared], independent))
    return found


def consistency_by_halves(
    path: OpenLoopPath, rows: IntArray, reference: FloatArray
) -> list[OpenLoopConsistency]:
    """NEES of each half of a path by the noise measured on the other half.

    Parameters
    ----------
    path : OpenLoopPath
    rows : (M,)
        Poses of the path at which there is a measured one.
    reference : (M, 3)
    """
    if not len(rows):
        return []
    middle_m = (path.travel_m[rows[0]] + path.travel_m[rows[-1]]) / 2
    cut = int(np.searchsorted(path.travel_m[rows], middle_m))
    halves = (slice(0, cut), slice(cut, None))
    noises = [measured_noise(path, rows[half], reference[half]) for half in halves]
    found = []
    for distance_m in DISTANCES_M:
        each = [
            _squared(path, rows[half], reference[half], noise, distance_m)
            for half, noise in zip(halves, reversed(noises), strict=True)
            if noise is not None and len(rows[half]) > 1
        ]
        independent = sum(count for _, count in each)
        if independent:
            found.append(_pooled(distance_m, [squared for squared, _ in each], independent))
    return found


def _squared(
    path: OpenLoopPath,
    rows: IntArray,
    truth: FloatArray,
    noise: OdometerNoise,
    distance_m: float,
) -> tuple[FloatArray, int]:
    """Normalised squared errors (K,) over a distance, and how many lie end to end."""
    travelled = path.travel_m[rows]
    first, last = spatial_horizons(travelled, distance_m, STRIDE * distance_m).T
    errors = motion_errors(path.poses[rows], truth, first, last)
    covariances = path.covariances(noise.variances, rows[first], rows[last])
    covariances += _of_reference(noise.reference, truth, first, last)
    return normalised_squared_errors(errors, covariances), int(
        (travelled[-1] - travelled[0]) // distance_m
    )


def _of_reference(
    variances: FloatArray, truth: FloatArray, first: IntArray, last: IntArray
) -> FloatArray:
    """Covariances (K, 3, 3) of a motion between poses whose place and yaw have variances (2,)."""
    position, yaw = variances
    moved = se2.between(truth[first], truth[last])
    lever = np.column_stack([moved[:, 1], -moved[:, 0], -np.ones(len(moved))])
    found = yaw * lever[:, :, None] * lever[:, None, :]
    return np.asarray(found + np.diag([2 * position, 2 * position, yaw]))


def _pooled(distance_m: float, squared: list[FloatArray], independent: int) -> OpenLoopConsistency:
    together = np.concatenate(squared)
    bounds = chi_squared_bounds(DEGREES, independent)
    return OpenLoopConsistency(
        distance_m, len(together), independent, float(together.mean()), bounds
    )


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
