"""How well the windows determine the parameters."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from odometry.arrays import FloatArray
from odometry.identification.problem import Problem
from odometry.identification.solve import Solution
from odometry.identification.spread import (
    FEWEST_WINDOWS,
    correlated_groups,
    spread_between,
)
from odometry.windows.travel.noise import by_pose_noise, score_covariance, window_covariances
from odometry.windows.travel.windows import Windows


@dataclass(frozen=True)
class Uncertainty:
    """Covariance of the identified parameters, and how well it is itself known.

    Attributes
    ----------
    covariance : (F, F)
    freedom : (F,)
        Degrees of freedom of each variance: Student's t of so many makes an interval.
    """

    covariance: FloatArray
    freedom: FloatArray


@dataclass(frozen=True)
class Linearised:
    """The loss near its least value, parameters in units of their ordinary sizes.

    Attributes
    ----------
    root : (K, 3, 3)
        Whitening of each window's residuals, with the square root of its weight.
    residuals : (K, 3)
    jacobian : (K, 3, F)
        Derivative of the residuals.
    inverse : (F, F)
        Inverse of the curvature.
    """

    root: FloatArray
    residuals: FloatArray
    jacobian: FloatArray
    inverse: FloatArray


def residual_scale(problem: Problem, solution: Solution) -> float:
    """Root mean square of the whitened residuals: 1 where the stated noise explains them."""
    whitened = np.einsum("kij,kj->ki", problem.noise_whitening, problem.residuals(solution.chosen))
    freedom = max(3 * float(solution.weights.sum()) - len(solution.chosen), 1.0)
    return float(np.sqrt(np.sum(solution.weights[:, None] * whitened**2) / freedom))


def parameter_uncertainty(problem: Problem, solution: Solution, sizes: FloatArray) -> Uncertainty:
    """Covariance of the free parameters, of sandwich form, and its degrees of freedom.

    The poses have the stated noise, or less where the residuals are smaller than it explains;
    windows that share a pose share its noise. What the residuals have beyond is the model's own
    error: independent on every metre of wheel travel, and so shared by windows that overlap.
    Where the spread between runs, or between stretches of one, shows larger variances, these are
    taken.

    Parameters
    ----------
    problem : Problem
    solution : Solution
    sizes : (F,)
        Ordinary sizes, so that parameters of very different units can be inverted together.
    """
    if not len(sizes):
        return Uncertainty(np.empty((0, 0)), np.empty(0))
    near = _linearised(problem, solution, sizes)
    parts, freedoms = _parts_and_freedoms(problem, solution, near)
    covariance = parts.sum(axis=0)
    variances = np.diagonal(parts, axis1=1, axis2=2)
    total = variances.sum(axis=0)
    poses_alone = np.eye(4)[:, :1]  # where nothing depends on a parameter
    shares = np.where(total > 0, variances / np.maximum(total, np.finfo(float).tiny), poses_alone)
    # Satterthwaite 1946 for a sum of independently estimated variances.
    freedom = 1 / np.sum(shares**2 / freedoms[:, None], axis=0)
    groups = correlated_groups(problem.windows.run)
    if groups is not None:
        residuals = np.einsum("kij,kj->ki", near.root, near.residuals)
        between = spread_between(groups, near.root @ near.jacobian, residuals)
        covariance, freedom = grown(covariance, freedom, *between)
    covariance = sizes[:, None] * covariance * sizes
    return Uncertainty(np.asarray((covariance + covariance.T) / 2), freedom)


def _linearised(problem: Problem, solution: Solution, sizes: FloatArray) -> Linearised:
    root = np.sqrt(solution.weights)[:, None, None] * problem.whitening
    jacobian = problem.jacobian(solution.chosen) * sizes
    whitened = root @ jacobian
    curvature = np.einsum("kif,kig->fg", whitened, whitened)
    inverse = np.linalg.pinv(curvature, rcond=1e-14, hermitian=True)
    return Linearised(root, problem.residuals(solution.chosen), jacobian, inverse)


def _parts_and_freedoms(
    problem: Problem, solution: Solution, near: Linearised
) -> tuple[FloatArray, FloatArray]:
    """Covariances (4, F, F) by poses, along, across and yaw; degrees of freedom (4,) of each."""
    windows, weights = problem.windows, solution.weights
    mean, freedom = residual_freedom(windows, near.root, near.jacobian, problem.variances)
    whitened = np.einsum("kij,kj->ki", near.root, near.residuals)
    variances = problem.variances * min(1.0, float(np.sum(whitened**2)) / mean)
    inverse_noise = near.root.swapaxes(1, 2) @ near.root
    gradients = near.jacobian.swapaxes(1, 2) @ inverse_noise
    # Of each axis, the share of the residuals that the parameters follow: traces of hat matrices.
    followed = np.einsum("kif,fg,kgi->i", near.jacobian, near.inverse, gradients)
    left = np.maximum(1 - followed / weights.sum(), 1 / (3 * len(windows)))
    motion = _unexplained_per_m(windows, weights, near.residuals, variances, left)
    none = np.zeros(3)
    scores = [
        score_covariance(windows, gradients, *causes)
        for causes in ((variances, none), *((none, axis * motion) for axis in np.eye(3)))
    ]
    parts = near.inverse @ np.array(scores) @ near.inverse
    freedoms = freedom * np.append(1.0, left / left.sum())
    return parts, np.minimum(freedoms, _most_freedom(windows, weights, left))


def _most_freedom(windows: Windows, weights: FloatArray, left: FloatArray) -> float:
    """What few windows leave of one axis, which some parameters depend on alone.

    The noise of many shows in all axes; so do their errors of motion, and the spread.
    """
    if len(windows) >= FEWEST_WINDOWS:
        return np.inf
    return float(weights.sum() * left.min())


def _unexplained_per_m(
    windows: Windows,
    weights: FloatArray,
    residuals: FloatArray,
    variances: FloatArray,
    left: FloatArray,
) -> FloatArray:
    """Variances (3,) of along, across and yaw per metre that the poses' noise does not explain.

    `left` (3,) is the share of the residuals that the fit leaves.
    """
    stated = np.diagonal(window_covariances(windows, variances), axis1=1, axis2=2)
    surplus = np.sum(weights[:, None] * (residuals**2 / left - stated), axis=0)
    return np.asarray(
        _overlap(windows) * np.maximum(surplus, 0.0) / np.sum(weights * windows.travel_m)
    )


def _overlap(windows: Windows) -> float:
    """In how many windows a sample lies on average: their errors are correlated by that much."""
    depth = np.zeros(len(windows.steps_s) + 1)
    np.add.at(depth, windows.first, 1.0)
    np.add.at(depth, windows.last, -1.0)
    covered = np.cumsum(depth[:-1])
    return float(covered.sum() / np.count_nonzero(covered))


def grown(
    covariance: FloatArray, freedom: FloatArray, between: FloatArray, between_freedom: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Covariance (F, F) and degrees of freedom (F,), by the variances between groups if larger."""
    within = np.maximum(np.diag(covariance), np.finfo(float).tiny)
    growth = np.sqrt(np.maximum(between / within, 1.0))
    freedom = np.where(between > within, between_freedom, freedom)
    return growth[:, None] * covariance * growth, freedom


def residual_freedom(
    windows: Windows, root: FloatArray, jacobian: FloatArray, variances: FloatArray
) -> tuple[float, float]:
    """Mean of the sum of squared residuals under the poses' noise, and its degrees of freedom.

    The residuals after a fit are e = M N z with z standard normal numbers, one for each
    coordinate of each pose: N spreads them over the windows, which share poses, and M = I - X B X'
    takes out what the parameters follow. With G = N' M N the sum e'e has the mean tr G, and is as
    chi-squared of (tr G)^2 / tr G^2 degrees of freedom (Satterthwaite 1946). Nothing dense is
    formed.

    Parameters
    ----------
    windows : Windows
    root : (K, 3, 3)
        Whitening of each window's residuals, with the square root of its weight.
    jacobian : (K, 3, F)
        Derivative of the residuals by the parameters.
    variances : (3,)
        Of a measured pose.
    """
    noise = _noise_matrix(windows, root, variances)
    by_parameters = (root @ jacobian).reshape(3 * len(windows), -1)
    followed = noise.T @ by_parameters  # N' X
    inverted = np.linalg.pinv(by_parameters.T @ by_parameters, rcond=1e-14, hermitian=True)
    taken = inverted @ followed.T @ followed
    shared = noise @ noise.T
    mean = float(noise.power(2).sum() - np.trace(taken))
    crossed = noise @ followed  # N N' X
    squares = float(
        shared.power(2).sum()
        - 2 * np.trace(inverted @ crossed.T @ crossed)
        + np.trace(taken @ taken)
    )
    return mean, mean**2 / squares


def _noise_matrix(windows: Windows, root: FloatArray, variances: FloatArray) -> csr_array:
    """Whitened residuals (3K) by standard normal noise (3P) of the poses."""
    poses, numbers = np.unique([windows.first_pose, windows.last_pose], return_inverse=True)
    numbers = numbers.reshape(2, len(windows))
    values = np.stack([root @ end * np.sqrt(variances) for end in by_pose_noise(windows)])
    axes = np.arange(3)
    rows = 3 * np.arange(len(windows))[:, None, None] + axes[:, None]
    columns = 3 * numbers[..., None, None] + axes
    rows, columns = (np.broadcast_to(places, values.shape) for places in (rows, columns))
    return csr_array(
        (values.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * len(windows), 3 * len(poses))
    )
