"""One factor between the motion before and after a moment: a scale of the treads that changes."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.constancy import uneven_way
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.measured_turns import measured_turns
from odometry.checks.evidence.relation import Relation, relation
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.findings.undo import TREADS, Mend, changed, in_turn
from odometry.run import Run

CHANGED = 1.4  # ratio of what a metre moves; in 23 real recordings along and in turns at most 1.3
ALIKE = 0.35  # share of that change, as a logarithm, by which the change in turns may differ
HELD_CHANGE = 0.9  # correlation in each part: on terrain that slips a factor is not constant
CERTAIN = 8.0  # standard deviations
AS_WELL = 1.1  # times what two factors of time leave of the way: others explain it as well
LEAST_SHARE = 0.1  # of the way on each side of the moment
LEAST_WINDOWS = 15


def scale_change(evidence: Evidence) -> Iterator[Finding]:
    """One factor between the motion before and after a moment, along the way and in turns.

    A change of terrain changes turns and not the way along, or slips by no constant factor.
    """
    m = evidence.motion
    moment_s = _moment_s(m.start_s, evidence.forward_m, m.mean_m)
    if moment_s is None:
        return
    along = _before_and_after(moment_s, m.end_s, m.start_s, evidence.forward_m, m.mean_m)
    turns = next(measured_turns(evidence))
    of = turns.motion
    across = _before_and_after(moment_s, of.end_s, of.start_s, turns.target, of.difference_m)
    if along is None or across is None:
        return
    factor, in_turns = (after.slope / before.slope for before, after in (along, across))
    if factor <= 0 or in_turns <= 0 or abs(np.log(factor)) < np.log(CHANGED):
        return
    if abs(np.log(in_turns / factor)) > ALIKE * abs(np.log(factor)):
        return
    if directions := _by_direction(evidence, moment_s):
        yield disagreement(directions)
        return
    at_s, mend = evidence.run_time_s(moment_s), _as_before(moment_s, factor)
    if uneven := uneven_way(Evidence(mend(evidence.run), evidence.left_out_s), factor):
        yield disagreement(
            f"a metre of tread travel moves the robot by {along[0].slope:.3g} m before "
            f"{at_s:.0f} s and by {along[1].slope:.3g} m after; but with both made equal {uneven}"
        )
        return
    yield Finding(
        "tread_scale_changed",
        Level.WARNING,
        f"a metre of tread travel moves the robot by {along[0].slope:.3g} m before {at_s:.0f} s "
        f"and by {along[1].slope:.3g} m after, and turns change by the same factor",
        "The scale of the tread speeds changes while recording (unit, gear, wheel radius or "
        "settings of the driver); slip changes turns and the way along by different factors",
        f"Cut the recording at {at_s:.0f} s, and correct the scale of the part that is wrong",
        spans_s=((at_s, at_s),),
        mend=mend,
    )


def _moment_s(start_s: FloatArray, forward_m: FloatArray, travel_m: FloatArray) -> float | None:
    """The moment at which two factors explain most more than one does."""
    known = np.isfinite(forward_m) & np.isfinite(travel_m)
    if known.sum() < 2 * LEAST_WINDOWS:
        return None
    stamps_s, forward_m, travel_m = start_s[known], forward_m[known], travel_m[known]
    products, squares = np.cumsum(forward_m * travel_m), np.cumsum(travel_m**2)
    way = np.cumsum(np.abs(forward_m))
    share = way / max(way[-1], 1e-300)
    rows = np.flatnonzero((share > LEAST_SHARE) & (share < 1 - LEAST_SHARE))
    if not len(rows):
        return None
    left = np.maximum(squares[-1] - squares[rows], 1e-300)  # treads may read zero on one side
    later = (products[-1] - products[rows]) ** 2 / left
    explained = products[rows] ** 2 / np.maximum(squares[rows], 1e-300) + later
    return float(stamps_s[rows[np.argmax(explained)] + 1])


def _by_direction(evidence: Evidence, moment_s: float) -> str:
    """Words where one factor forwards and one backwards explain the way as well as two of time."""
    m, forward_m = evidence.motion, evidence.forward_m
    left = []
    for first in (m.mean_m > 0, m.end_s <= moment_s):
        parts = (np.where(rows, m.mean_m, 0.0) for rows in (first, ~first))
        fit = relation(forward_m, *parts)
        left.append(np.inf if fit is None else 1 - fit.explained)
    if left[0] > AS_WELL * left[1]:
        return ""
    return (
        "a metre of tread travel moves the robot by one factor forwards and by another one "
        f"backwards, or before and after {evidence.run_time_s(moment_s):.0f} s"
    )


def _before_and_after(
    moment_s: float, end_s: FloatArray, start_s: FloatArray, target: FloatArray, by: FloatArray
) -> tuple[Relation, Relation] | None:
    """The factor before and after a moment; None where one of them is not certain and constant."""
    parts = [relation(target[rows], by[rows]) for rows in (end_s <= moment_s, start_s >= moment_s)]
    before, after = parts
    if before is None or after is None:
        return None
    sure = all(
        part.certain(0, CERTAIN)
        and part.correlation > HELD_CHANGE
        and part.measured >= LEAST_WINDOWS
        for part in (before, after)
    )
    return (before, after) if sure else None


def _as_before(moment_s: float, factor: float) -> Mend:
    """Tread speeds from a moment on in the scale that they had before it."""

    def mend(run: Run) -> Run:
        scale = np.where(run.odometry.stamps_s >= moment_s, factor, 1.0)
        return in_turn(*(changed("odometry", name, lambda v: scale * v) for name in TREADS))(run)

    return mend
