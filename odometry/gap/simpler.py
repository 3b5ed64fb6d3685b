"""The same gap explained by fewer or simpler effects, where they cost less."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from odometry.effects.base import Effect
from odometry.gap.contest import cost_of
from odometry.gap.explanation import Explanation
from odometry.gap.search import Search

MANY = 5  # parameters of an effect that two others may share


def by_fewer(search: Search, found: Explanation, candidates: Sequence[Effect]) -> Explanation:
    """The same without a first effect of many parameters, which may stand for several of few.

    Of both the one of less cost.
    """
    if not found.steps or found.effects[0].slow or len(found.effects[0].parameters) < MANY:
        return found
    first = found.effects[0].key
    others = search.stepwise([one for one in candidates if one.key != first])
    others = replace(others, first=found.first)
    return others if others.steps and others.cost < found.cost else found


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

    What the first of two effects did not need for itself it may have lent to the second.
    """
    for place, added in enumerate(found.fitted.effects):
        alike = added.effect.same_as(added.values)
        for other in candidates:
            simpler = len(other.parameters) < len(added.values)
            if simpler and other.name in alike and other.name not in found.names:
                effects = [*found.effects[:place], other, *found.effects[place + 1 :]]
                exchanged = search.in_order(found, effects)
                found = exchanged if exchanged.cost < found.cost else found
    return found


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
