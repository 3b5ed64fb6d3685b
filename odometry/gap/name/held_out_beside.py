"""Which of two fits closes more of the gap on held-out data, and whether surely."""

from odometry.effects.interface.corrected import Added
from odometry.gap.fit.fitter import Fitted
from odometry.gap.fit.own_moments import with_own_moments
from odometry.gap.name.search import Search
from odometry.gap.name.verdict import closes_held_out
from odometry.gap.prepare.statistic import root_mean_square
from odometry.windows.dense.dense import DenseWindows


def closes_less(search: Search, one: Fitted, other: Fitted) -> bool:
    """Whether one fit leaves more of the gap on held-out data than another."""
    gaps = []
    for fit in (one, other):
        of_runs = _of_held_out(search, fit)
        gaps.append(root_mean_square(fit.base, *of_runs, search.floor.measure))
    return gaps[0] > gaps[1]


def surely_closes_more(search: Search, one: Fitted, other: Fitted) -> bool:
    """Whether one fit leaves less of the gap there than another, and not by chance.

    As each effect must beside the others (`closes_held_out`). Where one of them is judged on a part
    of the windows, as a moment is found on the rest, they are not compared one by one.
    """
    effects, scenes = _of_held_out(search, one)
    of_other, others = _of_held_out(search, other)
    if [len(scene) for scene in scenes] != [len(scene) for scene in others]:
        return not closes_less(search, one, other)
    before, after = (other.base, of_other), (one.base, effects)
    return not closes_held_out(before, after, scenes, search.held_floor, search.config)


def _of_held_out(search: Search, fit: Fitted) -> tuple[tuple[Added, ...], list[DenseWindows]]:
    fitter = search.fitter
    return with_own_moments(
        fit.base, fit.effects, search.held_out, fitter.measured.scenes, fitter.calibration
    )
