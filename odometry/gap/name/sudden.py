"""Wheels of another size from a moment of each run on: a tyre that is lost, a track thrown off."""

from dataclasses import replace

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.base import Effect
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment, Gradual
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged, judge
from odometry.gap.fit.own_moments import observed_s
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form_gates import is_of_one_side, no_wheel_grows
from odometry.gap.name.search import Search
from odometry.gap.name.verdict import leaves_noise


def sudden_wheels(search: Search, found: Explanation) -> Explanation:
    """Other wheels from a moment on alone, where nothing that lasts has a name.

    No steps where they do not earn it, or leave what is not noise and do not close nearly all: what
    comes slowly or with the place is closed in good part by one moment, too.
    """
    nothing = replace(found, steps=())
    if not search.has_excess(nothing.fitted):
        return nothing
    wheels = _wheels_from_a_moment(search)
    before = nothing.fitted
    judged = judge(search.fitter, before, [wheels], search.config, search.progress)
    best = search.best_earner(judged, before)
    if best is None:
        return nothing
    excess = max(before.cost - search.fitter.measured.expected, 1.0)
    closed = (before.cost - best.fitted.cost) / excess
    spread = search.fitter.spread(best.fitted)
    reason = leaves_noise(spread, closed, search.config.left_over, search.config.bursts_closed)
    reason = reason or _is_no_lost_tyre(best, search.config)
    if reason:
        search.refuse(wheels, reason)
        return nothing
    contests = {**found.contests, wheels.name: tuple(judged)}
    return replace(nothing.with_step(best), contests=contests)


def is_gradual_wheel_scale(effect: Effect) -> bool:
    """Whether wheels change their size over the whole run."""
    return (effect.name, effect.course) == (WheelScale.name, Gradual.name)


def sudden_instead(search: Search, found: Explanation) -> Explanation:
    """Names with wheels that change at a moment, in place of those that change slowly.

    Where that costs less: a ramp closes most of a step, and smooth functions beside it the rest.
    """
    others = [
        effect
        for effect in found.effects
        if not (isinstance(effect, Residual) or is_gradual_wheel_scale(effect))
    ]
    instead = search.in_order(found, [*others, _wheels_from_a_moment(search)])
    last = instead.steps[-1]
    if instead.cost >= found.cost or _is_no_lost_tyre(last, search.config):
        return found
    return replace(instead, contests={**found.contests, last.effect.name: (last,)})


def _wheels_from_a_moment(search: Search) -> Effect:
    spans = tuple(observed_s(scene) for scene in search.fitter.measured.scenes)
    return in_course(WheelScale(), FromAMoment(spans))


def _is_no_lost_tyre(one: Judged, config: GapConfig) -> str:
    values = one.fitted.effects[-1].values[: len(WheelScale().parameters)]
    return no_wheel_grows(values, config) or is_of_one_side(values, config)
