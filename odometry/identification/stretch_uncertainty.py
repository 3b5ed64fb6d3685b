"""How well stretches of positions tell the parameters."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.identification.solve import Solution
from odometry.identification.spread import groups_alike, spread_between
from odometry.identification.stretch_problem import StretchProblem
from odometry.identification.uncertainty import Uncertainty, grown
from odometry.windows.stretch_noise import StretchNoise, covariance_parts


def stretch_uncertainty(
    problem: StretchProblem, solution: Solution, noise: StretchNoise, sizes: FloatArray
) -> Uncertainty:
    """Covariance of the free parameters and its degrees of freedom.

    That of generalised least squares under the noise that was found; the degrees of freedom are
    those of Fai and Cornelius 1996: how well the three variances are known by which each
    parameter's own is made. Where the spread between runs, or between stretches, shows larger
    variances, these are taken.

    Parameters
    ----------
    problem : StretchProblem
    solution : Solution
    noise : StretchNoise
        Its precision belongs to the stretches of the problem.
    sizes : (F,)
        Ordinary sizes, so that parameters of very different units can be inverted together.
    """
    if not len(sizes):
        return Uncertainty(np.empty((0, 0)), np.empty(0))
    root = np.sqrt(solution.weights)[:, None, None] * problem.whitening
    residuals, jacobian = problem.linearised(solution.chosen)
    jacobian = jacobian * sizes
    whitened = root @ jacobian
    curvature = np.einsum("kif,kig->fg", whitened, whitened)
    covariance = np.linalg.pinv(curvature, rcond=1e-14, hermitian=True)
    freedom = _freedom(problem, root, whitened @ covariance, noise)
    groups = groups_alike(problem.windows.run, 1)
    if groups is not None:
        found = np.einsum("kij,kj->ki", root, residuals)
        covariance, freedom = grown(covariance, freedom, *spread_between(groups, whitened, found))
    covariance = sizes[:, None] * covariance * sizes
    return Uncertainty(np.asarray((covariance + covariance.T) / 2), freedom)


def _freedom(
    problem: StretchProblem, root: FloatArray, influence: FloatArray, noise: StretchNoise
) -> FloatArray:
    """Degrees of freedom (F,): 2 v^2 / (g' M g), g the change of v by the three variances."""
    by_rows = root.swapaxes(1, 2) @ influence  # (K, R, F)
    parts = covariance_parts(problem.windows)
    changes = np.einsum("kif,pkij,kjf->pf", by_rows, parts, by_rows, optimize=True)
    variances = np.sum(np.square(influence), axis=(0, 1))
    known = np.linalg.pinv(noise.precision, hermitian=True)
    spread = np.einsum("pf,pq,qf->f", changes, known, changes)
    return np.asarray(2 * variances**2 / np.maximum(spread, np.finfo(float).tiny))
