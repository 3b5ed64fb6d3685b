"""Columns that were computed from others, and the run without them."""

from odometry.checks.copies.computed_poses import computed_poses
from odometry.checks.copies.copied_turns import copied_turns, without_gyroscope
from odometry.checks.copies.copied_yaw import copied_yaw
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding
from odometry.recording.run import Run

NO_GYROSCOPES = frozenset({"gyroscope_is_treads", "gyroscope_is_yaw"})


def copied_columns(run: Run) -> tuple[list[Finding], Evidence]:
    """Findings, and the evidence of the run without columns that repeat others.

    Two columns that are one are no two sensors that agree against a third.
    """
    evidence = Evidence(run)
    found = list(copied_turns(evidence))
    if found:
        evidence = Evidence(without_gyroscope(run))
    if any(computed_poses(evidence)):
        return found, evidence  # yaw and positions alike
    for finding in copied_yaw(evidence):
        found.append(finding)
        if finding.mend is not None:
            evidence = Evidence(finding.mend(evidence.run))
    return found, evidence
