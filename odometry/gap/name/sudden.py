"""Wheels of another size from a moment of each run on: a tyre that is lost, a track thrown off."""

from dataclasses import replace

from odometry.effects.in_course import in_course
from odometry.effects.time_course import FromAMoment
from odometry.effects.wheel_scale import WheelScale
from odometry.gap.fit.contest import judge
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
    spans = tuple(observed_s(scene) for scene in search.fitter.measured.scenes)
    wheels = in_course(WheelScale(), FromAMoment(spans))
    before = nothing.fitted
    judged = judge(search.fitter, before, [wheels], search.config, search.progress)
    best = search.best_earner(judged, before)
    if best is None:
        return nothing
    excess = max(before.cost - search.fitter.measured.expected, 1.0)
    closed = (before.cost - best.fitted.cost) / excess
    spread = search.fitter.spread(best.fitted)
    reason = leaves_noise(spread, closed, search.config.left_over, search.config.bursts_closed)
    values = best.fitted.effects[-1].values[: len(WheelScale().parameters)]
    reason = reason or no_wheel_grows(values, search.config)
    reason = reason or is_of_one_side(values, search.config)
    if reason:
        search.refuse(wheels, reason)
        return nothing
    contests = {**found.contests, wheels.name: tuple(judged)}
    return replace(nothing.with_step(best), contests=contests)
