"""Whether a factor is the same at each speed, direction and place, as a scale is."""

from collections.abc import Iterator
from itertools import chain

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.evidence.once import once
from odometry.checks.statistics.relation import Relation, relation
from odometry.checks.turns.measured_turns import measured_turns

MOVING = 0.1  # of the ordinary fastest window
EARLY = 0.3  # share of the windows, at either end of the recording
STRAIGHT = 0.3  # share of the mean by which both treads differ at most
LEAST_WINDOWS = 12  # of each group that is compared
CERTAIN = 3.0  # standard deviations
SHARE = 0.35  # of the logarithm of a factor: what it may differ by between groups
LIKE = (1.1, 1.3)  # ratio of factors: slip leaves the smaller one, above the larger one is no scale
# Ratio of the treads' shares in turns; real ones have 0.94 to 1.07 where terrain holds.
UNEQUAL = 1.15
HELD = 0.9  # share of the turns explained where terrain holds
TURNS_LIKE = (1.22, 1.5)  # the same of turns, on the straight and elsewhere, slow and fast
PLACES_LIKE = 1.15  # the same at two places of the map; of 11 real recordings at most 1.06
PLACES_LEAVE = 0.85  # share of what one factor leaves that two factors by place leave at most
# By a group of windows: where a robot backs up on straight lines, edges of other turns decide. Two
# clean drives whose gyroscope seemed to turn 15 and 17 % too much there had turned by 0.8 rad.
LEAST_TURNED_RAD = 2.0
TOGETHER = 0.9  # correlation of gyroscope and poses in a group
Groups = Iterator[tuple[tuple[str, str], BoolArray, BoolArray]]


def uneven_way(evidence: Evidence, factor: float) -> str:
    """Where the treads are no constant `factor` of the measured motion; "" where they may be.

    Real robots keep the factor of their turns less than that of their way: it is compared on
    straight lines and in turns, slow and fast alone.
    """
    m, forward_m, mean_m = evidence.motion, evidence.forward_m, evidence.motion.mean_m
    if evidence.heading is None:
        forward_m, mean_m = m.distance_m, np.abs(mean_m)
    most = ratio_left(factor)
    along = _uneven(_of_way(m), forward_m, mean_m, most=most, unit=" m")
    turns = next(measured_turns(evidence))
    of, most = turns.motion, ratio_left(factor, TURNS_LIKE)
    across = _uneven(
        *(_of_turns(of), turns.target, of.difference_m, of.lasts_s), most=most, unit=" rad"
    )
    if sides := one_side(evidence):
        return sides
    if along:
        return f"a metre of tread travel moves the robot by {along}"
    return f"a metre by which the treads differ turns the robot by {across}" if across else ""


def one_side(evidence: Evidence) -> str:
    """Treads of which one turns the robot more than the other: no scale of both."""
    fits = turns_of_each(evidence)
    if not fits or not all(f.certain(0) and f.certain(1) and f.explained >= HELD for f in fits):
        return ""
    ratio = ratio_of_sides(fits)
    alike = 1 / UNEQUAL < ratio < UNEQUAL
    return "" if alike else f"a metre of the left tread turns it {ratio:.3g} times as much as right"


@once
def turns_of_each(evidence: Evidence) -> list[Relation]:
    """Turn from the travel of each tread: without and with the bias that a gyroscope may have.

    On a drive that is forwards mostly a bias left out is a scale of one tread, and where the treads
    hardly change the constant that is fitted is one. Empty where turns are not known.
    """
    if evidence.gyroscope_by_treads is None:
        return [] if evidence.pose_turn_by_treads is None else [evidence.pose_turn_by_treads]
    m = evidence.uniform
    beside_bias = relation(m.gyroscope_rad, m.left_m, m.right_m, m.lasts_s)
    return [evidence.gyroscope_by_treads, *([] if beside_bias is None else [beside_bias])]


def ratio_of_sides(fits: list[Relation]) -> float:
    """Turn by a metre of the left tread, in those of the right one: the nearest to 1 by any fit."""
    ratios = [abs(float(fit.coefficients[0] / fit.coefficients[1])) for fit in fits]
    if min(ratios) < 1 < max(ratios):
        return 1.0
    return min(ratios, key=lambda ratio: abs(np.log(ratio)))


def uneven_gyroscope(evidence: Evidence, factor: float) -> str:
    """Where the gyroscope is no constant `factor` of the measured turns; "" where it may be."""
    m = evidence.turn_motion
    fits = evidence.pose_turn_rad, m.gyroscope_rad, m.lasts_s
    groups = (
        group
        for group in chain(_of_way(m), _of_rates(m))
        if all(_turn_together(m, evidence.pose_turn_rad, rows) for rows in group[1:])
    )
    found = _uneven(groups, *fits, most=ratio_left(factor))
    return f"a radian of the gyroscope is one of the poses times {found}" if found else ""


def _turn_together(m: Motion, turned_rad: FloatArray, rows: BoolArray) -> bool:
    """Whether turns (K,) and the gyroscope go together: noise of slow turns lessens a factor."""
    one, other = m.gyroscope_rad[rows], turned_rad[rows]
    known = np.isfinite(one) & np.isfinite(other)
    if np.sum(np.abs(one[known])) <= LEAST_TURNED_RAD:
        return False
    if min(np.ptp(one[known]), np.ptp(other[known])) == 0:
        return False  # no change, by which a factor beside a bias could be known
    return bool(np.corrcoef(one[known], other[known])[0, 1] > TOGETHER)


def uneven_yaw(evidence: Evidence) -> str:
    """Where gyroscope and measured yaw, of one scale or another, do not keep to it."""
    known = evidence.yaw_measured and evidence.pose_turn_by_gyroscope is not None
    return uneven_gyroscope(evidence, 1.0) if known else ""


def uneven_map(evidence: Evidence) -> str:
    """Where a metre of the treads is surely farther at one place of the map than at others.

    Beside a way that goes with the turn: ICRs that are not symmetric add it in the lobes of a
    figure eight.
    """
    m = evidence.motion
    plain = relation(evidence.forward_m, m.mean_m, m.difference_m)
    if evidence.heading is None or plain is None:
        return ""
    found = _uneven(
        (
            group
            for group in _of_place(m)
            if _left_by(evidence, group[1]) < PLACES_LEAVE * (1 - plain.explained)
        ),
        evidence.forward_m,
        m.mean_m,
        m.difference_m,
        most=PLACES_LIKE,
        unit=" m",
    )
    return f"a metre of tread travel moves the robot by {found}" if found else ""


def _left_by(evidence: Evidence, first: BoolArray) -> float:
    """Share of the way that is left by one factor for some of the windows (K,), one for others."""
    m = evidence.motion
    ways_m = (np.where(of, m.mean_m, 0.0) for of in (first, ~first))
    fit = relation(evidence.forward_m, *ways_m, m.difference_m)
    return np.inf if fit is None else 1 - fit.explained


def ratio_left(factor: float, like: tuple[float, float] = LIKE) -> float:
    """By what ratio a constant factor may differ between groups of windows."""
    return float(np.clip(np.exp(SHARE * abs(np.log(factor))), *like))


def _uneven(
    groups: Groups, target: FloatArray, *columns: FloatArray, most: float, unit: str = ""
) -> str:
    """Two groups of windows whose factors of the first column surely differ by more than `most`."""
    if not len(target):
        return ""  # as where no course of positions turns with the treads
    for words, one, other in groups:
        first, second = (_fit(rows, target, *columns) for rows in (one, other))
        if first is None or second is None:
            continue
        unsure = np.sqrt(sum((fit.slope_sigma / fit.slope) ** 2 for fit in (first, second)))
        if abs(np.log(abs(first.slope / second.slope))) > np.log(most) + CERTAIN * unsure:
            factors = [f"{abs(fit.slope):.3g}{unit}" for fit in (first, second)]
            return f"{factors[0]} {words[0]} and by {factors[1]} {words[1]}"
    return ""


def _fit(rows: BoolArray, target: FloatArray, *columns: FloatArray) -> Relation | None:
    fit = relation(np.where(rows, target, np.nan), *columns)
    sure = fit is not None and fit.measured >= LEAST_WINDOWS and fit.certain()
    return fit if sure else None


def groups_of_motion(motion: Motion) -> Groups:
    """Names and windows (K,) of slow and fast motion, forwards and backwards, left and right."""
    fast, moving = _fast(motion)
    yield ("at low speed", "at high speed"), moving & ~fast, moving & fast
    forwards = motion.mean_m > 0
    yield ("forwards", "backwards"), moving & forwards, moving & ~forwards
    left = motion.difference_m > 0
    yield ("in left turns", "in right turns"), moving & left, moving & ~left


def _of_way(motion: Motion) -> Groups:
    yield from groups_of_motion(motion)
    _, moving = _fast(motion)
    for degrees in (0, 45):
        along = np.cos(2 * (motion.course_rad - np.radians(degrees))) > 0
        yield (f"along {degrees} degrees of the map", "across"), moving & along, moving & ~along
    first_s, last_s = np.quantile(motion.start_s, (EARLY, 1 - EARLY))
    early, late = motion.start_s < first_s, motion.start_s > last_s
    yield ("at first", "at last"), moving & early, moving & late
    yield from _of_place(motion)


def _of_place(motion: Motion) -> Groups:
    _, moving = _fast(motion)
    place = np.nancumsum(motion.moved_m, axis=0)
    middle = np.hypot(*(place - place.mean(axis=0)).T)
    for words, at, share in (
        (("at small x", "at large x"), place[:, 0], 0.5),
        (("at small y", "at large y"), place[:, 1], 0.5),
        (("near its start", "far from it"), np.hypot(*place.T), 0.5),
        (("near the middle of the map", "at its border"), middle, 0.5),
        (("near the middle of the map", "at its border"), middle, 0.75),
    ):
        near = at < np.quantile(at, share)
        yield words, moving & near, moving & ~near


def _of_rates(motion: Motion) -> Groups:
    """Slow and sharp turns, and to either side, by the gyroscope: treads may be at fault."""
    rates = motion.gyroscope_rad / motion.lasts_s
    if not np.isfinite(rates).any():
        return
    size = np.abs(rates)
    turning = size > MOVING * np.nanquantile(size, 0.95)
    sharp = size > np.median(size[turning]) if turning.any() else turning
    yield ("in slow turns", "in sharp ones"), turning & ~sharp, turning & sharp
    yield ("in turns to the left", "to the right"), turning & (rates > 0), turning & (rates < 0)


def _of_turns(motion: Motion) -> Groups:
    fast, moving = _fast(motion)
    yield ("at low speed", "at high speed"), moving & ~fast, moving & fast
    straight = np.abs(motion.difference_m) < STRAIGHT * np.abs(motion.mean_m)
    yield ("on straight lines", "in turns"), moving & straight, moving & ~straight


def _fast(motion: Motion) -> tuple[BoolArray, BoolArray]:
    """Windows (K,) that are faster than half of those that move, and those that move."""
    faster = np.maximum(np.abs(motion.left_m), np.abs(motion.right_m)) / motion.lasts_s
    moving = faster > MOVING * np.quantile(faster, 0.95)
    return faster > (np.median(faster[moving]) if moving.any() else 0.0), moving
