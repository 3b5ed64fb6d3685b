"""Sensors that speak of one motion and differ, where no cause of the catalogue explains it."""

from collections.abc import Iterator, Sequence

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.headings_apart import headings_apart, scales_apart, yaw_wanders
from odometry.checks.paths_apart import paths_apart
from odometry.checks.positions_apart import positions_apart, positions_apart_everywhere
from odometry.checks.proportion import holds_the_mean, one_side_not_proportional, treads_unlike
from odometry.checks.unnamed import disagreement


def sensors_disagree(evidence: Evidence, found: Sequence[Finding]) -> Iterator[Finding]:
    """One warning where sensors differ and nothing `found` explains it."""
    if any(finding.level is not Level.NOTE for finding in found):
        return
    seen = lasting_disagreements(evidence)
    if not any(finding.name == "slip_episodes" for finding in found):
        seen += [words for words in [positions_apart(evidence)] if words]
    if seen:
        yield disagreement("; ".join(seen))


def lasting_disagreements(evidence: Evidence) -> list[str]:
    """By what sensors differ all along, in absolute terms: more than noise and slip explain."""
    seen = (
        scales_apart(evidence),
        headings_apart(evidence),
        yaw_wanders(evidence),
        positions_apart_everywhere(evidence),
        paths_apart(evidence),
        one_side_not_proportional(evidence),
        holds_the_mean(evidence),
        *treads_unlike(evidence),
    )
    return [words for words in seen if words]
