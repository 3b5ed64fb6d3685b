"""Whether an open-loop odometer errs as much as its covariance says, over several distances."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.evaluation.consistency import chi_squared_bounds, normalised_squared_errors
from odometry.evaluation.odometer_noise import OdometerNoise, measured_noise, motion_errors
from odometry.evaluation.open_loop_errors import OpenLoopPath
from odometry.evaluation.stretches import spatial_horizons
from odometry.geometry import se2

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
