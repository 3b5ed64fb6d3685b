"""Changes whose undoing in a span makes all sensors agree better, and what they leave."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.parts.changed_span import changed_span
from odometry.checks.parts.changes import Change
from odometry.checks.parts.span import Span
from odometry.checks.statistics.relation import Relation

WORSE, AT_LEAST = 1.1, 0.01  # times what is not explained, that another pair may be worse by
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


def candidate(evidence: Evidence, change: Change, before: Shares) -> Candidate | None:
    """A change whose undoing makes no pair of sensors differ more; None where it is not clear."""
    span = changed_span(evidence, change)
    if span is None:
        return None
    mended = change.undone(evidence.run, change.table(evidence.gyroscope_file), span)
    after = not_explained(Evidence(mended, evidence.left_out_s))
    both = before.keys() & after.keys()
    worse = any(after[pair] > WORSE * before[pair] + AT_LEAST for pair in both)
    return None if worse else Candidate(change, span, after)


def not_explained(evidence: Evidence) -> Shares:
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
