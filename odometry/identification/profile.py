"""Intervals by profiling: where a parameter's loss, all others fitted anew, is too large."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq, least_squares

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import IdentificationError
from odometry.identification.fit import Fit
from odometry.identification.fitted import Interval, deviations_within
from odometry.identification.identification import Identification
from odometry.identification.problem import PROBLEMS, AnyProblem, StretchProblem
from odometry.identification.start import SolverConfig
from odometry.recording.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.noise import pose_variances

NEAR = 1e-3  # of a standard deviation: how closely the ends are searched
FARTHEST = 50.0  # half widths of the symmetric interval; beyond, there is no end


def with_profiles(found: Identification, solver_config: SolverConfig) -> Identification:
    """The identification with profiled intervals; a dozen constrained fits for each end.

    Raises
    ------
    IdentificationError
        If a model is fitted in stages: it has no one loss.
    """
    terrains = {
        name: replace(of, fit=_profiled(of.fit, found.robot, found.window_config, solver_config))
        for name, of in found.terrains.items()
    }
    return replace(found, terrains=terrains)


def _profiled(
    fit: Fit, robot: Robot, window_config: WindowConfig, solver_config: SolverConfig
) -> Fit:
    if fit.model.stages is not None:
        raise IdentificationError(
            f"{fit.model.name!r} is fitted in stages, and has no one loss to profile"
        )
    free = np.array([parameter.name in fit.names for parameter in fit.model.parameters])
    problem = _problem(fit, free, window_config, solver_config)
    sizes = fit.model.ordinary_sizes(robot)
    blurred = {*fit.open_names, *fit.at_bound}
    return replace(
        fit,
        profiled={
            name: profile_interval(fit, name, problem, sizes)
            for name in fit.names
            if name not in blurred
        },
    )


def _problem(
    fit: Fit, free: BoolArray, window_config: WindowConfig, solver_config: SolverConfig
) -> AnyProblem:
    of = fit.windows
    if not isinstance(of, Stretches):
        variances = pose_variances(window_config)
        return PROBLEMS[solver_config.loss](fit.model, of, fit.packed, free, variances)
    if fit.noise is None:
        raise IdentificationError("a fit to stretches without its noise cannot be profiled")
    return StretchProblem(fit.model, of, fit.packed, free, fit.noise.variances)


def profile_interval(fit: Fit, name: str, problem: AnyProblem, sizes: FloatArray) -> Interval:
    """The 95 % interval of one parameter of a fit by its profile.

    It holds the values at which the least loss over the other parameters is above the best by
    less than t^2 (Venzon and Moolgavkar 1988; an F test with one degree of freedom, as in lmfit).
    As neighbouring windows share noise and the model has errors of its own, the loss is scaled so
    that its curvature agrees with the variance of sandwich form (Chandler and Bate 2007 eq. 9):
    where the loss is quadratic the interval is that of Student's t. The weights of outliers are
    held.

    Parameters
    ----------
    fit : Fit
    name : str
        One of its identified parameters.
    problem : AnyProblem
        With the values of the fit, and its identified parameters free.
    sizes : (P,)
        Ordinary sizes of all parameters.
    """
    place = fit.names.index(name)
    sigma, freedom = fit.sigmas[name], float(fit.freedom[place])
    whitened = np.sqrt(fit.weights)[:, None, None] * (
        problem.whitening @ problem.jacobian(fit.packed[problem.free])
    )
    scaled = (whitened * sizes[problem.free]).reshape(-1, len(fit.names))
    curvature = np.linalg.pinv(scaled.T @ scaled)[place, place]
    plain = float(np.sqrt(curvature) * sizes[_at(fit, name)])
    profile = _Profile(fit, name, problem, sizes, sigma / plain)
    within = float(deviations_within(fit.freedom)[place])
    low, high = (profile.end(side * within * sigma, within) for side in (-1, 1))
    return Interval(low, high, freedom)


def _at(fit: Fit, name: str) -> int:
    return [parameter.name for parameter in fit.model.parameters].index(name)


@dataclass(frozen=True)
class _Profile:
    """The root of the loss above its best, in standard deviations, by a parameter's value."""

    fit: Fit
    name: str
    problem: AnyProblem
    sizes: FloatArray
    inflation: float

    def end(self, step: float, within: float) -> float:
        """Where the profile is `within` deviations up, on the side of `step`; a bound if before."""
        best, place = self.fit.values[self.name], self.fit.names.index(self.name)
        low, high = (float(ends[place]) for ends in self.problem.bounds())

        def above(value: float) -> float:
            return self.deviations(value) - within

        inner, factor = best, 1.0
        while factor <= FARTHEST:
            outer = float(np.clip(best + factor * step, low, high))
            if above(outer) > 0:
                return float(brentq(above, inner, outer, xtol=NEAR * abs(step)))
            if outer in (low, high):
                return outer
            inner, factor = outer, 1.5 * factor
        return float(np.copysign(np.inf, step))

    def deviations(self, value: float) -> float:
        """Square root of the loss above its best at a value, others fitted, per deviation."""
        if value == self.fit.values[self.name]:
            return 0.0
        return float(np.sqrt(max(self._cost(value) - self._best(), 0.0)) / self.inflation)

    def _best(self) -> float:
        return float(np.sum(self._whitened(self.problem, self.fit.packed[self.problem.free]) ** 2))

    def _cost(self, value: float) -> float:
        place = _at(self.fit, self.name)
        values, free = self.fit.packed, self.problem.free.copy()
        values[place], free[place] = value, False
        held = replace(self.problem, values=values, free=free)
        if not free.any():
            return float(np.sum(self._whitened(held, values[free]) ** 2))
        low, high = held.bounds()
        solved = least_squares(
            lambda chosen: self._whitened(held, chosen),
            np.clip(values[free], low, high),
            lambda chosen: (self._root(held) @ held.jacobian(chosen)).reshape(-1, len(chosen)),
            bounds=(low, high),
            x_scale=self.sizes[free],
        )
        return float(2 * solved.cost)

    def _root(self, problem: AnyProblem) -> FloatArray:
        return np.asarray(np.sqrt(self.fit.weights)[:, None, None] * problem.whitening)

    def _whitened(self, problem: AnyProblem, chosen: FloatArray) -> FloatArray:
        residuals = problem.residuals(chosen)
        return np.asarray(np.einsum("kij,kj->ki", self._root(problem), residuals)).ravel()
