"""Coefficients of smooth functions that are each run's own, by damped least squares."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.effects.chain import Chain
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.time_course import run_numbers
from odometry.effects.measurement.map_fault import OfEachRun
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.measured import with_fewer_poses
from odometry.gap.prepare.responses import Responses, columns_of, simulated_scenes, whitened
from odometry.gap.prepare.simulate import whitened_residuals
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import whitening

OWN = (ResidualOfEachRun, OfEachRun)
ROUNDS = 2  # of linearising the motion: what is added is small
POSES = 10  # of a window of a run that is held out
PARITIES = 2  # windows by turns: what a run shows by its own holds for its neighbours


def damped(jacobian: FloatArray, rows: FloatArray, spread: float) -> FloatArray:
    """Coefficients (P,) of least squares, with so large a standard deviation about zero."""
    normal = jacobian.T @ jacobian
    return np.asarray(-np.linalg.solve(normal + _prior(normal, spread), jacobian.T @ rows))


def _prior(normal: FloatArray, spread: float) -> FloatArray:
    return np.eye(len(normal)) / spread**2


def with_values_of_each_run(fitter: Fitter, before: Fitted, effect: ResidualOfEachRun) -> Fitted:
    """A fit and one smooth function more, whose coefficients are each run's own; all else stays.

    Its residuals on held-out windows are found in turn: of each window by a fit to its neighbours.
    """
    measured = fitter.measured
    simulated = simulated_scenes(before.base, before.effects, measured.scenes)
    jacobian = columns_of(effect, simulated, measured.whiteners)
    values = np.zeros(len(effect.parameters))
    for _ in range(ROUNDS):
        effects = (*before.effects, Added(effect, values))
        rows = measured.rows(before.base, effects)
        values = damped(jacobian, rows - jacobian @ values, effect.spread)
    effects = (*before.effects, Added(effect, values))
    rows = measured.rows(before.base, effects)
    information = jacobian.T @ jacobian + np.eye(len(values)) / effect.spread**2
    own, others = np.linalg.inv(information), before.covariance
    covariance = np.zeros((len(own) + len(others),) * 2)
    covariance[: len(others), : len(others)] = others
    covariance[len(others) :, len(others) :] = own
    linear = rows - jacobian @ values
    parity = np.asarray(measured.window_of_row % PARITIES)
    return replace(
        before,
        effects=effects,
        covariance=covariance,
        chi_squared=measured.by_window(rows),
        held_out=measured.by_window(by_turns(jacobian, linear, [effect.spread], parity)[0]),
    )


def by_turns(
    jacobian: FloatArray, rows: FloatArray, spreads: Sequence[float], turn: IntArray
) -> FloatArray:
    """Rows (S, R) that damped least squares leave, each by a fit to those of the other turn.

    Of each of the spreads (S) of coefficients.
    """
    left = np.empty((len(spreads), len(rows)))
    for one in range(PARITIES):
        own = turn == one
        others = jacobian[~own]
        normal, gradient = others.T @ others, others.T @ rows[~own]
        values = [np.linalg.solve(normal + _prior(normal, s), -gradient) for s in spreads]
        left[:, own] = rows[own] + (jacobian[own] @ np.stack(values, axis=-1)).T
    return left


def with_values_of_run(
    base: Base,
    effects: Sequence[Added],
    scene: DenseWindows,
    calibration: Calibration,
) -> list[Added]:
    """Effects that know coefficients of one run more, the windows of which are given."""
    scene = with_fewer_poses(scene, POSES)
    whiteners = whitening(scene, calibration.noise)
    extended = [_with_run(one) for one in effects]
    places = [i for i, one in enumerate(extended) if isinstance(one.effect, OWN)]
    for _ in range(ROUNDS):
        for place in places:
            extended[place] = _solved(base, extended, place, scene, whiteners)
    return extended


def is_course(added: Added) -> bool:
    """Whether an effect follows run time in each run by its own: its neighbours alone know it."""
    return isinstance(added.effect, ResidualOfEachRun) and added.effect.variable == "time"


def with_courses_of_run(
    base: Base, effects: Sequence[Added], scene: DenseWindows, calibration: Calibration
) -> list[Added]:
    """Effects with the courses of a run that they know already found anew on the windows given."""
    scene = with_fewer_poses(scene, POSES)
    whiteners = whitening(scene, calibration.noise)
    found = list(effects)
    places = [place for place, one in enumerate(found) if is_course(one)]
    for _ in range(ROUNDS):
        for place in places:
            found[place] = _with_course(base, found, place, scene, whiteners)
    return found


def _solved(
    base: Base, effects: Sequence[Added], place: int, scene: DenseWindows, whiteners: FloatArray
) -> Added:
    """The effect at a place with the coefficients of its last run that fit a scene best."""
    added = effects[place]
    effect = added.effect
    if isinstance(effect, OfEachRun):
        return _solved_fault(base, effects, place, scene, whiteners)
    if not isinstance(effect, ResidualOfEachRun):
        return added
    return _with_course(base, effects, place, scene, whiteners)


def _with_course(
    base: Base, effects: Sequence[Added], place: int, scene: DenseWindows, whiteners: FloatArray
) -> Added:
    """A smooth function of each run with the coefficients of the scene's run that fit it best."""
    effect, values = effects[place].effect, effects[place].values.copy()
    if not isinstance(effect, ResidualOfEachRun):
        return effects[place]
    count, number = len(effect.terms), int(run_numbers(scene.inputs)[0])
    own = slice(number * count, (number + 1) * count)
    before = Chain(base, effects[:place], scene.inputs)
    changes = effect.columns(before.twist, before.inputs, base)[own]
    jacobian = whitened(whiteners, Responses(base, effects, scene).of(changes))
    rows = whitened_residuals(base, effects, [scene], [whiteners])
    values[own] = damped(jacobian, rows - jacobian @ values[own], effect.spread)
    return Added(effect, values)


def _with_run(added: Added) -> Added:
    """An effect that knows one run more, which has none of it yet."""
    if not isinstance(added.effect, OWN):
        return added
    effect = added.effect.with_run()
    more = len(effect.parameters) - len(added.values)
    return Added(effect, np.append(added.values, np.zeros(more)))


def _solved_fault(
    base: Base, effects: Sequence[Added], place: int, scene: DenseWindows, whiteners: FloatArray
) -> Added:
    """A fault of the reference with the values of its last run that fit a scene best.

    Its error is linear in them: by differences, within their bounds.
    """
    added = effects[place]
    effect = added.effect
    if not isinstance(effect, OfEachRun):
        return added
    free = effect.own

    def rows(values: FloatArray) -> FloatArray:
        there = Added(effect, np.append(added.values[: -len(free)], values))
        of_scene = [*effects[:place], there, *effects[place + 1 :]]
        return whitened_residuals(base, of_scene, [scene], [whiteners])

    at = added.values[-len(free) :]
    here = rows(at)
    scales = np.array([parameter.scale for parameter in free])
    jacobian = np.stack([rows(at + step) - here for step in np.diag(scales)], axis=-1)
    moved = at - scales * np.linalg.lstsq(jacobian, here, rcond=None)[0]
    lows, highs = np.array([(parameter.low, parameter.high) for parameter in free]).T
    return Added(effect, np.append(added.values[: -len(free)], np.clip(moved, lows, highs)))
