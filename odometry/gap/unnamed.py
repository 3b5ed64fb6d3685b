"""What no name explains: smooth functions of what was recorded, added in turn while they pay."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.effects.history import History
from odometry.effects.residual import Residual, ResidualOfEachRun
from odometry.effects.time_course import InBursts
from odometry.gap.burst_variable import variable_of_events
from odometry.gap.bursts import InCourse, burst_effects
from odometry.gap.contest import Judged, judge, penalty
from odometry.gap.course import best_course
from odometry.gap.explanation import Explanation
from odometry.gap.fit import Fitted, Fitter
from odometry.gap.general import general_candidates, single_candidates
from odometry.gap.measured import at_fewer_poses
from odometry.gap.own_values import with_values_of_each_run
from odometry.gap.search import Search
from odometry.gap.verdict import come_by_themselves, leaves_noise

POSES = 10  # of a window, where smooth functions are chosen
PROMISING = 2  # of them that are fitted in full at most
MOST_BURSTS = 2  # effects: each tread may have its own


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
    for effect in found.effects if reason else ():
        search.refuse(effect, reason)
    return nothing if reason else found


def _follow_a_variable(search: Search, found: Explanation) -> str:
    """Why events are none that come by themselves, of the first effect of which it is so."""
    scenes, base = search.fitter.measured.scenes, search.fitter.calibration.base
    for effect in found.effects:
        if isinstance(effect, InCourse) and isinstance(effect.in_time, InBursts):
            told = variable_of_events(effect.in_time, scenes, base)
            reason = come_by_themselves(*told, search.config)
            if reason:
                return reason
    return ""


def grown(search: Search, found: Explanation) -> Explanation:
    """Smooth functions alone, each of one variable, the best first."""
    fitter, config = search.fitter, search.config
    scenes, base = fitter.measured.scenes, fitter.calibration.base
    candidates = (
        *single_candidates(scenes, base, config),
        *general_candidates(scenes, base, config),
    )
    coarse = Fitter(fitter.calibration, at_fewer_poses(fitter.measured, fitter.calibration, POSES))
    found = replace(found, steps=())
    while len(found.steps) < config.most_smooth and search.has_excess(found.fitted):
        taken = {effect.key for effect in found.effects}
        left = [one for one in candidates if one.key not in taken]
        best = _first_earner(search, found.fitted, _most_promising(coarse, found.fitted, left))
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


def _most_promising(
    coarse: Fitter, before: Fitted, candidates: Sequence[Residual]
) -> list[Residual]:
    losses = coarse.linear_losses(before, candidates)
    paid = penalty(1, before) * max(1.0, coarse.spread_of(before))
    costs = losses + paid * np.array([len(one.terms) for one in candidates])
    return [candidates[place] for place in np.argsort(costs, kind="stable")[:PROMISING]]


def last_of_each_run(search: Search, found: Explanation) -> Explanation | None:
    """The same with coefficients of the last smooth function that are each run's own.

    None where they are already, and for weights of earlier speeds, which all runs share.
    """
    last = found.fitted.effects[-1]
    if not isinstance(last.effect, Residual) or isinstance(
        last.effect, ResidualOfEachRun | History
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
