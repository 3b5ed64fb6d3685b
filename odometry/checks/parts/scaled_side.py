"""One tread that is read at another scale in a part of a recording, while the other one is not."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import TREADS
from odometry.checks.parts.candidates import Candidate, Shares, candidate, not_explained
from odometry.checks.parts.changed_span import beside, turns_of
from odometry.checks.parts.changes import Change
from odometry.checks.parts.drifting_side import drifting_side
from odometry.checks.parts.span import Span

READS = (1 / 3, 1 / 2, 2 / 3, 1.5, 2.0, 3.0)  # times its motion: what is searched for
CHANGED = float(np.log(1.4))  # less is slip of a terrain, of which one side may have more
LEAST = 0.02  # share of the turns, or of the way, that the treads do not explain as recorded
LEFT = 0.5  # share of it that is left with the scale undone
ALONE = 0.2  # of what a scale of the other side, or of the width, leaves in the span


def scaled_side(evidence: Evidence, before: Shares) -> Iterator[Finding]:
    """A tread whose scale, undone in one span, makes all sensors agree far better.

    A tread that reads too little is no slip: the robot would move farther than its treads roll.
    Turns alone do not distinguish it from another width: the way along must have been measured.

    Parameters
    ----------
    evidence : Evidence
    before : dict
        What pairs of sensors do not explain as recorded, `candidates.not_explained`.
    """
    pairs = [pair for pair in before if pair.endswith("by treads")]
    if len(pairs) < 2 or max(before[pair] for pair in pairs) < LEAST:
        return
    found = [of for side in range(2) if (of := _best(evidence, side, before, pairs)) is not None]
    if not found:
        return
    best, reads = min(found, key=lambda one: one[0].left(pairs))
    improves = best.left(pairs) < LEFT * sum(before[pair] for pair in pairs)
    if improves and abs(np.log(reads)) > CHANGED and not _drifts(evidence, best, pairs):
        yield finding_of_scale(evidence, best.change, best.span, reads)


def _drifts(evidence: Evidence, best: Candidate, pairs: list[str]) -> bool:
    """Whether a scale of one tread that drifts leaves less than one scale in a span."""
    drift = drifting_side(evidence)
    if drift is None:
        return False
    shares = not_explained(Evidence(drift.undone(evidence.run), evidence.left_out_s))
    return sum(shares.get(pair, 1.0) for pair in pairs) < best.left(pairs)


def _best(
    evidence: Evidence, side: int, before: Shares, pairs: list[str]
) -> tuple[Candidate, float] | None:
    """The scale of a side that leaves the least, and what the tread reads, times its motion."""
    rough = [candidate(evidence, change_of_scale(side, reads), before) for reads in READS]
    found = min((of for of in rough if of is not None), key=lambda of: of.left(pairs), default=None)
    reads = None if found is None else _reads(evidence, side, found.span)
    if reads is None:
        return None
    exact = candidate(evidence, change_of_scale(side, reads), before)
    return None if exact is None else (exact, reads)


def change_of_scale(side: int, reads: float) -> Change:
    """A tread that is read at a scale."""
    return Change(
        "treads",
        f"{TREADS[side]} reads about {reads:.2g} times the motion of its tread",
        f"Correct {TREADS[side]} there, or cut with --from and --to",
        partial(_undo, side, reads),
    )


def _undo(side: int, reads: float, columns: FloatArray) -> FloatArray:
    """Columns (2, N) of which one is read at its scale."""
    scales = np.ones((2, 1))
    scales[side] = 1 / reads
    return np.asarray(columns * scales)


def _reads(evidence: Evidence, side: int, span: Span) -> float | None:
    """What a tread reads in a span, times its motion, by the turns of another sensor.

    None unless neither the other tread nor the width of the robot, each with a scale of its
    own in the span, explains nearly as much: the width changes with the terrain.
    """
    other, windows = beside(evidence, "treads")
    turns = turns_of(windows, other)
    known = np.isfinite(turns) & np.isfinite(windows.difference_m)
    inside = known & span.holds((windows.start_s + windows.end_s) / 2)
    turned, differ_m = turns[known & ~inside], windows.difference_m[known & ~inside]
    turned_m = float(turned @ differ_m) / max(float(turned @ turned), 1e-9) * turns[inside]
    left_m, right_m = windows.left_m[inside], windows.right_m[inside]
    one_side = [_scale(-left_m, turned_m - right_m), _scale(right_m, turned_m + left_m)]
    _, of_width = _scale(right_m - left_m, turned_m)
    scale, left = one_side[side]
    if scale <= 0 or left > ALONE * min(one_side[1 - side][1], of_width):
        return None
    return 1 / scale


def _scale(read_m: FloatArray, moved_m: FloatArray) -> tuple[float, float]:
    """The scale of what was read (K,) that is nearest to what moved (K,), and the squares left."""
    scale = float(read_m @ moved_m) / max(float(read_m @ read_m), 1e-9)
    return scale, float(np.sum((moved_m - scale * read_m) ** 2))


def finding_of_scale(evidence: Evidence, change: Change, span: Span, reads: float) -> Finding:
    """A tread that is read at a scale in a span."""
    began_s = evidence.run.began_s
    when = span.words(began_s)
    less = "counts are lost, or it is in another unit"
    more = "it is in another unit, or that tread slips there far more than the other"
    if abs(np.log(reads)) < CHANGED:
        less = "counts are lost, or that tread slips more elsewhere"
        more = "a wheel or a setting is another one, or that tread slips there more than the other"
    return Finding(
        "changed_in_part",
        Level.WARNING,
        f"{when} the turns of the treads differ from those of the other sensors, as if "
        f"{change.words}; elsewhere they do not",
        f"{when[:1].upper()}{when[1:]} {change.words}: {less if reads < 1 else more}",
        change.remedy,
        (span.run_time_s(began_s, evidence.duration_s),),
        mend=lambda run: change.undone(run, "odometry", span),
    )
