"""Fit one model to stretches of positions: values, covariance, and the noise that was found."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.identification.config import SolverConfig
from odometry.identification.errors import IdentificationError
from odometry.identification.excitation import ordinary_sizes, undetermined
from odometry.identification.fitted import Fit
from odometry.identification.problem import by_name, start_values
from odometry.identification.solve import Solution, solve
from odometry.identification.stretch_problem import StretchProblem
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
    parameters = model.parameters
    free = np.array(
        [p.name not in fixed and (not p.known or p.name in released) for p in parameters]
    )
    if model.stages or any(p.in_sign for p, chosen in zip(parameters, free, strict=True) if chosen):
        raise IdentificationError(
            f"{model.name!r} is identified in stages, which needs poses with yaw; pose.csv has "
            "positions alone"
        )
    if solver_config.loss == "linear":
        raise IdentificationError(
            "the loss 'linear' weighs metres as radians of measured yaw; pose.csv has positions "
            "alone: expected 'huber' or 'squares'"
        )
    values = start_values(model, robot, fixed, released, near or {})
    problem = StretchProblem(model, stretches, values, free, UNKNOWN_NOISE.variances)
    if problem.numbers_per_window * len(stretches) <= free.sum():
        raise IdentificationError(
            f"{len(stretches)} stretches cannot tell {int(free.sum())} parameters of {model.name!r}"
        )
    sizes = ordinary_sizes(model, robot)[free]
    if near is not None:
        solver_config = replace(solver_config, starts=1)
    solution = solve(problem, values[free], sizes, solver_config)
    agreeing = solution.agreeing
    for _ in range(ROUNDS):
        noise = _noise(problem, solution, sizes)
        problem = replace(problem, variances=noise.variances)
        solution = solve(problem, solution.chosen, sizes, replace(solver_config, starts=1))
    solution = replace(solution, agreeing=agreeing)
    return replace(
        _finish(problem, solution, noise, sizes, solver_config), start=by_name(model, values)
    )


def _noise(problem: StretchProblem, solution: Solution, sizes: FloatArray) -> StretchNoise:
    residuals, jacobian = problem.linearised(solution.chosen)
    return likeliest_noise(problem.windows, residuals, jacobian * sizes, solution.weights)


def _finish(
    problem: StretchProblem,
    solution: Solution,
    noise: StretchNoise,
    sizes: FloatArray,
    config: SolverConfig,
) -> Fit:
    residuals, jacobian = problem.linearised(solution.chosen)
    whitened = np.sqrt(solution.weights)[:, None, None] * (problem.whitening @ jacobian)
    low, high = problem.bounds()
    edge = 1e-3 * sizes
    at_bound = (solution.chosen < low + edge) | (solution.chosen > high - edge)
    values = problem.complete(solution.chosen)
    try:
        problem.model.check(values)
    except ParameterError as error:
        raise IdentificationError(f"the best fit of {problem.model.name!r}: {error}") from error
    uncertainty = stretch_uncertainty(problem, solution, noise, sizes)
    rms_m = float(np.sqrt(np.mean(residuals[:, : 2 * problem.windows.steps] ** 2)))
    return Fit(
        model=problem.model,
        values=by_name(problem.model, values),
        names=problem.names,
        covariance=uncertainty.covariance,
        freedom=uncertainty.freedom,
        undetermined=undetermined(
            whitened.reshape(-1, len(sizes)), problem.names, sizes, 1.0, config.undetermined
        ),
        by_trial=(),
        at_bound=tuple(name for name, edged in zip(problem.names, at_bound, strict=True) if edged),
        residuals=residuals,
        weights=solution.weights,
        scale=rms_m / noise.position_m,
        agreeing=solution.agreeing,
        starts=config.starts,
        windows=problem.windows,
        start={},
        noise=noise,
    )
