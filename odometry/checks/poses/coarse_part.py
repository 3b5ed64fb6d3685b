"""A part of a recording whose positions were rounded to a step."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.parts.span import Span, best_rows
from odometry.positions.rounding import FEWEST_CHANGES, MANY_CHANGES, REPEATED

COARSE_M = 0.02
CANDIDATES, OFTEN = 5, 3  # changes of a coordinate tried as the step, and how often each is there
WHOLE = 0.02  # of a step, by which a change may be off a multiple
ON_GRID, ELSEWHERE = 0.98, 0.3  # share of the changes in the part, at least, and outside, at most
FEWEST_POSES = 20  # of which there must be some


@dataclass(frozen=True)
class CoarsePart:
    """A span whose positions are multiples of a step, apart from a constant."""

    span: Span
    step_m: float


@once
def coarse_part(evidence: Evidence) -> CoarsePart | None:
    """The part of the positions that comes in steps, where the others do not; None without one."""
    pose, measured = evidence.run.pose, evidence.positions_measured
    if pose is None or measured is None or measured.sum() < FEWEST_POSES:
        return None
    stamps_s, positions = pose.stamps_s[measured], pose.stack("x", "y")[measured]
    changes = np.abs(np.diff(positions, axis=0))
    changes[changes < 1e-9 * np.maximum(1.0, np.abs(positions).max(axis=0))] = 0.0
    found = [
        (part, step_m)
        for step_m in _candidates(changes)
        if (part := _part(changes, step_m)) is not None
    ]
    if not found:
        return None
    (first, after), step_m = max(found, key=lambda one: (one[0][1] - one[0][0], one[1]))
    begin_s = stamps_s[first] if first > 0 else -np.inf
    end_s = stamps_s[after + 1] if after < len(changes) else np.inf
    return CoarsePart(Span(float(begin_s), float(end_s)), step_m)


def _candidates(changes: FloatArray) -> list[float]:
    """The changes (M - 1, 2) of a coordinate that are repeated most often, and what they differ by.

    A robot that is fast for the step repeats larger multiples of it alone.
    """
    values, counts = np.unique(np.round(changes[changes > COARSE_M], 6), return_counts=True)
    often = np.argsort(counts, kind="stable")[::-1][:CANDIDATES]
    steps = values[often[counts[often] >= OFTEN]]
    apart = np.abs(steps[:, None] - steps).ravel()
    return [float(of) for of in np.unique(np.round(np.append(steps, apart[apart > COARSE_M]), 6))]


def _part(changes: FloatArray, step_m: float) -> tuple[int, int] | None:
    """First change and the one after the last that are multiples of a step; None without a part.

    Positions that are repeated before and after are of the part.
    """
    counts = changes / step_m
    on_grid = (np.abs(counts - np.round(counts)) < WHOLE).all(axis=1)
    on_grid &= ((changes == 0) | (counts > 0.5)).all(axis=1)
    moved = np.asarray(changes.any(axis=1))
    first, after = best_rows(np.where(moved, np.where(on_grid, 1.0, -1.0), 0.0))
    inside = np.zeros(len(changes), dtype=np.bool_)
    inside[first:after] = True
    within, elsewhere = on_grid[moved & inside], on_grid[moved & ~inside]
    if not len(within) or not len(elsewhere):
        return None
    if within.mean() < ON_GRID or elsewhere.mean() > ELSEWHERE:
        return None
    if not _is_stepping(counts[inside]):
        return None
    moves = np.flatnonzero(moved & ~inside)
    before, later = moves[moves < first], moves[moves >= after]
    return int(before[-1]) + 1 if len(before) else 0, int(later[0]) if len(later) else len(moved)


def _is_stepping(counts: FloatArray) -> bool:
    """Whether changes (K, 2) in steps are those of a grid: a steady speed has one alone."""
    repeated = bool(np.mean(~counts.any(axis=1)) >= REPEATED)
    sizes = [np.unique(np.round(column[column > 0])) for column in counts.T]
    many = [np.count_nonzero(column) for column in counts.T]
    if repeated:
        return bool(sum(many) >= 2 * FEWEST_CHANGES)
    return bool(min(many) >= MANY_CHANGES and min(map(len, sizes)) > 1)
