"""The span in which one tread has another scale, where its course all along says that it has."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding
from odometry.checks.findings.undo import TREADS
from odometry.checks.parts.drifting_side import DriftingSide, drifting_side
from odometry.checks.parts.edges import Columns, exact_span
from odometry.checks.parts.scale_courses import ScaleCourses
from odometry.checks.parts.scaled_side import change_of_scale, finding_of_scale
from odometry.checks.parts.span import Span, best_rows

EDGES = 31  # places of an end that are tried, of equal counts of windows
LEAST_WINDOWS = 10  # inside, and outside


def side_in_part(evidence: Evidence) -> Iterator[Finding]:
    """A tread with one scale in a span and another one elsewhere, if no course leaves less.

    What a course all along has told apart from the width and from the other tread need not be told
    apart in the span, as `scaled_side` does.
    """
    drift = drifting_side(evidence)
    if drift is None:
        return
    found = _in_rows(drift.turns, drift.side)
    if found is None:
        return
    span, inside, elsewhere = _exact(evidence, drift, found), *found.levels
    if abs(np.log(inside / found.other)) < abs(np.log(elsewhere / found.other)):
        span, inside, elsewhere = span.elsewhere, elsewhere, inside
    reads = elsewhere / inside
    yield finding_of_scale(evidence, change_of_scale(drift.side, reads), span, reads)


@dataclass(frozen=True)
class _InRows:
    """Windows from a row to before another, and turns by a metre of a tread in them and elsewhere.

    `other` is that of the other tread, `squares` are those that are left.
    """

    rows: tuple[int, int]
    levels: tuple[float, float]
    other: float
    squares: float


def _in_rows(turns: ScaleCourses, side: int) -> _InRows | None:
    """The rows that leave least, unless a course leaves less; None where a scale has no sense."""
    count = len(turns.target)
    ends = np.linspace(0, count, EDGES).astype(np.int64).tolist()
    tried = [
        _tried(turns, side, (first, after))
        for first, after in combinations(ends, 2)
        if LEAST_WINDOWS <= after - first <= count - LEAST_WINDOWS
    ]
    best = min(tried, key=lambda of: of.squares, default=None)
    if best is None or best.squares > turns.left_by_course(side):
        return None
    return best if min(*best.levels, best.other) > 0 else None


def _tried(turns: ScaleCourses, side: int, rows: tuple[int, int]) -> _InRows:
    own_m, other_m = turns.own_and_other_m(side)
    inside_m = np.zeros_like(own_m)
    inside_m[slice(*rows)] = own_m[slice(*rows)]
    squares, found = turns.fit(inside_m, own_m - inside_m, other_m, turns.lasts_s)
    inside, elsewhere, other, _ = found.tolist()
    return _InRows(rows, (inside, elsewhere), other, squares)


def _exact(evidence: Evidence, drift: DriftingSide, found: _InRows) -> Span:
    """Its span, with ends at the rows at which speeds change."""
    recorded, turns = evidence.run.odometry.stack(*TREADS).T, drift.turns
    inside, elsewhere = found.levels
    undone = recorded.copy()
    undone[drift.side] *= inside / elsewhere
    own_m, other_m = turns.own_and_other_m(drift.side)
    left = [
        (turns.target - level * own_m - found.other * other_m) ** 2 for level in (elsewhere, inside)
    ]
    gains = left[0] - left[1]
    columns = Columns(evidence.stamps_s, recorded, undone, elsewhere / inside, np.inf)
    return exact_span(gains, turns.windows_s, best_rows(gains), columns)
