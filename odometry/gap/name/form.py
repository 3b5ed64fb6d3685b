"""Whether names have the form of what they stand for.

A name that does not is beaten in its place by a smooth function of something, or fits each piece
of the runs with another strength.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.effects.interface.corrected import Added
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.measurement.sensor_mount import LeverArm
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.agreement import disagreement
from odometry.gap.fit.contest import cost_of, margin_of, penalty
from odometry.gap.fit.course import CHOSEN, best_course
from odometry.gap.fit.effect_values import essence_spans_none, is_meant
from odometry.gap.fit.evenness import unevenness
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.fit.input_noise import surely_dearer
from odometry.gap.fit.own_moments import with_own_moments
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form_gates import (
    is_abrupt,
    is_by_its_essence,
    is_even,
    is_most_of,
    is_of_stamps,
    is_one_to_all,
    is_special,
    is_sure_of_its_essence,
)
from odometry.gap.name.one_cause import is_more_than_one
from odometry.gap.name.search import Search
from odometry.gap.prepare.statistic import root_mean_square

WHOLE = 1.0  # of a motion, that an effect leaves where it does nothing
PART = 0.02  # of the squares of what a name does: less is left by a function that can do the same


def of_their_form(search: Search, found: Explanation, smooth: Sequence[Residual]) -> Explanation:
    """Without names that do not have it: with the function that does better in the place of one.

    What is left is tested again: a name may have passed by what another did. Without any step
    where no name is left.
    """
    alone = names_alone(search.fitter, found)
    names = [added.effect for added in alone.effects]
    if reason := is_more_than_one(search, alone, smooth):
        for name in names:
            search.refuse(name, reason)
        return replace(found, steps=())
    for place, effect in enumerate(names):
        instead = smooth_in_place(search, alone, place, smooth)
        reason = is_special(instead) or _of_no_form(search, found, alone, place)
        if not reason:
            continue
        search.refuse(effect, reason)
        if not instead and closes_without_essence(search.fitter, alone, place, search.config):
            search.without_essence.add(effect.name)
        others = [name for name in names if name is not effect]
        if not others:
            return replace(found, steps=())
        left = search.in_order(found, [*others, instead] if instead else others)
        return of_their_form(search, left, smooth)
    return found


def _of_no_form(search: Search, found: Explanation, alone: Fitted, place: int) -> str:
    """Why one of the names does not have the form of what it stands for, by itself."""
    added = alone.effects[place]
    of = unevenness(search.fitter, found.fitted, found.effects.index(added.effect))
    others = [one for one in alone.effects if one is not added]
    return (
        is_even(of, search.config)
        or is_meant(added)
        or _is_one_to_all(search, alone, place)
        or is_of_stamps(added, others, search.fitter.measured.scenes)
        or lacks_essence(search.fitter, alone, place, search.config)
        or slow_course_in_place(search, alone, place)
    )


def _is_one_to_all(search: Search, alone: Fitted, place: int) -> str:
    """Why measures of an effect disagree; forces of contacts are right and imperfect."""
    if alone.effects[place].effect.slow:
        return ""
    return is_one_to_all(disagreement(search.fitter, alone, place), search.config)


def lacks_essence(fitter: Fitter, fit: Fitted, place: int, config: GapConfig) -> str:
    """Why an effect is not by what makes it what it is: it closes as much without, or is unsure."""
    added = fit.effects[place]
    closed = closes_without_essence(fitter, fit, place, config)
    if closed or not added.effect.essential:
        return closed
    rise = fitter.rise_without(fit, place, added.effect.essential)
    in_spreads = rise / max(1.0, fitter.spread(fit))
    spans_none = essence_spans_none(fit, place)
    return is_sure_of_its_essence(added, in_spreads, config, spans_none=spans_none)


def closes_without_essence(fitter: Fitter, fit: Fitted, place: int, config: GapConfig) -> str:
    """Why an effect is not what makes it what it is: it closes as much without."""
    added = fit.effects[place]
    if not added.effect.essential:
        return ""
    return is_by_its_essence(without_essence(fitter, fit, place), added, config)


def without_essence(fitter: Fitter, fit: Fitted, place: int) -> float:
    """Share of what an effect closes that it closes without its essential parameters."""
    added = fit.effects[place]
    absent = [
        float(value if p.absent is None or p.name not in added.effect.essential else p.absent)
        for p, value in zip(added.effect.parameters, added.values, strict=True)
    ]
    around = fit.effects[:place], fit.effects[place + 1 :]
    tried = ((added,), (Added(added.effect, np.array(absent)),), ())
    whole, without, none = (
        float(np.sum(fitter.measured.rows(fit.base, (*around[0], *one, *around[1])) ** 2))
        for one in tried
    )
    return (none - without) / (none - whole)


def slow_course_in_place(search: Search, names: Fitted, place: int) -> str:
    """Why a name has no moment: the same freedom in time, without one, explains more."""
    if names.effects[place].effect.course != FromAMoment.name:
        return ""
    others = [*names.effects[:place], *names.effects[place + 1 :]]
    return slow_course_instead(search, _fit(search.fitter, others), names)


def slow_course_instead(search: Search, before: Fitted, names: Fitted) -> str:
    """Why names that come at once, added to what was before, are none: a slow course does more."""
    course = best_course(search.fitter, before, search.held_out, search.config)
    if course is None:
        return ""
    spread = search.fitter.spread(course.fitted)
    closed = cost_of(before) - cost_of(names)
    of_course = course.fitted.cost + penalty(before.freedom + CHOSEN, before)
    return is_abrupt(of_course, cost_of(names), margin_of(search.config, spread, closed))


def names_alone(fitter: Fitter, found: Explanation) -> Fitted:
    """Fitted without smooth functions, contact forces anew: beside these they had other values."""
    effects = found.fitted.effects
    names = [one for one in effects if not isinstance(one.effect, Residual)]
    if len(names) == len(effects):
        return found.fitted
    return fitter.fit([one.effect for one in names], names)


def smooth_in_place(
    search: Search, names: Fitted, place: int, smooth: Sequence[Residual]
) -> Residual | None:
    """The smooth function that takes the place of one name with more evidence.

    None where no function beats the name by the margin, or where the name still closes its share
    beside the best: then the function describes something else. Nor where the function closes less
    than the name on held-out data, and the name is one of contact forces, whose equations are right
    and imperfect, or leaves nothing but noise.
    """
    fitter, config = search.fitter, search.config
    others = [*names.effects[:place], *names.effects[place + 1 :]]
    before = _fit(fitter, others)
    losses = fitter.linear_losses(before, smooth)
    promising = np.argsort(losses, kind="stable")[: config.promising_in_place]
    most = names.cost + config.beyond_first_order * (before.cost - names.cost)
    fits = {
        smooth[i]: fitter.fit([*(one.effect for one in others), smooth[i]], others, pin_slow=True)
        for i in promising
        if losses[i] < most
    }
    if not fits:
        return None
    best = min(fits, key=lambda function: cost_of(fits[function]))
    cost = cost_of(fits[best])
    closed = cost_of(before) - cost_of(names)
    margin = margin_of(config, fitter.spread(fits[best]), closed)
    if surely_dearer(names, fits[best], fitter.measured) < margin:
        return None
    may_lose = names.effects[place].effect.slow or fitter.spread(names) <= config.unexplained
    if may_lose and closes_less(search, fits[best], names):
        return None
    is_main_part = is_most_of(closed, cost_of(before) - cost, config)
    if is_main_part and is_part_of(fitter, names, place, fits[best]):
        return None
    both = _fit(fitter, [*fits[best].effects, names.effects[place]])
    still = (cost - cost_of(both)) / closed
    return best if still < config.least_beside else None


def is_part_of(fitter: Fitter, names: Fitted, place: int, instead: Fitted) -> bool:
    """Whether a name is constant shares of a motion, as the last function of a fit may be.

    Of a tread, or of the turn: another place of the sensor or of the centre of rotation.
    """
    effect = names.effects[place].effect
    of_turn = isinstance(effect, LateralSkid | LeverArm)
    if not of_turn and not all(p.absent == WHOLE for p in effect.parameters):
        return False
    others = (*names.effects[:place], *names.effects[place + 1 :])
    done = fitter.measured.rows(names.base, names.effects)
    done = done - fitter.measured.rows(names.base, others)
    function = instead.effects[-1]
    columns = fitter.design(instead).jacobian[: len(done), -len(function.values) :]
    left = done - columns @ np.linalg.lstsq(columns, done, rcond=None)[0]
    return bool(left @ left < PART * (done @ done))


def closes_less(search: Search, one: Fitted, other: Fitted) -> bool:
    """Whether one fit leaves more of the gap on held-out data than another."""
    fitted, believed = search.fitter.measured.scenes, search.fitter.calibration
    gaps = []
    for fit in (one, other):
        of_runs = with_own_moments(fit.base, fit.effects, search.held_out, fitted, believed)
        gaps.append(root_mean_square(fit.base, *of_runs, search.floor.measure))
    return gaps[0] > gaps[1]


def _fit(fitter: Fitter, effects: Sequence[Added]) -> Fitted:
    return fitter.fit([one.effect for one in effects], effects, pin_slow=True)
