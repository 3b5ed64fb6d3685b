"""Sensors of the same motion that differ, where no cause of the catalogue explains it."""

from collections.abc import Iterator, Sequence

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level, disagreement
from odometry.checks.heading_differences import headings_apart, scales_apart, yaw_wanders
from odometry.checks.path_differences import paths_apart
from odometry.checks.position_differences import positions_apart, positions_apart_everywhere
from odometry.checks.proportion import holds_the_mean, one_side_not_proportional, treads_unlike
from odometry.checks.relation import Relation
from odometry.checks.turn_signs import Sense, gyroscope_sense, pose_sense

POOR = 0.6  # correlation below which sensors do not measure the same motion
LEAST_WINDOWS = 15


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


def agreement(evidence: Evidence) -> Iterator[Finding]:
    """Turns of treads, gyroscope and poses that have little to do with each other."""
    gyroscope, pose = gyroscope_sense(evidence), pose_sense(evidence)
    by_gyroscope = evidence.pose_turn_by_gyroscope
    together = by_gyroscope is not None and by_gyroscope.explained > POOR
    unrelated = Sense.UNRELATED
    if pose is unrelated and gyroscope is unrelated and together:
        yield _finding(
            "treads_unrelated",
            f"turns by gyroscope and poses agree (correlation {by_gyroscope.correlation:.2f}), the "
            "treads' do not"
            if by_gyroscope
            else "",
            "odometry.csv is of another recording or another clock, columns are exchanged "
            "(v_left and v_right may hold speed and turn rate), or the treads slip all the time",
            "Plot the three yaw rates: check --picture",
        )
    elif pose is unrelated and _moves(evidence.pose_turn_by_treads):
        yield _finding(
            "poses_unrelated",
            f"turns of pose.csv have nothing to do with those of the treads (correlation "
            f"{evidence.pose_turn_by_treads.correlation:.2f})"
            if evidence.pose_turn_by_treads
            else "",
            "pose.csv is of another recording or another clock, or its yaw is no heading (the "
            "course over ground, a component of a quaternion, another axis)",
            "Plot the three yaw rates: check --picture",
        )
    elif gyroscope is unrelated and _moves(evidence.gyroscope_by_treads) and not together:
        agreed = pose in (Sense.AGREES, Sense.OPPOSITE)
        yield _finding(
            "gyroscope_unrelated",
            "gyro_z has little to do with the turns of "
            + ("treads and poses" if agreed else "the treads"),
            "gyro_z is of another axis (z is not up), another recording or another clock"
            + ("" if agreed else "; or the treads slip all the time"),
            "State the axes of the sensor in [sensors] imu; check --picture shows the yaw rates",
        )


def _moves(found: Relation | None) -> bool:
    return found is not None and found.measured >= LEAST_WINDOWS


def yaw_against_course(evidence: Evidence) -> Iterator[Finding]:
    """Yaw that fits neither the course nor the course reversed, though positions are good."""
    if evidence.heading is not None or not evidence.yaw_measured:
        return
    distance = evidence.distance_by_mean
    if distance is None or distance.correlation < 0.9 or distance.measured < 3 * LEAST_WINDOWS:
        return
    by_gyroscope = evidence.pose_turn_by_gyroscope
    if by_gyroscope is not None and by_gyroscope.correlation > 0.9:
        return
    if evidence.best_concentration is None or evidence.best_concentration > POOR:
        return
    yield _finding(
        "yaw_unrelated",
        "distances of pose.csv agree with the treads (correlation "
        f"{distance.correlation:.2f}), but yaw points nowhere near the course (concentration "
        f"{evidence.best_concentration:.2f})",
        "The column yaw holds something else than the heading (a component of a quaternion, "
        "another axis, another unit)",
        "Leave yaw empty, or convert it",
    )


def _finding(name: str, seen: str, cause: str, remedy: str) -> Finding:
    return Finding(name, Level.WARNING, seen, cause, remedy)
