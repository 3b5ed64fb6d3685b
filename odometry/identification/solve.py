"""Bounded least squares over windows, with outliers weighed down and several starts."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import chi2

from odometry.arrays import FloatArray
from odometry.identification.problem import AnyProblem
from odometry.identification.start import SolverConfig

INSIDE = 0.95  # of normal Mahalanobis distances: those that Huber's function squares
REWEIGHTINGS = 20
SAME_WEIGHT = 1e-2
EVALUATIONS = 60  # of the loss in one search
FEW_EVALUATIONS = 4  # between two weighings
SAME_COST = 1e-4  # relative difference below which two starts have found the same minimum
SPREAD = 0.35  # of the further starts, as a share of each parameter's ordinary size


@dataclass(frozen=True)
class Solution:
    """Where the loss is least.

    Attributes
    ----------
    chosen : (F,)
        Free parameters.
    weights : (K,)
        Of the windows, 1 where they count in full.
    cost : float
        Sum of Huber's function of the Mahalanobis distances, or of their squares.
    agreeing : int
        Starts that came to this minimum.
    """

    chosen: FloatArray
    weights: FloatArray
    cost: float
    agreeing: int


def solve(
    problem: AnyProblem, start: FloatArray, sizes: FloatArray, config: SolverConfig
) -> Solution:
    """Search from `start` (F,) and from further starts around it.

    Every start is a search for the least squares; from the best, outliers are weighed down.

    Parameters
    ----------
    problem : AnyProblem
    start, sizes : (F,)
        Where to start, and the ordinary size of each parameter.
    config : SolverConfig
    """
    everything = np.ones(len(problem.windows))
    if not len(start):
        return Solution(start, everything, loss(problem, start, config), config.starts)
    low, high = problem.bounds()
    rng = np.random.default_rng(config.seed)
    found, costs = [], []
    for number in range(config.starts):
        away = SPREAD * sizes * rng.standard_normal(len(start)) * (number > 0)
        inside = np.clip(start + away, low + 1e-3 * sizes, high - 1e-3 * sizes)
        found.append(_least_squares(problem, inside, sizes, everything, EVALUATIONS))
        costs.append(_squares(problem, found[-1]))
    agreeing = sum(cost <= min(costs) * (1 + SAME_COST) + 1e-12 for cost in costs)
    chosen, weights = found[int(np.argmin(costs))], everything
    if config.loss == "huber":
        chosen, weights = _reweighted(problem, chosen, sizes)
    return Solution(chosen, weights, loss(problem, chosen, config), agreeing)


def loss(problem: AnyProblem, chosen: FloatArray, config: SolverConfig) -> float:
    """Sum of squared Mahalanobis distances (Baril 2020 eq. 13), or of Huber's function of them."""
    if config.loss != "huber":
        return _squares(problem, chosen)
    distances = _distances(problem, chosen)
    scale, cutoff = _scale(distances, problem), _cutoff(problem)
    scaled = distances / scale
    inside = scaled <= cutoff
    rho = np.where(inside, scaled**2, 2 * cutoff * scaled - cutoff**2)
    return float(np.sum(rho) * scale**2)


def _reweighted(
    problem: AnyProblem, chosen: FloatArray, sizes: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Parameters (F,) and weights (K,) that belong together: Huber's loss by repeated squares."""
    weights = np.ones(len(problem.windows))
    for _ in range(REWEIGHTINGS):
        distances = _distances(problem, chosen)
        largest = _cutoff(problem) * _scale(distances, problem)
        before, weights = weights, np.minimum(1.0, largest / distances)
        if np.abs(weights - before).max() < SAME_WEIGHT:
            break
        chosen = _least_squares(problem, chosen, sizes, weights, FEW_EVALUATIONS)
    return chosen, weights


def _least_squares(
    problem: AnyProblem, start: FloatArray, sizes: FloatArray, weights: FloatArray, evaluations: int
) -> FloatArray:
    root = np.sqrt(weights)[:, None, None] * problem.whitening

    def residuals(chosen: FloatArray) -> FloatArray:
        found, _ = problem.linearised(chosen)
        return np.asarray(np.einsum("kij,kj->ki", root, found)).ravel()

    def jacobian(chosen: FloatArray) -> FloatArray:
        _, found = problem.linearised(chosen)
        return np.asarray(root @ found).reshape(-1, len(chosen))

    solved = least_squares(
        residuals, start, jacobian, bounds=problem.bounds(), x_scale=sizes, max_nfev=evaluations
    )
    return np.asarray(solved.x)


def _squares(problem: AnyProblem, chosen: FloatArray) -> float:
    return float(np.sum(_distances(problem, chosen) ** 2))


def _distances(problem: AnyProblem, chosen: FloatArray) -> FloatArray:
    """Mahalanobis distances (K,)."""
    whitened = np.einsum("kij,kj->ki", problem.whitening, problem.residuals(chosen))
    return np.asarray(np.maximum(np.linalg.norm(whitened, axis=1), 1e-12))


def _scale(distances: FloatArray, problem: AnyProblem) -> float:
    """How many times larger the residuals are than stated, by their median."""
    return float(np.median(distances) / np.sqrt(chi2.median(problem.numbers_per_window)))


def _cutoff(problem: AnyProblem) -> float:
    """Huber's, of a Mahalanobis distance in as many dimensions as a window has numbers."""
    return float(np.sqrt(chi2.ppf(INSIDE, problem.numbers_per_window)))
