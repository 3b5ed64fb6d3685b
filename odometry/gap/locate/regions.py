"""Regions in which the gap lies: few bounds, found on one half of a run, tested on the other."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from sklearn.tree import DecisionTreeRegressor
from sklearn.tree._tree import Tree

from odometry.arrays import BoolArray, FloatArray
from odometry.gap.locate.region_words import words_of
from odometry.gap.locate.variables import LABEL, Variable
from odometry.gap.prepare.end_residuals import Ends

DEPTHS = (1, 2)
LEAST_SHARE = 0.1  # of the windows that a region holds
SURE = 3.0  # standard errors, as noise makes them, above what noise explains
DECIMALS = 4  # of a bound

Bounds = Mapping[str, tuple[float | None, float | None]]


@dataclass(frozen=True)
class Region:
    """Where a part of the gap lies.

    Attributes
    ----------
    words : str
        For a person.
    bounds : Mapping of name to (low, high)
        None where it is not bounded on that side; all hold together.
    excess_m : float
        RMS position error of the region's windows less the noise floor [m].
    share : float
        Of the squared position errors beyond noise, summed over the windows of all regions.
    """

    words: str
    bounds: Bounds
    excess_m: float
    share: float


def regions(variables: Sequence[Variable], ends: Ends, floor_m: float) -> tuple[Region, ...]:
    """Bounds of the variables within which the excess is about the same; the largest share first.

    A regression tree of depth 2 at most is fitted to the position errors of every other piece:
    to their size, lest a few large squares decide. All figures are those of the other pieces, on
    which the squares of a region must be beyond noise by three standard errors; of trees of
    depth 0, 1 and 2 the one stands that errs least on them. Where no bound helps, the one region
    is everywhere.
    """
    features = dict(_features(variables))
    fitted = ends.pieces % 2 == 0
    if fitted.all() or not fitted.any():
        return ()
    excess, squares = ends.excess_m2[~fitted], ends.squares_m2[~fitted]
    deviation = ends.deviation_m2[~fitted]
    leaves = _leaves(features, np.sqrt(ends.squares_m2), fitted)
    members = [_within(features, leaf, ~fitted) for leaf in leaves]
    total = sum(max(0.0, float(excess[inside].sum())) for inside in members)
    found = [
        Region(
            words_of(leaf),
            leaf,
            float(np.sqrt(squares[inside].mean())) - floor_m,
            float(excess[inside].sum()) / total,
        )
        for leaf, inside in zip(leaves, members, strict=True)
        if _is_above(excess[inside], deviation[inside]) and squares[inside].mean() > floor_m**2
    ]
    return tuple(sorted(found, key=lambda region: -region.share))


def _features(variables: Sequence[Variable]) -> Iterator[tuple[str, FloatArray]]:
    for variable in variables:
        if variable.kind == LABEL:
            for label in np.unique(variable.values):
                yield f"{variable.name}={label}", (variable.values == label).astype(np.float64)
        else:
            yield variable.name, variable.values


def _leaves(
    features: Mapping[str, FloatArray], errors_m: FloatArray, fitted: BoolArray
) -> list[Bounds]:
    """Bounds of the leaves of the best tree."""
    if not features:
        return [{}]
    table, target = np.column_stack(list(features.values())), errors_m[fitted]
    trees = [
        DecisionTreeRegressor(
            max_depth=depth,
            min_samples_leaf=max(2, int(np.ceil(LEAST_SHARE * len(target)))),
            random_state=0,
        ).fit(table[fitted], target)
        for depth in DEPTHS
    ]
    losses = [
        float(np.square(errors_m[~fitted] - predicted).sum())
        for predicted in (target.mean(), *(tree.predict(table[~fitted]) for tree in trees))
    ]
    best = int(np.argmin(losses))
    return list(_below(trees[best - 1].tree_, 0, {}, list(features))) if best else [{}]


def _below(nodes: Tree, node: int, bounds: Bounds, names: Sequence[str]) -> Iterator[Bounds]:
    """Bounds of the leaves below a node."""
    if nodes.children_left[node] < 0:
        yield bounds
        return
    name = names[nodes.feature[node]]
    cut = round(float(nodes.threshold[node]), DECIMALS)
    low, high = bounds.get(name, (None, None))
    yield from _below(nodes, nodes.children_left[node], {**bounds, name: (low, cut)}, names)
    yield from _below(nodes, nodes.children_right[node], {**bounds, name: (cut, high)}, names)


def _within(features: Mapping[str, FloatArray], bounds: Bounds, among: BoolArray) -> BoolArray:
    inside = np.ones(int(among.sum()), dtype=np.bool_)
    for name, (low, high) in bounds.items():
        values = features[name][among]
        if low is not None:
            inside &= values > low
        if high is not None:
            inside &= values <= high
    return inside


def _is_above(excess_m2: FloatArray, deviation_m2: FloatArray) -> bool:
    """Whether the mean of tested windows is above that of noise."""
    if not len(excess_m2):
        return False
    return bool(excess_m2.sum() > SURE * np.sqrt((deviation_m2**2).sum()))
