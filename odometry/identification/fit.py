"""Fit one model to windows: values, covariance, and what the windows leave open."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.identification.config import SolverConfig
from odometry.identification.finish import finished
from odometry.identification.fitted import Fit
from odometry.identification.problem import PROBLEMS, Problem
from odometry.identification.solve import Solution, loss, solve
from odometry.identification.start import start_of
from odometry.identification.uncertainty import parameter_uncertainty, residual_scale
from odometry.models.base import KinematicModel
from odometry.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.noise import pose_variances
from odometry.windows.windows import Windows

__all__ = ["Fit", "fit"]


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
