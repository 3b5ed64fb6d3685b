"""Fit one model to windows: values, covariance, and what the windows leave open."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import ParameterError
from odometry.identification.by_trial import try_values
from odometry.identification.config import SolverConfig
from odometry.identification.errors import IdentificationError
from odometry.identification.excitation import Undetermined, ordinary_sizes, undetermined
from odometry.identification.intervals import NORMAL, Interval, deviations_within
from odometry.identification.problem import PROBLEMS, Problem
from odometry.identification.solve import Solution, solve
from odometry.identification.uncertainty import parameter_uncertainty, residual_scale
from odometry.models.base import KinematicModel
from odometry.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.noise import pose_variances
from odometry.windows.windows import Windows


@dataclass(frozen=True)
class Fit:
    """Parameters of one model on one ground.

    Attributes
    ----------
    model : KinematicModel
    values : Mapping of name to float
        Every parameter of the model.
    names : tuple of str
        Those that were identified and have a variance.
    covariance : (F, F)
        Of `names`.
    freedom : (F,)
        Degrees of freedom of the variances in it.
    undetermined : tuple of Undetermined
        What the windows leave open.
    by_trial : tuple of str
        Identified by trying values, because they act through a sign alone: no variance.
    at_bound : tuple of str
        Parameters that ended at the edge of where the search may look.
    residuals : (K, 3)
        Predicted less measured motion: along, across [m], yaw [rad].
    weights : (K,)
        1 where a window counts in full, less where it is an outlier.
    scale : float
        How many times larger the residuals are than the poses' stated noise explains.
    agreeing, starts : int
        How many of the starts found this minimum.
    windows : Windows
    start : Mapping of name to float
        Where the first search started.
    """

    model: KinematicModel
    values: Mapping[str, float]
    names: tuple[str, ...]
    covariance: FloatArray
    freedom: FloatArray
    undetermined: tuple[Undetermined, ...]
    by_trial: tuple[str, ...]
    at_bound: tuple[str, ...]
    residuals: FloatArray
    weights: FloatArray
    scale: float
    agreeing: int
    starts: int
    windows: Windows
    start: Mapping[str, float]

    @property
    def open_names(self) -> frozenset[str]:
        """Parameters of the combinations that the windows leave open: their sigmas mean nothing."""
        return frozenset(name for open_ in self.undetermined for name in open_.direction)

    @property
    def packed(self) -> FloatArray:
        """Parameters (P,) in the order of the model."""
        return np.array([self.values[parameter.name] for parameter in self.model.parameters])

    @property
    def sigmas(self) -> dict[str, float]:
        """Standard deviation of each identified parameter."""
        deviations = np.sqrt(np.diag(self.covariance))
        return {name: float(value) for name, value in zip(self.names, deviations, strict=True)}

    @property
    def intervals(self) -> dict[str, Interval]:
        """95 % interval of each identified parameter, by Student's t."""
        halves = np.sqrt(np.diag(self.covariance)) * deviations_within(self.freedom)
        return {
            name: Interval(self.values[name] - half, self.values[name] + half, freedom)
            for name, half, freedom in zip(
                self.names, halves.tolist(), self.freedom.tolist(), strict=True
            )
        }

    @property
    def normal_covariance(self) -> FloatArray:
        """Covariance (F, F) of the normal distribution that has these intervals.

        For whoever takes parameters as normal: filters, and readers of a parameter set.
        """
        growth = np.maximum(deviations_within(self.freedom) / NORMAL, 1.0)
        return np.asarray(growth[:, None] * self.covariance * growth)


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
    values = _start(model, robot, fixed, released, near or {})
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
    return replace(found, start=_by_name(model, values))


def _start(
    model: KinematicModel,
    robot: Robot,
    fixed: Mapping[str, float],
    released: frozenset[str],
    near: Mapping[str, float],
) -> FloatArray:
    names = {parameter.name for parameter in model.parameters}
    for name in sorted({*fixed, *released} - names):
        raise ParameterError(
            f"{name!r} is no parameter of {model.name!r}; it has {', '.join(sorted(names))}"
        )
    for name in sorted(released & set(fixed)):
        raise ParameterError(f"{name!r} is both fixed and free; expected one of them")
    return model.pack({**model.guess(robot), **near, **fixed})


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
        values=_by_name(problem.model, values),
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


def _by_name(model: KinematicModel, values: FloatArray) -> dict[str, float]:
    return {p.name: float(value) for p, value in zip(model.parameters, values, strict=True)}
