"""Sensors of the same motion, and headings, that differ where no known cause explains it."""

from collections.abc import Iterator, Sequence

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.imu.gyroscope import drifts_at_rest
from odometry.checks.imu.gyroscope_by_poses import headings_apart, scales_apart
from odometry.checks.poses.course_offsets import course_apart, yaw_wanders
from odometry.checks.poses.yaw_drift import course_drifts
from odometry.checks.treads.play import play
from odometry.checks.treads.proportion import (
    holds_the_mean,
    one_side_not_proportional,
    treads_unlike,
)
from odometry.checks.treads.side_changes import side_changes
from odometry.checks.treads.tread_samples import peaks_often
from odometry.checks.turns.constancy import uneven_map, uneven_yaw
from odometry.checks.turns.turns_in_parts import turns_flip
from odometry.checks.unexplained.beyond_slip import beyond_slip
from odometry.checks.unexplained.exchanged_paths import exchanged_in_part
from odometry.checks.unexplained.little_explained import little_explained
from odometry.checks.unexplained.moments_of_spin import moments_of_spin
from odometry.checks.unexplained.position_differences import (
    paths_apart,
    positions_apart,
    positions_apart_everywhere,
)
from odometry.checks.unexplained.repeated_rows import repeated_rows
from odometry.checks.unexplained.scale_drift import scale_drifts
from odometry.checks.unexplained.way_drift import way_drifts
from odometry.checks.units.carried import carried_along


def sensors_disagree(evidence: Evidence, found: Sequence[Finding]) -> Iterator[Finding]:
    """One warning where sensors differ and nothing `found` explains it; a drift has a name."""
    if any(finding.level is not Level.NOTE for finding in found):
        return
    uneven = uneven_map(evidence)
    seen = [*lasting_disagreements(evidence), uneven, peaks_often(evidence)]
    seen += [moments_of_spin(evidence), play(evidence)]
    if not any(finding.name == "slip_episodes" for finding in found):
        seen.append(positions_apart(evidence))
    words = [word for word in seen if word]
    may_drift = not words or words == [uneven]
    drift = list(way_drifts(evidence, uneven)) if may_drift else []
    if drift or not words:
        yield from drift
    else:
        yield disagreement("; ".join(words))


@once
def lasting_disagreements(evidence: Evidence) -> list[str]:
    """By what sensors differ all along, in absolute terms: more than noise and slip explain."""
    seen = (
        scales_apart(evidence),
        headings_apart(evidence),
        turns_flip(evidence),
        drifts_at_rest(evidence),
        yaw_wanders(evidence) or course_drifts(evidence) or course_apart(evidence),
        positions_apart_everywhere(evidence),
        paths_apart(evidence),
        exchanged_in_part(evidence),
        one_side_not_proportional(evidence),
        holds_the_mean(evidence),
        side_changes(evidence),
        scale_drifts(evidence),
        carried_along(evidence),
        beyond_slip(evidence),
        uneven_yaw(evidence),
        *treads_unlike(evidence),
        repeated_rows(evidence),
        *little_explained(evidence),
    )
    return [words for words in seen if words]


def against_slip(evidence: Evidence) -> list[str]:
    """By what sensors differ, of what no slip of the treads explains."""
    seen = (
        scales_apart(evidence),
        headings_apart(evidence),
        beyond_slip(evidence),
        uneven_yaw(evidence),
        *little_explained(evidence),
    )
    return [words for words in seen if words]
