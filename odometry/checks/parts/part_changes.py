"""A unit, a sign or the order of columns that changes while recording, and when."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.relation import Relation
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.parts.changed_span import changed_span
from odometry.checks.parts.changes import CHANGES, Change
from odometry.checks.parts.span import Span

AGREES = 0.9  # share of the turns that all sensors explain of each other: nothing changes
BETTER = 0.5  # share of what is not explained as recorded, that is left where a change is undone
WORSE, AT_LEAST = 1.1, 0.01  # times what is not explained, that another pair may be worse by
AS_WELL, NEARLY = 1.3, 0.02  # times, and by how much, that what is left may be more than the least
Shares = dict[str, float]  # by pair of sensors


@dataclass(frozen=True)
class Candidate:
    """A change in a span, and the shares that pairs of sensors leave with it undone there."""

    change: Change
    span: Span
    shares: Shares

    def left(self, pairs: Iterable[str]) -> float:
        """The sum of the shares; a pair that is not known then does not agree."""
        return sum(self.shares.get(pair, 1.0) for pair in pairs)


def part_changes(evidence: Evidence) -> Iterator[Finding]:
    """What makes all sensors agree when it is undone in one span.

    The columns of one sensor are in another unit there, their sign is reversed, or they are
    exchanged. Where several such changes explain as much, all of them are named.
    """
    before = _not_explained(evidence)
    if not any(left > 1 - AGREES for left in before.values()):
        return
    found = [of for change in CHANGES if (of := _candidate(evidence, change, before)) is not None]
    pairs = set(before).union(*(one.shares for one in found))
    most = BETTER * sum(before.get(pair, 1.0) for pair in pairs)
    found = sorted((of for of in found if of.left(pairs) < most), key=lambda of: of.left(pairs))
    if found:
        alike = AS_WELL * found[0].left(pairs) + NEARLY
        yield _finding(evidence, [one for one in found if one.left(pairs) < alike])


def _finding(evidence: Evidence, alike: Sequence[Candidate]) -> Finding:
    best, began_s = alike[0], evidence.run.began_s
    said = "; or ".join(f"{one.span.words(began_s)} {one.change.words}" for one in alike)
    several = ": without another sensor these cannot be distinguished"
    cause = f"either {said}{several}" if len(alike) > 1 else said
    table = best.change.table(evidence.gyroscope_file)
    return Finding(
        "changed_in_part",
        Level.WARNING,
        f"{best.span.words(began_s)} the turns of {_name(best.change)} differ from those of the "
        "other sensors, and elsewhere they do not",
        cause[:1].upper() + cause[1:],
        best.change.remedy,
        (best.span.run_time_s(began_s, evidence.duration_s),),
        mend=lambda run: best.change.undone(run, table, best.span),
    )


def _name(change: Change) -> str:
    return {"pose": "pose.csv", "gyroscope": "the gyroscope", "treads": "the treads"}[change.sensor]


def _candidate(evidence: Evidence, change: Change, before: Shares) -> Candidate | None:
    """A change whose undoing makes no pair of sensors differ more; None where it is not clear."""
    span = changed_span(evidence, change)
    if span is None:
        return None
    mended = change.undone(evidence.run, change.table(evidence.gyroscope_file), span)
    after = _not_explained(Evidence(mended, evidence.left_out_s))
    both = before.keys() & after.keys()
    worse = any(after[pair] > WORSE * before[pair] + AT_LEAST for pair in both)
    return None if worse else Candidate(change, span, after)


def _not_explained(evidence: Evidence) -> Shares:
    """Share of the turns, and of the way, that pairs of sensors do not explain, by their names."""
    pairs: dict[str, Relation | None] = {
        "pose by gyroscope": evidence.pose_turn_by_gyroscope if evidence.yaw_measured else None,
        "pose by treads": evidence.pose_turn_by_difference if evidence.yaw_measured else None,
        "gyroscope by treads": evidence.gyroscope_by_difference,
        "way by treads": evidence.forward_by_mean,
    }
    return {name: _left(found) for name, found in pairs.items() if found is not None}


def _left(found: Relation) -> float:
    """1 where the sign is that of another motion."""
    return float(np.clip(1 - found.explained, 0.0, 1.0)) if found.slope > 0 else 1.0
