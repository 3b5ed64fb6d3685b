"""Effects on held-out runs, where each run has its own moment or values."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import CommandsInCourse, MotionInCourse, in_course
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.measurement.reference_step import ReferenceStep
from odometry.gap.fit.bursts import is_in_bursts, with_events_of_run
from odometry.gap.fit.own_steps import with_step_of_run
from odometry.gap.fit.own_values import (
    OWN,
    is_course,
    with_courses_of_run,
    with_values_of_run,
)
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.statistic import squared_errors
from odometry.windows.dense.dense import DenseWindows

SPACING_S = 1.0  # of the moments that are searched
BEFORE = 0.05  # of the way of a run: what begins earlier cannot be told from what is always there
TIED = 1e-9  # share: losses nearer than this are equal, so that rounding does not choose a moment
InCourse = CommandsInCourse | MotionInCourse


def observed_s(scene: DenseWindows) -> tuple[float, float]:
    """When the first window has ended and enough way is driven, and when the last one begins."""
    begin_m, end_m = scene.travel_m[[0, -1]]
    driven_s = np.interp(begin_m + BEFORE * (end_m - begin_m), scene.travel_m, scene.time_s)
    ended_s = scene.pose_s[scene.windows[:, -1]].min()
    return float(max(ended_s, driven_s)), float(scene.start_s.max())


def with_own_moments(
    base: Base,
    effects: Sequence[Added],
    held_out: Sequence[DenseWindows],
    fitted: Sequence[DenseWindows],
    calibration: Calibration,
) -> tuple[tuple[Added, ...], list[DenseWindows]]:
    """Effects with each held-out run's own values, and the windows to evaluate them on.

    A moment, and coefficients, are searched on every other window of a run, and evaluated on the
    rest. Pieces of the fitted runs themselves know theirs, and are judged whole, as all are where
    nothing is a run's own. But a course in run time is known only where there are windows: that
    of a fitted run is found on its windows and on every other one of its pieces. Events of a burst
    are searched on the poses within the windows, and evaluated by those at their ends.
    """
    for scene in held_out if any(is_in_bursts(one.effect) for one in effects) else ():
        effects = with_events_of_run(base, effects, scene, calibration)
    known = {scene.run.folder: scene for scene in fitted}
    others = [scene for scene in held_out if scene.run.folder not in known]
    begins = [place for place, one in enumerate(effects) if _begins(one)]
    steps = [i for i, one in enumerate(effects) if isinstance(one.effect, ReferenceStep)]
    own = any(isinstance(one.effect, OWN) for one in effects)
    courses = any(is_course(one) for one in effects)
    if not courses and (not (begins or steps or own) or not others):
        return tuple(effects), list(held_out)
    extended, judged = list(effects), []
    for scene in (scene for scene in held_out if scene.run.folder in known):
        turn = np.arange(len(scene)) % 2 == 1
        if courses:
            of_run = known[scene.run.folder]
            shown = replace(of_run, windows=np.vstack([of_run.windows, scene.windows[turn]]))
            extended = with_courses_of_run(base, extended, shown, calibration)
        judged.append(scene.where(~turn) if courses else scene)
    for scene in others:
        odd = np.arange(len(scene)) % 2 == 1
        for place in begins:
            extended = _with_moment(base, extended, place, scene.where(odd))
        for place in steps:
            extended = with_step_of_run(base, extended, place, scene.where(odd))
        if own:
            extended = with_values_of_run(base, extended, scene.where(odd), calibration)
    for number, scene in enumerate(others, start=-len(others)):
        moments_s = [extended[place].values[number] for place in begins]
        moments_s += [moment_of(extended[place], number) for place in steps]
        judged.append(scene.where(_judges(scene, moments_s)))
    return tuple(extended), [scene for scene in judged if len(scene)]


def _judges(scene: DenseWindows, moments_s: Sequence[float]) -> BoolArray:
    """Every other window (K,), but none in which a moment may lie: no other knows it so well."""
    begin_s, end_s = scene.pose_s[scene.windows[:, [0, -1]]].T
    judges = np.arange(len(scene)) % 2 == 0
    for moment_s in moments_s:
        near_s = end_s - begin_s
        judges &= (moment_s < begin_s - near_s) | (moment_s > end_s + near_s)
    return np.asarray(judges)


def moment_of(added: Added, run: int) -> float:
    """When a step of the reference is, of one run; negative numbers count from the last."""
    effect = added.effect
    return effect.moment_s(added.values, run) if isinstance(effect, ReferenceStep) else np.inf


def _begins(added: Added) -> bool:
    return isinstance(added.effect, InCourse) and isinstance(added.effect.in_time, FromAMoment)


def _with_moment(base: Base, effects: list[Added], place: int, scene: DenseWindows) -> list[Added]:
    """The effects, of which one begins in one run more, where that closes most; or never."""
    added = effects[place]
    if not isinstance(added.effect, InCourse) or not isinstance(added.effect.in_time, FromAMoment):
        return effects
    span = observed_s(scene)
    course = FromAMoment((*added.effect.in_time.observed_s, span))
    effect = in_course(added.effect.inner, course)
    tried = [*np.arange(span[0], span[1], SPACING_S), span[1] + 1.0]

    def at(moment_s: float) -> list[Added]:
        one = Added(effect, np.append(added.values, moment_s))
        return [*effects[:place], one, *effects[place + 1 :]]

    losses = np.array([squared_errors(base, at(m), scene).sum() for m in tried])
    return at(float(tried[int(np.argmax(losses <= (1.0 + TIED) * losses.min()))]))
