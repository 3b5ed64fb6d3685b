"""One factor between the motion in a span and elsewhere: a scale of the treads that changes."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.findings.undo import TREADS, Mend, changed, in_turn
from odometry.checks.findings.unit_tables import ORDINARY_FORWARD, RARE, of_wheels, tread_units
from odometry.checks.parts.span import Span
from odometry.checks.statistics.relation import Relation, relation
from odometry.checks.treads.scaled_span import scaled_span
from odometry.checks.turns.constancy import uneven_way
from odometry.checks.turns.measured_turns import measured_turns
from odometry.recording.run import Run

CHANGED = 1.4  # ratio of what a metre moves; in 23 real recordings along and in turns at most 1.3
ALIKE = 0.35  # share of that change, as a logarithm, by which the change in turns may differ
HELD_CHANGE = 0.9  # correlation in each part: on terrain that slips a factor is not constant
CERTAIN = 8.0  # standard deviations
AS_WELL = 1.1  # times what two factors of time leave of the way: others explain it as well
LEAST_WINDOWS = 15
SAME_UNIT = 1.1  # ratio of a change and of a unit that it may be
SCALE = (
    "scale of the tread speeds changes while recording (unit, gear, wheel radius or settings of "
    "the driver); slip changes turns and the way along by different factors"
)


def scale_change(evidence: Evidence) -> Iterator[Finding]:
    """One factor between the motion in a span and elsewhere, along the way and in turns.

    A change of terrain changes turns and not the way along, or slips by no constant factor.
    """
    m = evidence.motion
    span = scaled_span(evidence)
    if span is None:
        return
    along = _elsewhere_and_inside(span, m, evidence.forward_m, m.mean_m)
    turns = next(measured_turns(evidence))
    of = turns.motion
    across = _elsewhere_and_inside(span, of, turns.target, of.difference_m)
    if along is None or across is None:
        return
    factor, in_turns = (inside.slope / elsewhere.slope for elsewhere, inside in (along, across))
    if factor <= 0 or in_turns <= 0 or abs(np.log(factor)) < np.log(CHANGED):
        return
    if abs(np.log(in_turns / factor)) > ALIKE * abs(np.log(factor)):
        return
    if directions := _by_direction(evidence, span):
        yield disagreement(directions)
        return
    if _from_ordinary(along[1]) < _from_ordinary(along[0]):
        span, along, factor = span.elsewhere, (along[1], along[0]), 1 / factor
    seen, mend = _seen(evidence, span, along), _as_elsewhere(span, factor)
    if uneven := uneven_way(Evidence(mend(evidence.run), evidence.left_out_s), factor):
        yield disagreement(f"{seen}; but with both made equal {uneven}")
        return
    moments_s = span.moments_s(evidence.run.began_s)
    yield Finding(
        "tread_scale_changed",
        Level.WARNING,
        f"{seen}, and turns change by the same factor",
        _cause(evidence, span, along),
        f"Cut the recording at {' and '.join(f'{at_s:.0f} s' for at_s, _ in moments_s)}, and "
        "correct the scale of the part that is wrong",
        moments_s,
        mend=mend,
    )


def _from_ordinary(of: Relation) -> float:
    """How far a factor is, as a logarithm, from that of ordinary robots."""
    return float(abs(np.log(abs(of.slope) / ORDINARY_FORWARD)))


def _seen(evidence: Evidence, span: Span, along: tuple[Relation, Relation]) -> str:
    elsewhere, inside = (f"{part.slope:.3g} m" for part in along)
    begin_s, end_s = (at_s - evidence.run.began_s for at_s in (span.begin_s, span.end_s))
    moves = "a metre of tread travel moves the robot by"
    if np.isinf(begin_s):
        return f"{moves} {inside} before {end_s:.0f} s and by {elsewhere} after"
    if np.isinf(end_s):
        return f"{moves} {elsewhere} before {begin_s:.0f} s and by {inside} after"
    if begin_s > end_s:
        begin_s, end_s, inside, elsewhere = end_s, begin_s, elsewhere, inside
    return f"{moves} {inside} from {begin_s:.0f} to {end_s:.0f} s and by {elsewhere} elsewhere"


def _cause(evidence: Evidence, span: Span, along: tuple[Relation, Relation]) -> str:
    """With the unit in which speeds are in a span, where they are ordinary ones elsewhere."""
    elsewhere, inside = (part.slope for part in along)
    radius_m, of = evidence.run.robot.wheel_radius, elsewhere / inside
    units = [u.words for u in tread_units(radius_m, evidence.period_s) if _alike(u.factor, of)]
    units += of_wheels(ORDINARY_FORWARD / of) if radius_m is None else ()
    units = [words for words in units if words not in RARE] or units
    if not units or _from_ordinary(along[0]) > np.log(CHANGED):
        return f"The {SCALE}"
    when = span.words(evidence.run.began_s)
    return f"{when[:1].upper()}{when[1:]} tread speeds are in {' or '.join(units)}; or the {SCALE}"


def _alike(one: float, other: float) -> bool:
    return 1 / SAME_UNIT < one / other < SAME_UNIT


def _by_direction(evidence: Evidence, span: Span) -> str:
    """Words where one factor forwards and one backwards explain the way as well as two of time."""
    m, forward_m = evidence.motion, evidence.forward_m
    elsewhere, inside = _parts(span, m)
    either = elsewhere | inside
    left = []
    for first in (m.mean_m > 0, inside):
        parts = (np.where(rows, m.mean_m, 0.0)[either] for rows in (first, ~first))
        fit = relation(forward_m[either], *parts)
        left.append(np.inf if fit is None else 1 - fit.explained)
    if left[0] > AS_WELL * left[1]:
        return ""
    return (
        "a metre of tread travel moves the robot by one factor forwards and by another one "
        f"backwards, or by another one {span.words(evidence.run.began_s)}"
    )


def _parts(span: Span, of: Motion) -> tuple[BoolArray, BoolArray]:
    """Windows (K,) that lie elsewhere, and in a span; those across an end are none of both."""
    begun, ended = span.holds(of.start_s), span.holds(np.nextafter(of.end_s, -np.inf))
    return ~begun & ~ended, begun & ended


def _elsewhere_and_inside(
    span: Span, of: Motion, target: FloatArray, by: FloatArray
) -> tuple[Relation, Relation] | None:
    """The factor elsewhere and in a span; None where one of them is not certain and constant."""
    parts = [relation(target[rows], by[rows]) for rows in _parts(span, of)]
    elsewhere, inside = parts
    if elsewhere is None or inside is None:
        return None
    sure = all(
        part.certain(0, CERTAIN)
        and part.correlation > HELD_CHANGE
        and part.measured >= LEAST_WINDOWS
        for part in (elsewhere, inside)
    )
    return (elsewhere, inside) if sure else None


def _as_elsewhere(span: Span, factor: float) -> Mend:
    """Tread speeds in a span in the scale that they have elsewhere."""

    def mend(run: Run) -> Run:
        scale = np.where(span.holds(run.odometry.stamps_s), factor, 1.0)
        return in_turn(*(changed("odometry", name, lambda v: scale * v) for name in TREADS))(run)

    return mend
