"""Fit one model to windows: values, covariance, and what the windows leave open."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import IdentificationError, ParameterError
from odometry.identification.fitted import Fit, undetermined
from odometry.identification.problem import PROBLEMS, AnyProblem, Problem
from odometry.identification.solve import Solution, loss, solve
from odometry.identification.start import SolverConfig, Start, by_name, start_of
from odometry.identification.uncertainty import Uncertainty, parameter_uncertainty, residual_scale
from odometry.models.base import KinematicModel
from odometry.recording.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.stretches.stretch_noise import StretchNoise
from odometry.windows.travel.noise import pose_variances
from odometry.windows.travel.windows import Windows

__all__ = ["Fit", "fit"]

EDGE = 1e-3  # ordinary sizes: nearer to a bound than this, a parameter is at it


def fit(
    model: KinematicModel,
    windows: Windows,
    robot: Robot,
    *,
    fixed: Mapping[str, float],
    released: frozenset[str] = frozenset(),
    near: Mapping[str, float] | None = None,
    window_config: WindowConfig,
    solver_config: SolverConfig,
) -> Fit:
    """Identify the parameters of a model that are neither fixed nor known.

    Parameters
    ----------
    model : KinematicModel
    windows : Windows
    robot : Robot
        Gives the starting values, and those of known parameters.
    fixed : Mapping of name to float
        Held at these values.
    released : names
        Known parameters to identify all the same.
    near : Mapping of name to float, optional
        Where the one search starts that is then made; without it, searches start from the guess
        for the robot and around it.
    window_config : WindowConfig
        Its pose noise states the covariance of the loss.
    solver_config : SolverConfig

    Raises
    ------
    IdentificationError
        If there are fewer measured numbers than free parameters, or the best ones contradict
        each other.
    ParameterError
        If a name is no parameter of the model, or a fixed value is out of bounds.
    """
    start = start_of(
        model, robot, fixed=fixed, released=released, near=near, solver_config=solver_config
    )
    start.require_numbers(len(windows), "windows", 3)
    config, sizes = start.solver_config, start.sizes
    problem = PROBLEMS[config.loss](
        model, windows, start.values, start.free & ~start.in_sign, pose_variances(window_config)
    )
    solution = solve(problem, start.values[problem.free], sizes[problem.free], config)
    for place in np.flatnonzero(start.in_sign):
        problem, solution = try_values(problem, solution, sizes, int(place), config)
    uncertainty = parameter_uncertainty(problem, solution, sizes[problem.free])
    scale = residual_scale(problem, solution)
    return finished(start, problem, solution, uncertainty=uncertainty, scale=scale)


COARSE, FINE = 9, 81  # numbers of values of a parameter that acts through a sign alone
ALTERNATIONS = 5


def try_values(
    problem: Problem, solution: Solution, sizes: FloatArray, place: int, config: SolverConfig
) -> tuple[Problem, Solution]:
    """Search a parameter that acts through a sign alone: it has no derivative.

    First with few values, then near the best one.

    Near it, the best of many values and the search for the rest take turns.
    """
    parameter = problem.model.parameters[place]
    ends = parameter.search or (parameter.low, parameter.high)
    plain = replace(config, starts=1, loss="squares")
    coarse = [
        replace(problem, values=_put(problem.values, place, value))
        for value in np.geomspace(*ends, COARSE)
    ]
    found = [solve(each, solution.chosen, sizes[problem.free], plain) for each in coarse]
    best = int(np.argmin([each.cost for each in found]))
    problem, chosen = coarse[best], found[best].chosen
    for _ in range(ALTERNATIONS):
        fine = [
            replace(problem, values=_put(problem.values, place, value))
            for value in np.geomspace(*ends, FINE)
        ]
        costs = np.array([loss(each, chosen, config) for each in fine])
        equal = np.flatnonzero(costs <= costs.min() * (1 + 1e-9))
        nearest = fine[int(equal[len(equal) // 2])]
        if nearest.values[place] == problem.values[place]:
            break
        problem = nearest
        chosen = solve(problem, chosen, sizes[problem.free], replace(config, starts=1)).chosen
    final = solve(problem, chosen, sizes[problem.free], replace(config, starts=1))
    return problem, replace(final, agreeing=solution.agreeing)


def _put(values: FloatArray, place: int, value: float) -> FloatArray:
    changed = values.copy()
    changed[place] = value
    return changed


def finished(
    start: Start,
    problem: AnyProblem,
    solution: Solution,
    *,
    uncertainty: Uncertainty,
    scale: float,
    noise: StretchNoise | None = None,
) -> Fit:
    """The fit of a solution.

    Parameters
    ----------
    start : Start
    problem : AnyProblem
    solution : Solution
    uncertainty : Uncertainty
    scale : float
        How many times larger the residuals are than the noise explains.
    noise : StretchNoise, optional
        Where the noise was estimated from these residuals: `scale` widens nothing then.

    Raises
    ------
    IdentificationError
        If the values contradict each other.
    """
    low, high = problem.bounds()
    sizes = start.sizes[problem.free]
    at_bound = (solution.chosen < low + EDGE * sizes) | (solution.chosen > high - EDGE * sizes)
    values = problem.complete(solution.chosen)
    try:
        problem.model.check(values)
    except ParameterError as error:
        raise IdentificationError(f"the best fit of {problem.model.name!r}: {error}") from error
    residuals, jacobian = problem.linearised(solution.chosen)
    whitened = np.sqrt(solution.weights)[:, None, None] * (problem.noise_whitening @ jacobian)
    in_sign = zip(problem.model.parameters, start.in_sign, strict=True)
    return Fit(
        model=problem.model,
        values=by_name(problem.model, values),
        names=problem.names,
        covariance=uncertainty.covariance,
        freedom=uncertainty.freedom,
        undetermined=undetermined(
            whitened.reshape(residuals.size, len(sizes)),
            problem.names,
            sizes,
            max(1.0, scale) if noise is None else 1.0,
            start.solver_config.undetermined,
        ),
        by_trial=tuple(parameter.name for parameter, sign in in_sign if sign),
        at_bound=tuple(name for name, edged in zip(problem.names, at_bound, strict=True) if edged),
        residuals=residuals,
        weights=solution.weights,
        scale=scale,
        agreeing=solution.agreeing,
        starts=start.solver_config.starts,
        windows=problem.windows,
        start=start.by_name,
        noise=noise,
    )
