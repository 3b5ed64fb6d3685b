"""Fit one model to stretches of positions: values, covariance, and the noise that was found."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import IdentificationError
from odometry.identification.fit import finished
from odometry.identification.fitted import LEAST_POSITION_M, Fit
from odometry.identification.problem import StretchProblem
from odometry.identification.solve import Solution, solve
from odometry.identification.spread import correlated_groups, spread_between
from odometry.identification.start import SolverConfig, start_of
from odometry.identification.uncertainty import Uncertainty, grown
from odometry.models.base import KinematicModel
from odometry.models.catalogue import MODELS
from odometry.recording.run import Robot, Run
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.measured_poses import lacks_yaw
from odometry.windows.stretches.stretch_motion import change_by_late_turns
from odometry.windows.stretches.stretch_noise import (
    UNKNOWN_NOISE,
    StretchNoise,
    covariance_parts,
    likeliest_noise,
)
from odometry.windows.stretches.stretches import MOST_POSITIONS, Stretches, stretches_of
from odometry.windows.travel.windows import Windows, windows_of

FEWEST = 4  # stretches whose spread is taken
SCALE = 0.01  # standard deviation of what a gyroscope's scale is off by
TINY = np.finfo(float).tiny

LEAST_M = 2.0  # wheel travel of a stretch, in a short run
USUAL_M, USUAL_BY_TREADS_M = 5.0, 10.0  # longer where turns are known from treads alone
MOST_M = 50.0
ENOUGH = 8  # stretches of all runs together
DIRECTION_RAD = 0.02  # accuracy aimed at for the direction of a stretch
COARSE_RAD = 0.06  # least accuracy
LINE = np.sqrt(12 / MOST_POSITIONS)  # of n evenly spaced positions, by noise over length
SIMPLE = "icr_symmetric"  # the model under which the noise is found


def stretch_uncertainty(
    problem: StretchProblem, solution: Solution, noise: StretchNoise, sizes: FloatArray
) -> Uncertainty:
    """Covariance of the free parameters and its degrees of freedom.

    That of generalised least squares under the noise that was found; the degrees of freedom are
    those of Fai and Cornelius 1996: how well the three variances are known by which each
    parameter's own is made. Where the spread between runs, or between stretches, shows larger
    variances, these are taken. A gyroscope's scale and its delay are off by the same in all of
    them, which no spread shows: they are added with SCALE and half of its period.

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
    inverse = np.linalg.pinv(curvature, rcond=1e-14, hermitian=True)
    covariance, freedom = inverse, _freedom(problem, root, whitened @ inverse, noise)
    groups = correlated_groups(problem.windows.run, 1, FEWEST)
    if groups is not None:
        found = np.einsum("kij,kj->ki", root, residuals)
        covariance, freedom = grown(covariance, freedom, *spread_between(groups, whitened, found))
    by_scale = _by_scale(problem, root, whitened @ inverse)
    by_delay = _by_delay(problem, solution, root, whitened @ inverse)
    total = covariance + by_scale[:, None] * by_scale + by_delay[:, None] * by_delay
    freedom = freedom * np.square(np.diag(total) / np.maximum(np.diag(covariance), TINY))
    covariance = sizes[:, None] * total * sizes
    return Uncertainty(np.asarray((covariance + covariance.T) / 2), freedom)


def _by_scale(problem: StretchProblem, root: FloatArray, influence: FloatArray) -> FloatArray:
    """What one standard deviation of a gyroscope's scale moves the parameters (F,) by."""
    turns = problem.windows.turns_rad
    if turns is None:
        return np.zeros(influence.shape[-1])
    off = np.einsum("kij,kj->ki", root[:, :, -turns.shape[1] :], SCALE * turns)
    return np.asarray(np.einsum("kif,ki->f", influence, off))


def _by_delay(
    problem: StretchProblem, solution: Solution, root: FloatArray, influence: FloatArray
) -> FloatArray:
    """What half of a gyroscope's period moves the parameters (F,) by: x_icr, of a robot ahead."""
    if problem.windows.turns_rad is None:
        return np.zeros(influence.shape[-1])
    values = problem.complete(solution.chosen)
    ways = change_by_late_turns(problem.model, values, problem.windows)
    off = np.einsum("kij,kj->ki", root[:, :, : ways.shape[1]], ways)
    return np.asarray(np.einsum("kif,ki->f", influence, off))


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
    return np.asarray(2 * variances**2 / np.maximum(spread, TINY))


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


def windows_or_stretches(runs: Sequence[Run], config: WindowConfig) -> Windows | Stretches:
    """Windows between poses; stretches of positions where one of the runs lacks yaw.

    Raises
    ------
    WindowError
        See `windows_of` and `stretches_of`.
    IdentificationError
        If the noise of the positions cannot be estimated.
    """
    if not any(map(lacks_yaw, runs)):
        return windows_of(runs, config)
    return stretches_for(runs, config)


def stretches_for(runs: Sequence[Run], config: WindowConfig) -> Stretches:
    """Stretches that are long enough for positions to determine their direction.

    The noise of the positions is found from a simple model on stretches of USUAL_BY_TREADS_M. A
    horizon of `config` that is longer than these stretches is taken instead.
    """
    first = stretches_of(runs, max(USUAL_BY_TREADS_M, config.travel_m), config)
    length_m = max(length_for(noise_of(first, runs[0].robot), first), config.travel_m)
    return stretches_of(runs, length_m, config)


def noise_of(of: Stretches, robot: Robot) -> StretchNoise:
    """The noise of stretches, beside a simple model identified on them."""
    fitted = fit_stretches(
        MODELS[SIMPLE], of, robot, fixed={}, solver_config=SolverConfig(starts=2)
    )
    return fitted.noise or UNKNOWN_NOISE


def length_for(noise: StretchNoise, of: Stretches) -> float:
    """Wheel travel [m] over which positions of this noise determine a direction to DIRECTION_RAD.

    Not longer than leaves ENOUGH stretches, whose spread shows the errors of a model that are the
    same all along one, unless the noise would then exceed COARSE_RAD.
    """
    usual_m = USUAL_BY_TREADS_M if of.turns_rad is None else USUAL_M
    share_m = of.travel_m.sum() / ENOUGH
    for_noise_m = LINE * noise.position_m / np.array([DIRECTION_RAD, COARSE_RAD])
    wanted_m = min(for_noise_m[0], max(for_noise_m[1], share_m))
    return float(np.clip(wanted_m, np.clip(share_m, LEAST_M, usual_m), MOST_M))
