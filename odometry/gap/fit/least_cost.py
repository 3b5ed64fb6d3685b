"""The values of a hypothesis that cost least: from several starts, by jumps, and from elsewhere."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.gap.fit.hypothesis import Hypothesis
from odometry.gap.solve import Found, Solved, least_squares, with_jacobian

ITERATIONS = 12
MOST_STARTS = 2  # from which values in steps are searched
PROMISING = 8  # of many starts: those of least cost to first order
SEARCHED = 2  # of several starts: the best ones
JUMPS = (-4.0, -2.0, -1.0, -0.5, 0.5, 1.0, 2.0, 4.0)  # in scales of a parameter
MOST_JUMPS = 4


def least_cost(
    hypothesis: Hypothesis, starts: list[FloatArray], held: BoolArray, settled: BoolArray
) -> Found:
    """Values of least cost from several starts, the held ones as they are.

    From those that are `settled` (V,), by an earlier search, none in steps jumps.
    """
    in_steps = hypothesis.in_steps & ~settled
    if in_steps.any():
        starts = _cheapest(hypothesis, starts)
    if len(starts) > 1:
        base_held = held | (np.arange(len(held)) < hypothesis.of_base)
        starts = _promising(hypothesis, starts, base_held)
        tried = [_search(hypothesis, start, 1, base_held) for start in starts]
        order = np.argsort([one.cost for one in tried], kind="stable")[:SEARCHED]
        starts = [tried[i].values for i in order]
    found = [_search(hypothesis, start, ITERATIONS, held) for start in starts]
    jumps = hypothesis.shapes | in_steps
    return _after_jumps(hypothesis, min(found, key=lambda one: one.cost), held, jumps)


def _cheapest(hypothesis: Hypothesis, starts: list[FloatArray]) -> list[FloatArray]:
    """The starts of least cost as they are: values in steps hardly move in one step of a search."""
    order = np.argsort(hypothesis.costs(starts), kind="stable")
    return [starts[i] for i in order[:MOST_STARTS]]


def _promising(
    hypothesis: Hypothesis, starts: list[FloatArray], held: BoolArray
) -> list[FloatArray]:
    """Of many starts that do the same, as at moments of what is not there yet, the best.

    In 30 scans of 13 cases the two that cost least after a step were the best two by this measure
    in 28, and among the best four in all.
    """
    if len(starts) <= PROMISING:
        return starts
    if not np.array_equal(hypothesis.rows(starts[0]), hypothesis.rows(starts[-1])):
        return starts
    order = np.argsort(hypothesis.first_order_costs(starts, held), kind="stable")
    return [starts[place] for place in np.sort(order[:PROMISING])]


def _search(hypothesis: Hypothesis, start: FloatArray, iterations: int, held: BoolArray) -> Found:
    if held.all():
        return Found(start, hypothesis.rows(start))
    bounds = _pinned(hypothesis.bounds, start, held)
    return least_squares(
        hypothesis.rows,
        start,
        hypothesis.scales,
        bounds,
        iterations,
        derivative=hypothesis.derivative,
    )


def _after_jumps(hypothesis: Hypothesis, found: Found, held: BoolArray, jumps: BoolArray) -> Found:
    """Search on from jumps of the values whose derivatives are small, and from elsewhere."""
    places = np.flatnonzero(jumps & ~held)
    unit = np.diag(hypothesis.scales)
    steps = [jump * unit[place] for place in places for jump in JUMPS]
    for _ in range(MOST_JUMPS if steps else 0):
        tried = [np.clip(found.values + step, *hypothesis.bounds) for step in steps]
        tried += [np.where(held, found.values, v) for v in hypothesis.elsewhere(found.values)]
        costs = hypothesis.costs(tried)
        if costs.min() > found.cost - 1:
            break
        found = _search(hypothesis, tried[int(np.argmin(costs))], ITERATIONS, held)
    return found


def derived(hypothesis: Hypothesis, found: Found, held: BoolArray) -> Solved:
    """Rows at the values found, and their Jacobian; zero for what is held."""
    if not len(found.values):
        return Solved(found.values, found.rows, np.empty((len(found.rows), 0)))
    bounds = _pinned(hypothesis.bounds, found.values, held)
    return with_jacobian(
        hypothesis.rows, found, hypothesis.scales, bounds, derivative=hypothesis.derivative
    )


def _pinned(
    bounds: tuple[FloatArray, FloatArray], values: FloatArray, held: BoolArray
) -> tuple[FloatArray, FloatArray]:
    low, high = bounds
    return np.where(held, values, low), np.where(held, values, high)
