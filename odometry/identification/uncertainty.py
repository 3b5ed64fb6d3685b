"""How well the windows tell the parameters."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.identification.problem import Problem
from odometry.identification.solve import Solution
from odometry.windows.noise import score_covariance, window_covariances
from odometry.windows.windows import Windows


def residual_scale(problem: Problem, solution: Solution) -> float:
    """Root mean square of the whitened residuals: 1 where the stated noise explains them."""
    whitened = np.einsum("kij,kj->ki", problem.whitening, problem.residuals(solution.chosen))
    freedom = max(3 * float(solution.weights.sum()) - len(solution.chosen), 1.0)
    return float(np.sqrt(np.sum(solution.weights[:, None] * whitened**2) / freedom))


def parameter_covariance(problem: Problem, solution: Solution, sizes: FloatArray) -> FloatArray:
    """Covariance (F, F) of the free parameters, of sandwich form.

    The poses have the stated noise, or less where the residuals are smaller than it explains;
    windows that share a pose share its noise. What the residuals have beyond is the model's own
    error: independent on every metre of wheel travel, and so shared by windows that overlap.

    Parameters
    ----------
    problem : Problem
    solution : Solution
    sizes : (F,)
        Ordinary sizes, so that parameters of very different units can be inverted together.
    """
    windows, weights = problem.windows, solution.weights
    variances = problem.variances * min(1.0, residual_scale(problem, solution)) ** 2
    whitening = problem.whitening
    inverse = whitening.swapaxes(1, 2) @ whitening
    jacobian = problem.jacobian(solution.chosen) * sizes
    gradients = weights[:, None, None] * jacobian.swapaxes(1, 2) @ inverse
    curvature = np.einsum("kfi,kig->fg", gradients, jacobian)
    motion = _unexplained_per_m(problem, solution, variances)
    scores = score_covariance(windows, gradients, variances, motion)
    inverted = np.linalg.pinv(curvature, rcond=1e-14, hermitian=True)
    covariance = sizes[:, None] * (inverted @ scores @ inverted) * sizes
    return np.asarray((covariance + covariance.T) / 2)


def _unexplained_per_m(problem: Problem, solution: Solution, variances: FloatArray) -> FloatArray:
    """Variances (3,) of along, across and yaw per metre that the poses' noise does not explain."""
    windows, weights = problem.windows, solution.weights
    residuals = problem.residuals(solution.chosen)
    stated = np.diagonal(window_covariances(windows, variances), axis1=1, axis2=2)
    count = 3 * weights.sum()
    freed = count / max(count - len(solution.chosen), 1.0)
    surplus = np.sum(weights[:, None] * (freed * residuals**2 - stated), axis=0)
    return np.asarray(
        _overlap(windows) * np.maximum(surplus, 0.0) / np.sum(weights * windows.travel_m)
    )


def _overlap(windows: Windows) -> float:
    """In how many windows a sample lies on average: their own errors are that much alike."""
    depth = np.zeros(len(windows.steps_s) + 1)
    np.add.at(depth, windows.first, 1.0)
    np.add.at(depth, windows.last, -1.0)
    covered = np.cumsum(depth[:-1])
    return float(covered.sum() / np.count_nonzero(covered))
