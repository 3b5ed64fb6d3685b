"""Which effects are missing: stepwise, beside smooth functions of all that was recorded."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from odometry.effects.interface.base import Effect
from odometry.effects.unknown.history import History
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import cost_of, margin_of
from odometry.gap.fit.effect_values import is_meant
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.input_noise import surely_dearer
from odometry.gap.name.accepted_effects import Standing
from odometry.gap.name.candidates import quick_effects
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form import closes_less, is_part_of, lacks_essence
from odometry.gap.name.form_gates import is_most_of
from odometry.gap.name.further import Further
from odometry.gap.name.general import general_candidates, shares_of_motion
from odometry.gap.name.search import Search
from odometry.gap.prepare.statistic import Gap, root_mean_square
from odometry.windows.dense.dense import DenseWindows

MANY = 5  # parameters of an effect that two others may share


def explained(
    fitter: Fitter,
    held_out: Sequence[DenseWindows],
    floors: tuple[Gap, Gap],
    config: GapConfig,
    progress: Callable[[], None],
) -> Explanation:
    """Name what is missing, where a name beats smooth functions and closes the gap elsewhere.

    The catalogue alone explains what it can. Then the best smooth function is added to that, and
    the catalogue to the best smooth function; what does not pay beside the others is left out.
    Of these explanations the one of least cost is taken; names go first where they lose by less
    than a margin. At last each is evaluated on held-out data. `floors` are those of the measured
    and of the held-out windows.
    """
    search = Further(fitter, fitter.fit([]), tuple(held_out), *floors, config, progress)
    scenes = fitter.measured.scenes
    quick = quick_effects(scenes, fitter.calibration)
    found = by_parts(search, by_fewer(search, search.stepwise(quick), quick), quick)
    found = of_names = simplest(search, found, quick)
    smooth = (*general_candidates(scenes, fitter.calibration.base, config), History())
    best = search.best_smooth(search.start, smooth, found.fitted.cost if found.steps else np.inf)
    rest = search.best_smooth(found.fitted, smooth) if found.steps else None
    options = [] if rest is None else [without_idle(search, found.with_step(rest))]
    if best is not None:
        names = [one.effect for one in found.first if one.evidence > config.least_evidence]
        alone = search.stepwise(names[: config.beside], replace(found, steps=(best,)))
        options.append(without_idle(search, alone))
    if options:
        found = _better(search, found, options)
    shares = shares_of_motion(scenes, fitter.calibration.base, config)
    stood = search.that_stand(_names_first(search, found), (*smooth, *shares))
    stood = _tried_again(search, of_names, stood, (*smooth, *shares))
    stood = _of_the_others(search, stood, quick, (*smooth, *shares))
    return search.further(_largest_first(search, stood))


def _tried_again(
    search: Standing, names: Explanation, stood: Explanation, smooth: Sequence[Residual]
) -> Explanation:
    """Names that a smooth function displaced, where that fell or closes less on held-out data.

    Those of contact forces alone: their equations are right and imperfect, so that a smooth
    function may cost less on the runs that it was fitted to.
    """
    by_contact = any(effect.slow for effect in names.effects)
    if not by_contact or stood.has_name:
        return stood
    again = search.that_stand(names, smooth)
    if not again.has_name:
        return stood
    return stood if closes_less(search, again.fitted, stood.fitted) else again


def _of_the_others(
    search: Standing, stood: Explanation, candidates: Sequence[Effect], smooth: Sequence[Residual]
) -> Explanation:
    """Names of the others, where one closed the same without what makes it that effect.

    A robot that turns less throughout is no curvature, and another set of ICRs.
    """
    if not search.without_essence or stood.has_name:
        return stood
    others = [one for one in candidates if one.name not in search.without_essence]
    again = by_parts(search, search.stepwise(others), others)
    again = search.that_stand(replace(again, first=stood.first), smooth)
    return again if again.has_name else stood


def _largest_first(search: Search, found: Explanation) -> Explanation:
    """Names in the order of the gap that comes back without each: the first is the verdict.

    Effects are added by evidence, which noise that one of them makes smaller raises as well.
    """
    names = [effect for effect in found.effects if not isinstance(effect, Residual)]
    if len(names) < 2 or len(names) < len(found.effects):
        return found
    without = {}
    for name in names:
        others = [effect for effect in names if effect is not name]
        fit = search.fitter.fit(others, found.fitted.effects)
        scenes, measure = search.fitter.measured.scenes, search.floor.measure
        without[name] = root_mean_square(fit.base, fit.effects, scenes, measure)
    order = sorted(names, key=lambda name: -without[name])
    if order == names:
        return found
    ordered = search.in_order(found, order)
    earns = ordered.steps[0].evidence > search.config.least_evidence
    return ordered if earns else found


def _better(search: Search, names: Explanation, others: Sequence[Explanation]) -> Explanation:
    """The explanation of least cost; names where they lose by less than the margin.

    Or where a name that is constant shares of a motion is the main part of a smooth function.
    """
    best = min(others, key=lambda one: one.cost)
    closed = cost_of(search.start) - names.cost
    margin = margin_of(search.config, search.spread_of(best), closed)
    if _is_its_main_part(search, names, best, closed):
        return names
    if names.steps and surely_dearer(names.fitted, best.fitted, search.fitter.measured) < margin:
        return names
    return best


def _is_its_main_part(search: Search, names: Explanation, best: Explanation, closed: float) -> bool:
    if len(names.steps) != 1 or len(best.steps) != 1:
        return False
    is_most = is_most_of(closed, cost_of(search.start) - best.cost, search.config)
    return is_most and is_part_of(search.fitter, names.fitted, 0, best.fitted)


def _names_first(search: Search, found: Explanation) -> Explanation:
    """Smooth functions last: whether the names are accepted without them is tested next."""
    effects = sorted(found.effects, key=lambda effect: isinstance(effect, Residual))
    return found if tuple(effects) == found.effects else search.in_order(found, effects)


def by_fewer(search: Search, found: Explanation, candidates: Sequence[Effect]) -> Explanation:
    """The same without a first effect of many parameters, which may stand for several of few.

    Of both the one of less cost; one cause is not exchanged for names that are not what they say,
    as a width that is everywhere the same is no curvature.
    """
    if not found.steps or found.effects[0].slow or len(found.effects[0].parameters) < MANY:
        return found
    first = found.effects[0].key
    others = search.stepwise([one for one in candidates if one.key != first])
    others = replace(others, first=found.first)
    if not others.steps or others.cost >= found.cost:
        return found
    fit = others.fitted
    are_meant = not any(
        is_meant(added) or lacks_essence(search.fitter, fit, place, search.config)
        for place, added in enumerate(fit.effects)
    )
    return others if are_meant else found


def by_parts(search: Search, found: Explanation, candidates: Sequence[Effect]) -> Explanation:
    """The first effect that includes others exchanged for two of them, where that costs less."""
    whole = next((effect for effect in found.effects if effect.includes), None)
    if whole is None:
        return found
    place = found.effects.index(whole)
    parts = [c for c in candidates if c.name in whole.includes and c.name not in found.names]
    pairs = [pair for pair in combinations(parts, 2) if _freedom(pair) < len(whole.parameters)]
    around = found.effects[:place], found.effects[place + 1 :]
    exchanged = [
        without_idle(
            search, search.in_order(found, [*around[0], *_most_first(pair, found), *around[1]])
        )
        for pair in pairs
    ]
    return min([found, *exchanged], key=lambda one: one.cost)


def _most_first(pair: Sequence[Effect], found: Explanation) -> Sequence[Effect]:
    """Two effects, that of more evidence by itself first: it gives the answer its name."""
    evidence = {one.effect.key: one.evidence for one in found.first}
    return sorted(pair, key=lambda one: -evidence.get(one.key, -np.inf))


def _freedom(effects: Sequence[Effect]) -> int:
    return sum(len(effect.parameters) for effect in effects)


def simplest(search: Search, found: Explanation, candidates: Sequence[Effect]) -> Explanation:
    """Effects exchanged for those that do the same with less freedom, where that is better.

    What the first of two effects did not need for itself it may have lent to the second. The same
    name with fewer of its own parameters need only lose by less than the margin: a clock that is
    late, and runs fast by next to nothing, is late.
    """
    for place, added in enumerate(found.fitted.effects):
        alike = added.effect.same_as(added.values)
        for other in candidates:
            simpler = len(other.parameters) < len(added.values)
            is_part = other.name == added.effect.name and _is_part(other, added.effect)
            if is_part or (simpler and other.name in alike and other.name not in found.names):
                effects = [*found.effects[:place], other, *found.effects[place + 1 :]]
                exchanged = search.in_order(found, effects)
                margin = _margin(search, found, exchanged) if is_part else 0.0
                found = exchanged if exchanged.cost < found.cost + margin else found
    return found


def _margin(search: Search, found: Explanation, exchanged: Explanation) -> float:
    closed = cost_of(search.start) - found.cost
    return margin_of(search.config, search.spread_of(exchanged), closed)


def _is_part(one: Effect, other: Effect) -> bool:
    """Whether an effect has some of the parameters of another, and none beside them."""
    own, all_of = ({p.name for p in effect.parameters} for effect in (one, other))
    return own < all_of


def without_idle(search: Search, found: Explanation) -> Explanation:
    """Less what does not pay beside the others, the least of all first."""
    while len(found.steps) > 1:
        costs = _costs_without_each(search, found)
        least = min(costs, key=lambda effect: costs[effect])
        if costs[least] - found.cost > search.config.least_evidence * search.spread_of(found):
            break
        found = search.in_order(found, [e for e in found.effects if e is not least])
    return found


def _costs_without_each(search: Search, found: Explanation) -> dict[Effect, float]:
    """Cost of the other effects, by the one that is left out."""
    costs = {}
    for effect in found.effects:
        others = [e for e in found.effects if e is not effect]
        costs[effect] = cost_of(search.fitter.fit(others, found.fitted.effects))
    return costs
