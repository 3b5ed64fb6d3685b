"""What a name must be, beside what it closes: gates that give the reason where they refuse.

A gate returns "" where the name passes, else the reason as a clause; the others are those of
`odometry.gap.name.verdict`. Every number is one of `GapConfig`.
"""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.by_side import DelayBySide
from odometry.effects.commands.late_treads import ActuatorLag, CommandDelay
from odometry.effects.interface.base import CommandEffect
from odometry.effects.interface.corrected import Added, delay_s
from odometry.effects.measurement.time_offset import ClockDrift, LatePositions, TimeOffset
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.agreement import POSITIONS, Disagreement
from odometry.gap.fit.evenness import Unevenness
from odometry.gap.locate.region_words import noun_of
from odometry.gap.prepare.simulate import run_of
from odometry.windows.dense.dense import DenseWindows


def is_unbeaten(gain: float, refused: str, of_refused: float, margin: float) -> str:
    """Whether no candidate that is refused explains more, by more than a margin of chi-squared.

    What a refused candidate does there is no effect of its name, and still no other name's.
    """
    if of_refused - gain <= margin:
        return ""
    return f"{refused}, which is refused itself, explains more"


def is_the_main_part(of_names: float, of_all: float, config: GapConfig) -> str:
    """Whether names alone close most of what they close with smooth functions beside them."""
    if of_names >= config.least_of_all * of_all:
        return ""
    return (
        f"it closes {100 * of_names / of_all:.0f} % of what it closes with a smooth function "
        "beside it: not the cause, or not the only one"
    )


def is_special(instead: Residual | None) -> str:
    """Whether no smooth function does better in the place of a name."""
    if instead is None:
        return ""
    return f"a smooth function of {noun_of(instead.variable)} explains more in its place"


def is_abrupt(cost_of_course: float, cost: float, margin: float) -> str:
    """Whether a name that comes at once explains as much as a motion that comes slowly."""
    if cost - cost_of_course < margin:
        return ""
    return "a slow course in run time explains more in its place: there is no moment"


def is_by_its_essence(without: float, added: Added, config: GapConfig) -> str:
    """Whether a name closes most by the parameters that make it what it is, not by others."""
    if without <= config.most_without:
        return ""
    return (
        f"without {', '.join(added.effect.essential)}, which makes it this effect, it closes "
        f"{100 * without:.0f} % of the same"
    )


def is_sure_of_its_essence(
    added: Added, rise: float, config: GapConfig, *, spans_none: bool
) -> str:
    """Whether the parameters that make a name what it is surely differ from none.

    `rise` is that of chi-squared, in units of what is left a degree of freedom, where they are none
    and all others are fitted anew: the interval of one alone, which `spans_none`, may be wide where
    another does nearly the same.
    """
    if rise > (config.surely if spans_none else config.sure) ** 2:
        return ""
    names = ", ".join(added.effect.essential)
    return f"{names}, which makes it this effect, does not surely differ from none at all"


def is_most_of(closed: float, by_function: float, config: GapConfig) -> bool:
    """Whether a name closes most of what a smooth function closes in its place.

    Where the function can do what the name does, as one of a tread's share, of anything, is a wheel
    scale where it is constant: what it does beyond that is something else beside the name.
    """
    return closed >= config.main_part * by_function


def is_resolved(added: Added, before: Sequence[Added], scenes: Sequence[DenseWindows]) -> str:
    """Whether stamps of poses are off by more than the period of the recorded speeds.

    Beside treads that act late: when within a period they changed their speed is not recorded.
    """
    late = any(isinstance(one.effect, CommandEffect) for one in before)
    if not late or added.effect.name != TimeOffset.name:
        return ""
    periods_s = [float(np.median(np.diff(one.run.odometry.stamps_s))) for one in scenes]
    off_s = farthest_off_s(added, scenes)
    if off_s > max(periods_s):
        return ""
    return (
        f"{1e3 * off_s:.0f} ms are less than the {1e3 * max(periods_s):.0f} ms from one recorded "
        "speed to the next: beside treads that act late they cannot be distinguished"
    )


def farthest_off_s(of_stamps: Added, scenes: Sequence[DenseWindows]) -> float:
    """By how much an effect makes stamps of poses off at most [s]."""
    positions_s = float(of_stamps.values[0]) if isinstance(of_stamps.effect, LatePositions) else 0.0
    return max(
        float(np.abs(positions_s + delay_s((of_stamps,), one.pose_s, run_of(one))).max())
        for one in scenes
    )


def is_of_stamps(added: Added, others: Sequence[Added], scenes: Sequence[DenseWindows]) -> str:
    """Whether stamps of poses are no change of treads that act late.

    Beside these, and without a gyroscope, which follows the motion and not the stamps of poses.
    One side that acts late under poses that are as late is the other side, recorded late.
    """
    late = [
        one.effect for one in others if one.effect.name in (ActuatorLag.name, CommandDelay.name)
    ]
    if not late or all(scene.reported_turns is not None for scene in scenes):
        return ""
    if isinstance(added.effect, ClockDrift):
        other = "a lag that changes over the run"
    elif isinstance(added.effect, TimeOffset) and any(isinstance(e, DelayBySide) for e in late):
        other = "an encoder of one side that is late"
    else:
        return ""
    return (
        f"beside treads that act late it may be {other}: without gyro_z they cannot be "
        "distinguished"
    )


def is_even(of: Unevenness, config: GapConfig) -> str:
    """Whether an effect has one strength, in all pieces of the runs."""
    if of.share <= config.uneven or of.probability >= config.uneven_probability:
        return ""
    return (
        f"its strength differs by {100 * of.share:.0f} % from one stretch of the runs to the next: "
        "something else comes and goes"
    )


def is_one_to_all(of: Disagreement | None, config: GapConfig) -> str:
    """Whether all that measures an effect shows the same strength of it."""
    if of is None or of.difference <= config.disagreeing or of.sigmas <= config.surely_disagreeing:
        return ""
    return (
        f"{of.stronger} show{'s' * (of.stronger != POSITIONS)} {of.factors[0]:.2f} times its "
        f"strength and {of.weaker} {of.factors[1]:.2f} times: one of them shows something else"
    )


def is_of_one_side(factors: FloatArray, config: GapConfig) -> str:
    """Whether the wheels of one side have another size from a moment on, and not all alike."""
    less, more = np.sort(np.abs(np.asarray(factors) - 1))
    if less <= config.one_sided * more:
        return ""
    return (
        f"all its wheels change from a moment on ({factors[0]:.3g} and {factors[1]:.3g} times as "
        "large): what is lost is no tyre and no track"
    )


def no_wheel_grows(factors: FloatArray, config: GapConfig) -> str:
    """Whether no wheel is larger from a moment on: a tyre is lost, none grows."""
    if float(np.max(factors)) <= 1 + config.largest_growth:
        return ""
    return (
        f"its wheels are {np.max(factors):.3g} times as large from a moment on: what is lost is no "
        "tyre and no track"
    )
