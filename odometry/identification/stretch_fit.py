"""Fit one model to stretches of positions: values, covariance, and the noise that was found."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.identification.config import SolverConfig
from odometry.identification.errors import IdentificationError
from odometry.identification.finish import finished
from odometry.identification.fitted import LEAST_POSITION_M, Fit
from odometry.identification.problem import StretchProblem
from odometry.identification.solve import Solution, solve
from odometry.identification.start import start_of
from odometry.identification.stretch_uncertainty import stretch_uncertainty
from odometry.models.base import KinematicModel
from odometry.run import Robot
from odometry.windows.stretch_noise import UNKNOWN_NOISE, StretchNoise, likeliest_noise
from odometry.windows.stretches import Stretches

ROUNDS = 3  # of values and noise in turn


def fit_stretches(
    model: KinematicModel,
    stretches: Stretches,
    robot: Robot,
    *,
    fixed: Mapping[str, float],
    released: frozenset[str] = frozenset(),
    near: Mapping[str, float] | None = None,
    solver_config: SolverConfig,
) -> Fit:
    """Identify the parameters of a model that are neither fixed nor known, from positions.

    Values and the noise that the residuals show are found in turn. Parameters are those of `fit`.

    Raises
    ------
    IdentificationError
        If the model is fitted in stages or by trial, there are fewer measured numbers than free
        parameters, or the best ones contradict each other.
    ParameterError
        If a name is no parameter of the model, or a fixed value is out of bounds.
    """
    start = start_of(
        model, robot, fixed=fixed, released=released, near=near, solver_config=solver_config
    )
    if model.stages or start.in_sign.any():
        raise IdentificationError(
            f"{model.name!r} is identified in stages, which needs poses with yaw; pose.csv has "
            "positions alone"
        )
    config = start.solver_config
    if config.loss == "linear":
        raise IdentificationError(
            "the loss 'linear' weighs metres as radians of measured yaw; pose.csv has positions "
            "alone: expected 'huber' or 'squares'"
        )
    problem = StretchProblem(model, stretches, start.values, start.free, UNKNOWN_NOISE.variances)
    start.require_numbers(len(stretches), "stretches", problem.numbers_per_window)
    sizes = start.sizes[start.free]
    solution = solve(problem, start.values[start.free], sizes, config)
    agreeing = solution.agreeing
    for _ in range(ROUNDS):
        noise = _noise(problem, solution, sizes)
        problem = replace(problem, variances=noise.variances)
        solution = solve(problem, solution.chosen, sizes, replace(config, starts=1))
    solution = replace(solution, agreeing=agreeing)
    uncertainty = stretch_uncertainty(problem, solution, noise, sizes)
    scale = _rms_m(problem, solution) / max(noise.position_m, LEAST_POSITION_M)
    return finished(start, problem, solution, uncertainty=uncertainty, scale=scale, noise=noise)


def _noise(problem: StretchProblem, solution: Solution, sizes: FloatArray) -> StretchNoise:
    residuals, jacobian = problem.linearised(solution.chosen)
    return likeliest_noise(problem.windows, residuals, jacobian * sizes, solution.weights)


def _rms_m(problem: StretchProblem, solution: Solution) -> float:
    ways = problem.residuals(solution.chosen)[:, : 2 * problem.windows.steps]
    return float(np.sqrt(np.mean(ways**2)))
