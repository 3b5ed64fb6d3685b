"""Fit one model to windows: values, covariance, and what the windows leave open."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import ParameterError
from odometry.identification.by_trial import try_values
from odometry.identification.config import SolverConfig
from odometry.identification.errors import IdentificationError
from odometry.identification.excitation import ordinary_sizes, undetermined
from odometry.identification.fitted import Fit
from odometry.identification.problem import PROBLEMS, Problem, by_name, start_values
from odometry.identification.solve import Solution, solve
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
    values = start_values(model, robot, fixed, released, near or {})
    if near is not None:
        solver_config = replace(solver_config, starts=1)
    free = np.array(
        [p.name not in fixed and (not p.known or p.name in released) for p in model.parameters]
    )
    in_sign = np.array([parameter.in_sign for parameter in model.parameters])
    if 3 * len(windows) <= free.sum():
        raise IdentificationError(
            f"{len(windows)} windows cannot tell {int(free.sum())} parameters of {model.name!r}"
        )
    sizes = ordinary_sizes(model, robot)
    problem = PROBLEMS[solver_config.loss](
        model, windows, values, free & ~in_sign, pose_variances(window_config)
    )
    solution = solve(problem, values[problem.free], sizes[problem.free], solver_config)
    for place in np.flatnonzero(free & in_sign):
        problem, solution = try_values(problem, solution, sizes, int(place), solver_config)
    found = _finish(problem, solution, sizes[problem.free], free & in_sign, solver_config)
    return replace(found, start=by_name(model, values))


def _finish(
    problem: Problem,
    solution: Solution,
    sizes: FloatArray,
    in_sign: BoolArray,
    config: SolverConfig,
) -> Fit:
    scale = residual_scale(problem, solution)
    whitened = np.sqrt(solution.weights)[:, None, None] * (
        problem.noise_whitening @ problem.jacobian(solution.chosen)
    )
    low, high = problem.bounds()
    edge = 1e-3 * sizes
    at_bound = (solution.chosen < low + edge) | (solution.chosen > high - edge)
    values = problem.complete(solution.chosen)
    try:
        problem.model.check(values)
    except ParameterError as error:
        raise IdentificationError(f"the best fit of {problem.model.name!r}: {error}") from error
    uncertainty = parameter_uncertainty(problem, solution, sizes)
    return Fit(
        model=problem.model,
        values=by_name(problem.model, values),
        names=problem.names,
        covariance=uncertainty.covariance,
        freedom=uncertainty.freedom,
        undetermined=undetermined(
            whitened.reshape(3 * len(problem.windows), len(sizes)),
            problem.names,
            sizes,
            max(1.0, scale),
            config.undetermined,
        ),
        by_trial=tuple(
            p.name for p, sign in zip(problem.model.parameters, in_sign, strict=True) if sign
        ),
        at_bound=tuple(name for name, edged in zip(problem.names, at_bound, strict=True) if edged),
        residuals=problem.residuals(solution.chosen),
        weights=solution.weights,
        scale=scale,
        agreeing=solution.agreeing,
        starts=config.starts,
        windows=problem.windows,
        start={},
    )
