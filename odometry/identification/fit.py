"""Fit one model to windows: values, covariance, and what the windows leave open."""

from collections.abc import Mapping

import numpy as np

from odometry.identification.by_trial import try_values
from odometry.identification.config import SolverConfig
from odometry.identification.finish import finished
from odometry.identification.fitted import Fit
from odometry.identification.problem import PROBLEMS
from odometry.identification.solve import solve
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
