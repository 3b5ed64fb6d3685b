"""What no name explains: smooth functions of what was recorded, added in turn while they pay."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.stats import binom
from sklearn.metrics import roc_auc_score

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.time_course import InBursts
from odometry.effects.unknown.history import History
from odometry.effects.unknown.residual import ANGLES, OF_TREADS, Residual, variables_of
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun
from odometry.effects.unknown.residual_of_place import ResidualOfPlace
from odometry.gap.fit.bursts import InCourse, burst_effects
from odometry.gap.fit.contest import Judged, judge, penalty
from odometry.gap.fit.course import best_course
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.fit.own_values import with_values_of_each_run
from odometry.gap.name.events_at_places import chance_of_places
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form import slow_course_instead
from odometry.gap.name.search import Search
from odometry.gap.name.verdict import come_anywhere, come_by_themselves, leaves_noise
from odometry.gap.prepare.measured import at_fewer_poses
from odometry.windows.dense.dense import DenseWindows

POSES = 10  # of a window, where smooth functions are chosen
MOST_BURSTS = 2  # effects: each tread may have its own

BY_CHANCE = 0.001  # probability of as many events on one terrain


def in_bursts(search: Search, found: Explanation) -> Explanation:
    """Effects in bursts alone, added in turn while they earn a name.

    No steps where none does, or where they leave what is not noise and do not close nearly all: as
    many events as it takes close much of anything.
    """
    nothing = found = replace(found, steps=())
    while len(found.steps) < MOST_BURSTS and search.has_excess(found.fitted):
        taken = {effect.key for effect in found.effects}
        offered = burst_effects(search.fitter, found.fitted)
        left = [one for one in offered if one.key not in taken]
        judged = judge(search.fitter, found.fitted, left, search.config, search.progress)
        best = search.best_earner(judged, found.fitted)
        if best is None:
            break
        contests = {**found.contests, best.effect.name: tuple(judged)}
        found = replace(found.with_step(best), contests=contests)
    excess = max(nothing.fitted.cost - search.fitter.measured.expected, 1.0)
    closed = (nothing.fitted.cost - found.fitted.cost) / excess
    spread = search.fitter.spread(found.fitted)
    reason = leaves_noise(spread, closed, search.config.left_over, search.config.bursts_closed)
    reason = reason or _follow_a_variable(search, found)
    if found.steps and not reason:
        reason = slow_course_instead(search, nothing.fitted, found.fitted)
    for effect in found.effects if reason else ():
        search.refuse(effect, reason)
    return nothing if reason else found


def _follow_a_variable(search: Search, found: Explanation) -> str:
    """Why events are none that come by themselves, of the first effect of which it is so."""
    scenes, base = search.fitter.measured.scenes, search.fitter.calibration.base
    for effect in found.effects:
        if isinstance(effect, InCourse) and isinstance(effect.in_time, InBursts):
            followed = variable_of_events(effect.in_time, scenes, base)
            reason = come_by_themselves(*followed, search.config) or come_anywhere(
                chance_of_places(effect.in_time, scenes, search.config), search.config
            )
            if reason:
                return reason
    return ""


def grown(search: Search, found: Explanation) -> Explanation:
    """Smooth functions alone, each of one variable, the best first."""
    return grown_of(search, found, search.small_functions, search.config.promising)


def grown_of(
    search: Search, found: Explanation, candidates: Sequence[Residual], promising_at_most: int
) -> Explanation:
    """The same of some smooth functions, of which so many are fitted in full while none pays."""
    fitter, config = search.fitter, search.config
    coarse = Fitter(fitter.calibration, at_fewer_poses(fitter.measured, fitter.calibration, POSES))
    found = replace(found, steps=())
    while len(found.steps) < config.most_smooth and search.has_excess(found.fitted):
        taken = {effect.key for effect in found.effects}
        left = [one for one in candidates if one.key not in taken]
        promising = _most_promising_first(coarse, found.fitted, left)[:promising_at_most]
        best = _first_earner(search, found.fitted, promising)
        if best is None:
            break
        found = found.with_step(best)
    return found


def _first_earner(search: Search, before: Fitted, candidates: Sequence[Residual]) -> Judged | None:
    """The first of some that earns its place: in full, they seldom change their order."""
    for one in candidates:
        judged = judge(search.fitter, before, [one], search.config, search.progress)
        best = search.best_earner(judged, before)
        if best is not None:
            return best
    return None


def _most_promising_first(
    coarse: Fitter, before: Fitted, candidates: Sequence[Residual]
) -> list[Residual]:
    losses = coarse.linear_losses(before, candidates)
    paid = penalty(1, before) * max(1.0, coarse.spread_of(before))
    costs = losses + paid * np.array([len(one.terms) for one in candidates])
    return [candidates[place] for place in np.argsort(costs, kind="stable")]


def last_of_each_run(search: Search, found: Explanation) -> Explanation | None:
    """The same with coefficients of the last smooth function that are each run's own.

    None where they are already, and for weights of earlier speeds, which all runs share.
    """
    last = found.fitted.effects[-1]
    if not isinstance(last.effect, Residual) or isinstance(
        last.effect, ResidualOfEachRun | ResidualOfPlace | History
    ):
        return None
    before = found.less_last().fitted
    size = float(np.sqrt(np.mean(last.values**2)))
    plain = last.effect
    own = ResidualOfEachRun(
        plain.variable,
        plain.terms,
        plain.by,
        plain.knots,
        runs=len(search.fitter.measured.scenes),
        spread=size,
    )
    fit = with_values_of_each_run(search.fitter, before, own)
    step = replace(found.steps[-1], effect=own, fitted=fit)
    return found.less_last().with_step(step)


def with_course(search: Search, found: Explanation) -> Explanation:
    """And a course in run time, each run's own, if it pays."""
    if not search.has_excess(found.fitted):
        return found
    best: Judged | None = best_course(search.fitter, found.fitted, search.held_out, search.config)
    if best is None or not search.pays(best, found.fitted):
        return found
    return found.with_step(best)


def variable_of_events(
    course: InBursts, scenes: Sequence[DenseWindows], base: Base
) -> tuple[str, float]:
    """The variable that predicts best when the events are, and how well.

    Parameters
    ----------
    course : InBursts
        With an event or more that is not all of the runs.
    scenes : sequence of DenseWindows
        The runs of the events.
    base : Base
        Its twist gives the variables that were simulated.

    Returns
    -------
    name : str
    area : float
        Under the receiver operating characteristic of "the variable, or its size, is large" or
        "is small", by time: 0.5 to 1; 0.5 predicts nothing.
    """
    inside = np.concatenate([course.share(np.empty(0), one.inputs) for one in scenes]) > 0.5
    steps_s = np.concatenate([one.steps_s for one in scenes])
    if inside.all() or not inside.any():
        return "", 0.5
    areas = [(_area(inside, v, steps_s), name) for name, v in _variables(scenes, base)]
    areas.append((_area_of_terrain(course, scenes), "terrain"))
    area, name = max(areas, key=lambda one: one[0])
    return name, area


def _variables(scenes: Sequence[DenseWindows], base: Base) -> Iterator[tuple[str, FloatArray]]:
    """Of all runs (N,), where all have them; of each tread by itself; with sign and without.

    Angles are periodic: neither large nor small has a meaning.
    """
    of_scenes = [variables_of(s.inputs, base.model.twist(base.values, s.inputs)) for s in scenes]
    for name in of_scenes[0]:
        if name in ANGLES or not all(name in other for other in of_scenes):
            continue
        values = np.concatenate([of[name] for of in of_scenes])
        for each in values.T if name in OF_TREADS else (values,):
            yield from ((name, each), (name, np.abs(each)))


def _area_of_terrain(course: InBursts, scenes: Sequence[DenseWindows]) -> float:
    """0.5 + half the share of events on one terrain, less the share of time on it; 0.5 by chance.

    It says where events may be, not that there is one all the time.
    """
    events, times = [], []
    for spans, scene in zip(course.events_s, scenes, strict=False):
        if scene.inputs.terrain is None:
            return 0.5
        labels = np.asarray(scene.inputs.terrain).astype(str)
        at = np.searchsorted(scene.time_s, [sum(span) / 2 for span in spans], side="right") - 1
        events.append(labels[np.maximum(at, 0)])
        times.append(labels)
    happened, everywhere = np.concatenate(events), np.concatenate(times)
    steps_s = np.concatenate([scene.steps_s for scene in scenes[: len(times)]])
    areas = [0.5]
    for terrain in np.unique(everywhere):
        of_time = float(steps_s[everywhere == terrain].sum() / steps_s.sum())
        count = int(np.count_nonzero(happened == terrain))
        if of_time < 1 and binom.sf(count - 1, len(happened), of_time) < BY_CHANCE:
            areas.append(0.5 + (count / len(happened) - of_time) / (1 - of_time) / 2)
    return max(areas)


def _area(inside: BoolArray, values: FloatArray, steps_s: FloatArray) -> float:
    area = float(roc_auc_score(inside, values, sample_weight=steps_s))
    return max(area, 1.0 - area)
