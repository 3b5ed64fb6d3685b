"""Which effects are missing: stepwise, beside smooth functions of all that was recorded."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from odometry.effects.history import History
from odometry.effects.residual import Residual
from odometry.gap.accepted_effects import Standing
from odometry.gap.candidates import quick_effects
from odometry.gap.config import GapConfig
from odometry.gap.contest import cost_of, margin_of
from odometry.gap.explanation import Explanation
from odometry.gap.fit import Fitter
from odometry.gap.general import general_candidates, shares_of_motion
from odometry.gap.input_noise import surely_dearer
from odometry.gap.search import Search
from odometry.gap.simpler import by_fewer, by_parts, simplest, without_idle
from odometry.gap.statistic import Gap
from odometry.windows.dense import DenseWindows


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
    search = Standing(fitter, fitter.fit([]), tuple(held_out), *floors, config, progress)
    scenes = fitter.measured.scenes
    quick = quick_effects(scenes, fitter.calibration)
    found = by_parts(search, by_fewer(search, search.stepwise(quick), quick), quick)
    found = simplest(search, found, quick)
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
    return search.that_stand(_names_first(search, found), (*smooth, *shares))


def _better(search: Search, names: Explanation, others: Sequence[Explanation]) -> Explanation:
    """The explanation of least cost; names where they lose by less than the margin."""
    best = min(others, key=lambda one: one.cost)
    closed = cost_of(search.start) - names.cost
    margin = margin_of(search.config, search.spread_of(best), closed)
    if names.steps and surely_dearer(names.fitted, best.fitted, search.fitter.measured) < margin:
        return names
    return best


def _names_first(search: Search, found: Explanation) -> Explanation:
    """Smooth functions last: whether the names are accepted without them is tested next."""
    effects = sorted(found.effects, key=lambda effect: isinstance(effect, Residual))
    return found if tuple(effects) == found.effects else search.in_order(found, effects)
