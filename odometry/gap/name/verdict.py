"""What a name must close and leave, each gate with the reason that it gives where it refuses.

What it must be are the gates of `odometry.gap.name.form_gates`.

A gate returns "" where the name passes, else the reason as a clause.
Every number is one of `GapConfig`.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitted
from odometry.gap.locate.predictors import Predictor
from odometry.gap.locate.region_words import noun_of
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.statistic import (
    SEED,
    Gap,
    Measure,
    Shown,
    drawn_gaps,
    squared_errors,
    sure_sum,
)
from odometry.windows.dense.dense import DenseWindows

MAY_BE_CHANCE = "which may be chance"


@dataclass(frozen=True)
class Refusal:
    """A name that does not stand, and why."""

    name: str
    form: str
    reason: str


def within_noise(before: Shown, config: GapConfig) -> str:
    """Whether the gap before anything is added is surely above the noise floor, see `Shown`."""
    if before.is_sure(config.above_floor):
        return ""
    held_out, floor = before.held_out
    noun, unit = held_out.measure.noun, held_out.measure.unit
    return (
        f"the {noun} on held-out data, {held_out.value:.3g} {unit}, is not surely above the noise "
        f"floor of {floor.value:.3g} {unit}: the difference is known to "
        f"{held_out.doubt_above(floor):.2g} {unit}"
    )


def raises_measured(before: float, after: float, measure: Measure = Measure.POSITION) -> str:
    """Whether the gap on the runs that effects were fitted to falls with them."""
    if after < before:
        return ""
    return (
        f"the {measure.noun} on the measured runs rises with it, from {before:.2g} to {after:.2g} "
        f"{measure.unit}"
    )


def closes_held_out(
    before: tuple[Base, Sequence[Added]],
    after: tuple[Base, Sequence[Added]],
    held_out: Sequence[DenseWindows],
    floor: Gap,
    config: GapConfig,
) -> str:
    """Whether the gap on held-out data is less after than before, surely; by the floor's measure.

    It must not be greater, nor that of positions where what is added moves these (see `_farther`;
    beside a fault of the gyroscope the base alone does), and the paired interval
    of 95 % of the difference must lie above zero: that of the gap, that of the mean error, which a
    few windows in which a model fails do not decide, or the sum without the pieces that gain most.
    Or several pieces that are far above the floor are all brought within it.
    """
    measure = floor.measure
    added = after[1][len(before[1]) :]
    is_beside = added and not any(one.effect.moves_poses for one in added)
    may_rise = measure is Measure.POSITION or is_beside
    if not may_rise and (reason := _farther(before, after, held_out, config)):
        return reason
    squares = _squares(before, after, held_out, measure)
    was, now = (float(np.sqrt(of.mean())) for of in squares)
    if now >= was:
        return _worse(was, now, measure)
    rng = np.random.default_rng(SEED)
    kinds = (*squares, *(np.sqrt(of) for of in squares))
    means = drawn_gaps(kinds, held_out, config.part_s, rng) ** 2
    lows = np.quantile([means[0] - means[1], means[2] - means[3]], 0.025, axis=1)
    _, piece = np.unique(numbered_pieces(held_out, config.part_s), return_inverse=True)
    sums = np.array([np.bincount(piece, weights=of) for of in squares])
    if (lows > 0).any() or sure_sum(sums[0] - sums[1], config.trimmed) > 0:
        return ""
    if brings_within(np.sqrt(sums / np.bincount(piece)), floor, config):
        return ""
    return (
        f"on held-out data the {measure.noun} goes from {was:.3g} to {now:.3g} {measure.unit}, "
        f"{MAY_BE_CHANCE}"
    )


def _squares(
    before: tuple[Base, Sequence[Added]],
    after: tuple[Base, Sequence[Added]],
    held_out: Sequence[DenseWindows],
    measure: Measure,
) -> list[FloatArray]:
    return [
        np.concatenate([squared_errors(base, effects, scene, measure) for scene in held_out])
        for base, effects in (before, after)
    ]


def _farther(
    before: tuple[Base, Sequence[Added]],
    after: tuple[Base, Sequence[Added]],
    held_out: Sequence[DenseWindows],
    config: GapConfig,
) -> str:
    """Whether positions, by which a name is not judged, are farther off, surely or by much."""
    squares = _squares(before, after, held_out, Measure.POSITION)
    was, now = (float(np.sqrt(of.mean())) for of in squares)
    drawn = drawn_gaps(squares, held_out, config.part_s, np.random.default_rng(SEED))
    several = len(np.unique(numbered_pieces(held_out, config.part_s))) > 1
    surely = several and np.quantile(drawn[1] - drawn[0], 0.025) > 0
    if (surely and now > was * (1 + config.no_farther)) or now > was * (1 + config.much_farther):
        return _worse(was, now, Measure.POSITION)
    return ""


def brings_within(gaps: FloatArray, floor: Gap, config: GapConfig) -> bool:
    """Whether pieces with gaps (2, P) before and after that are far off are all brought to noise.

    What acts in two pieces of five leaves the others as they are: they say nothing, and in a sum
    without the best two nothing is left. No chance brings each of these within the floor.
    """
    far = gaps[0] > config.far_off * floor.high
    return int(far.sum()) >= config.trimmed and bool((gaps[1][far] <= floor.high).all())


def _worse(was: float, now: float, measure: Measure) -> str:
    return (
        f"the {measure.noun} on held-out data gets worse with it, from {was:.3g} to {now:.3g} "
        f"{measure.unit}"
    )


def base_left_calibration(fit: Fitted, free: int, config: GapConfig) -> bool:
    """Whether the base moved farther than its calibration allows, all its numbers together."""
    return free > 0 and bool(chi2.sf(fit.base_alone, free) < config.base_probability)


def leaves_noise(spread: float, closed: float, left_over: float, most: float) -> str:
    """Whether names leave nothing but noise, or close nearly all of a large excess.

    `spread` is the chi-squared a degree of freedom that they leave, `closed` the share of its
    excess that they close: an equation that is right but imperfect leaves a small part.
    """
    if spread <= left_over or closed >= most:
        return ""
    return (
        f"it closes {100 * max(closed, 0.0):.0f} % and leaves {spread:.1f} times the chi-squared "
        "of noise: not the cause, or not the only one"
    )


def come_by_themselves(variable: str, area: float, config: GapConfig) -> str:
    """Whether no recorded variable predicts when events are."""
    if area <= config.events_predicted:
        return ""
    return (
        f"{noun_of(variable)} predicts when its events are (in {100 * area:.0f} % of pairs of a "
        "moment within and one outside): it depends on that, and does not come in bursts"
    )


def come_anywhere(chance: float, config: GapConfig) -> str:
    """Whether events do not come at the same places again, but by chance."""
    if chance >= config.by_place:
        return ""
    return (
        "its events come at the same places each time (by chance as well in "
        f"{100 * chance:.1f} % of cases): it depends on place, and does not come in bursts"
    )


def leaves_no_structure(share_closed: float, predictors: Sequence[Predictor]) -> str:
    """Whether nothing predicts what names leave that close no more than a share of the gap."""
    found = [one.name for one in predictors if one.discovered]
    if not found:
        return ""
    return (
        f"it closes {100 * max(share_closed, 0.0):.0f} % of the gap, and what it leaves depends on "
        f"{noun_of(found[0])}: not the cause, or not the only one"
    )


def closes_a_part(share_closed: float, least: float) -> str:
    """Whether names close at least a share of the excess on held-out data, whatever they leave."""
    if share_closed >= least:
        return ""
    return (
        f"it closes {100 * max(share_closed, 0.0):.0f} % of the gap on held-out data: what it "
        "stands for is small, or something else"
    )


def closes_the_most(
    share_closed: float, spread: float, left: tuple[Gap, Gap], least: float, config: GapConfig
) -> str:
    """Whether names that leave more than noise close at least a share of the excess held out.

    `spread` is the chi-squared a degree of freedom that they leave on the measured runs, `left`
    the gap that they leave on held-out data, and its noise floor.
    """
    gap, floor = left
    noise = spread <= config.unexplained and gap.low <= floor.high
    if share_closed >= least or noise:
        return ""
    return (
        f"it closes {100 * max(share_closed, 0.0):.0f} % of the {gap.measure.noun} on held-out "
        f"data and leaves {gap.value:.2g} {gap.measure.unit} there, and {spread:.1f} times the "
        "chi-squared of noise: not the cause, or not the only one"
    )
