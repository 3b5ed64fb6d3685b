"""Effects that come and go in bursts: events of each run, by dynamic programming.

Each step between poses some tenths of a second apart is explained with the effect or without, and
each event pays for its begin and its end: of all ways to lay events, the one of least cost is
found exactly (Viterbi 1967, IEEE Trans. Inf. Theory 13(2), of two states).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.commands.tread_slip import SlipOfLeftTread, SlipOfRightTread
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.base import Effect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import CommandsInCourse, MotionInCourse, in_course
from odometry.effects.interface.time_course import InBursts, Spans, run_numbers
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.measured import with_fewer_poses
from odometry.gap.prepare.simulate import all_residuals_of_each
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import whitening

InCourse = CommandsInCourse | MotionInCourse
STEPS = 8  # of a window: a quarter of a second of two
STRENGTHS = (0.35, 0.6, 0.8)  # from which the search begins
LOSING: tuple[tuple[Effect, tuple[float, float]], ...] = (  # and which treads lose
    (TractionLoss(), (1.0, 1.0)),
    (SlipOfLeftTread(), (1.0, 0.0)),
    (SlipOfRightTread(), (0.0, 1.0)),
)
ROUNDS = 3  # of events and strength in turn
TRIED = np.linspace(0.0, 0.98, 50)
PARTS = 5  # of these: strengths of one are simulated at once
LONGEST_SHARE = 0.6  # of the time: what is there for longer is no burst


def burst_effects(fitter: Fitter, before: Fitted) -> tuple[Effect, ...]:
    """Traction lost in bursts, and slip of one tread: each with the events that fit it best."""
    found: list[Effect] = []
    for inner, sides in LOSING:
        events = tuple(
            _best_events(scene, fitter.calibration, before, sides)
            for scene in fitter.measured.scenes
        )
        if any(events):
            found.append(in_course(inner, InBursts(events)))
    return tuple(found)


def _best_events(
    scene: DenseWindows, calibration: Calibration, before: Fitted, sides: tuple[float, float]
) -> Spans:
    """Events of a run, with their strength."""
    steps = _steps(with_fewer_poses(scene, STEPS))
    if not len(steps):
        return ()
    whiteners = whitening(steps, calibration.noise)
    without = _costs(before.base, before.effects, steps, whiteners)
    by_strength = [
        costs
        for tried in np.array_split(TRIED, PARTS)
        for costs in _costs_of_each(
            [(before.base, (*before.effects, _slowed(kept, sides))) for kept in tried],
            steps,
            whiteners,
        )
    ]
    best: tuple[float, Spans] = (float(without.sum()), ())
    for start in STRENGTHS:
        place = int(np.argmin(np.abs(TRIED - start)))
        for _ in range(ROUNDS):
            on = states(without, by_strength[place])
            if not on.any() or on.mean() > LONGEST_SHARE:
                break
            place = int(np.argmin([costs[on].sum() for costs in by_strength]))
        cost = float(np.where(on, by_strength[place], without).sum()) + _paid(on)
        if on.any() and on.mean() <= LONGEST_SHARE and cost < best[0]:
            best = (cost, _spans(on, steps))
    return best[1]


def with_events_of_run(
    base: Base, effects: Sequence[Added], scene: DenseWindows, calibration: Calibration
) -> list[Added]:
    """Effects that know the events of one run more, as strong as they are.

    By the poses within its windows: the first and the last, by which the gap is evaluated, are not
    used.
    """
    steps = _steps(_within(with_fewer_poses(scene, STEPS)))
    extended = list(effects)
    if not len(steps):
        return extended
    whiteners = whitening(steps, calibration.noise)
    for place, added in enumerate(effects):
        effect = added.effect
        if not isinstance(effect, InCourse) or not isinstance(effect.in_time, InBursts):
            continue
        always = [*extended[:place], Added(effect.inner, added.values), *extended[place + 1 :]]
        without = _costs(base, [*extended[:place], *extended[place + 1 :]], steps, whiteners)
        events = _spans(states(without, _costs(base, always, steps, whiteners)), steps)
        course = effect.in_time.with_events(events, int(run_numbers(scene.inputs)[0]))
        extended[place] = Added(in_course(effect.inner, course), added.values)
    return extended


def is_in_bursts(effect: Effect) -> bool:
    """Whether it has events of each run."""
    return isinstance(effect, InCourse) and isinstance(effect.in_time, InBursts)


def states(without: FloatArray, within: FloatArray) -> BoolArray:
    """Whether each step (S,) is in an event, of the least cost of all.

    Parameters
    ----------
    without, within : (S,)
        Chi-squared of each step without the effect and with it.
    """
    turn = float(np.log(len(without)))  # of a begin or an end
    cost, came = np.array([0.0, turn]), np.zeros((len(without), 2), dtype=np.int64)
    for row, of in enumerate(zip(without, within, strict=True)):
        changed = cost[::-1] + turn
        came[row] = np.where(changed < cost, [1, 0], [0, 1])
        cost = np.minimum(cost, changed) + of
    state = int(np.argmin(cost + turn * np.arange(2)))
    on = np.zeros(len(without), dtype=np.bool_)
    for row in range(len(without) - 1, -1, -1):
        on[row] = state == 1
        state = int(came[row, state])
    return on


def _paid(on: BoolArray) -> float:
    padded = np.concatenate([[False], on, [False]])
    return float(np.count_nonzero(padded[1:] != padded[:-1]) * np.log(len(on)))


def _slowed(kept: float, sides: tuple[float, float]) -> Added:
    return Added(WheelScale(), 1 - (1 - kept) * np.array(sides))


def _steps(scene: DenseWindows) -> DenseWindows:
    """Windows of two poses each: every step between neighbours of a scene's windows."""
    pairs = np.stack([scene.windows[:, :-1].ravel(), scene.windows[:, 1:].ravel()], axis=-1)
    return replace(scene, windows=pairs[pairs[:, 0] < pairs[:, 1]])


def _within(scene: DenseWindows) -> DenseWindows:
    """The windows without their first and last pose, each on to the begin of the next one."""
    inner = scene.windows[:, 1:-1]
    follows = np.append(scene.windows[1:, 0] == scene.windows[:-1, -1], False)
    onward = np.where(follows, np.roll(inner[:, 0], -1), inner[:, -1])
    return replace(scene, windows=np.column_stack([inner, onward]))


def _costs(
    base: Base, effects: Sequence[Added], steps: DenseWindows, whiteners: FloatArray
) -> FloatArray:
    """Chi-squared (S,) of each step."""
    (costs,) = _costs_of_each([(base, effects)], steps, whiteners)
    return np.asarray(costs)


def _costs_of_each(
    models: Sequence[tuple[Base, Sequence[Added]]], steps: DenseWindows, whiteners: FloatArray
) -> FloatArray:
    """The same (C, S) of several models."""
    rows = np.einsum("sij,csj->csi", whiteners, all_residuals_of_each(models, steps))
    return np.asarray((rows**2).sum(axis=-1))


def _spans(on: BoolArray, steps: DenseWindows) -> Spans:
    """Begin and end of each event in run time."""
    padded = np.concatenate([[False], on, [False]])
    begins = np.flatnonzero(padded[1:] & ~padded[:-1])
    ends = np.flatnonzero(~padded[1:] & padded[:-1]) - 1
    begin_s, end_s = steps.pose_s[steps.windows[:, 0]], steps.pose_s[steps.windows[:, 1]]
    return tuple((float(begin_s[b]), float(end_s[e])) for b, e in zip(begins, ends, strict=True))
