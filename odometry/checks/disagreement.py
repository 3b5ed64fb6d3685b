"""Sensors of the same motion, and headings, that differ where no known cause explains it."""

from collections.abc import Iterator, Sequence

import numpy as np

from odometry.checks.beyond_slip import beyond_slip
from odometry.checks.carried import carried_along
from odometry.checks.constancy import uneven_map, uneven_yaw
from odometry.checks.course_offsets import course_apart, yaw_wanders
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level, disagreement
from odometry.checks.gyroscope import drifts_at_rest
from odometry.checks.heading_spans import heading_spans
from odometry.checks.little_explained import little_explained
from odometry.checks.once import once
from odometry.checks.position_differences import (
    paths_apart,
    positions_apart,
    positions_apart_everywhere,
)
from odometry.checks.proportion import holds_the_mean, one_side_not_proportional, treads_unlike
from odometry.checks.relation import Relation
from odometry.checks.repeated_rows import repeated_rows
from odometry.checks.scale_drift import scale_drifts
from odometry.checks.tread_samples import peaks_often
from odometry.checks.turn_signs import Sense, gyroscope_sense, lasting_turn_rad, pose_sense
from odometry.checks.turns_in_parts import turns_flip
from odometry.checks.yaw_drift import course_drifts

POOR = 0.6  # correlation below which sensors do not measure the same motion
LEAST_WINDOWS = 15
OR_TREADS = "; or the columns of the treads are at fault"  # where nothing else goes with them
SHARP, ALIKE = 0.3, 0.3  # of the sharpest turns, and of those to the other side


def sensors_disagree(evidence: Evidence, found: Sequence[Finding]) -> Iterator[Finding]:
    """One warning where sensors differ and nothing `found` explains it."""
    if any(finding.level is not Level.NOTE for finding in found):
        return
    seen = [*lasting_disagreements(evidence), uneven_map(evidence), peaks_often(evidence)]
    if not any(finding.name == "slip_episodes" for finding in found):
        seen.append(positions_apart(evidence))
    if any(seen):
        yield disagreement("; ".join(filter(None, seen)))


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
        one_side_not_proportional(evidence),
        holds_the_mean(evidence),
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


def agreement(evidence: Evidence) -> Iterator[Finding]:
    """Turns of treads, gyroscope and poses that have little to do with each other."""
    gyroscope, pose = gyroscope_sense(evidence), pose_sense(evidence)
    by_gyroscope = evidence.pose_turn_by_gyroscope
    together = by_gyroscope is not None and by_gyroscope.explained > POOR
    unrelated = Sense.UNRELATED
    if _is_magnitude(evidence):
        swapped = "; or left and right treads are exchanged for a part of the recording"
        yield _finding(
            "gyroscope_unrelated",
            "gyro_z is never negative, though the "
            f"{'poses' if evidence.yaw_measured else 'treads'} turn to both sides",
            "gyro_z holds the size of the turn rate: its sign was lost"
            + ("" if evidence.yaw_measured else swapped),
            "Log the yaw rate with its sign",
        )
    elif unrelated in (pose, gyroscope) and (flips := turns_flip(evidence)):
        yield disagreement(flips)
    elif pose is unrelated and by_gyroscope and together:
        slips = "" if beyond_slip(evidence) else ", or the treads slip all the time"
        yield _finding(
            "treads_unrelated",
            f"turns by gyroscope and poses agree (correlation {by_gyroscope.correlation:.2f}), the "
            "treads' do not",
            "The cause cannot be determined: odometry.csv is of another recording or another "
            "clock, its columns are exchanged (v_left and v_right may hold speed and turn rate) or "
            f"hold no tread speeds (numbers that wrapped, a rate of them){slips}",
            "Plot the three yaw rates: check --picture",
        )
    elif pose is unrelated and _moves(evidence.pose_turn_by_treads):
        yield _finding(
            "poses_unrelated",
            f"turns of pose.csv have nothing to do with those of the treads (correlation "
            f"{evidence.pose_turn_by_treads.correlation:.2f})"
            if evidence.pose_turn_by_treads
            else "",
            "pose.csv or odometry.csv is of another recording or another clock, its rows are out "
            "of order or were lost, or yaw is no heading (the course over ground, a component of a "
            f"quaternion, another axis, noise){'' if gyroscope is Sense.AGREES else OR_TREADS}",
            "Plot the three yaw rates: check --picture",
        )
    elif gyroscope is unrelated and _moves(evidence.gyroscope_by_treads) and not together:
        agreed = pose in (Sense.AGREES, Sense.OPPOSITE)
        yield _finding(
            "gyroscope_unrelated",
            "gyro_z has little to do with the turns of "
            + ("treads and poses" if agreed else "the treads"),
            "gyro_z is of another axis (z is not up), another recording or another clock, or it "
            "holds no turn rate (a magnitude, its change, a component along a fixed direction)"
            + ("" if agreed else f"{OR_TREADS}, or slip all the time"),
            "State the axes of the sensor in [sensors] imu; check --picture shows the yaw rates",
        )


def _is_magnitude(evidence: Evidence) -> bool:
    """Whether a yaw rate is never negative, and as large in turns to one side as to the other."""
    m = evidence.motion if evidence.yaw_measured else evidence.uniform
    others = evidence.pose_turn_rad if evidence.yaw_measured else m.difference_m
    known = np.isfinite(others) & np.isfinite(m.gyroscope_rad)
    if evidence.yaw_rate is None or evidence.yaw_rate[1].min() < 0 or not known.any():
        return False
    turns, others = m.gyroscope_rad[known], others[known]
    sharp = SHARP * np.quantile(np.abs(others), 0.95)
    sides = [turns[side * others > sharp] for side in (-1, 1)]
    if min(map(len, sides)) < LEAST_WINDOWS:
        return False
    middles = sorted(float(np.median(side)) for side in sides)
    return middles[0] > ALIKE * middles[1]


def _moves(found: Relation | None) -> bool:
    return found is not None and found.measured >= LEAST_WINDOWS


def yaw_against_course(evidence: Evidence) -> Iterator[Finding]:
    """Yaw that fits neither the course nor the course reversed, though positions are good."""
    if evidence.heading is not None or not evidence.yaw_measured:
        return
    distance = evidence.distance_by_mean
    if distance is None or distance.correlation < 0.9 or distance.measured < 3 * LEAST_WINDOWS:
        return
    if pose_sense(evidence) is not Sense.UNRELATED:
        return
    if evidence.best_concentration is None or evidence.best_concentration > POOR:
        return
    yield _finding(
        "yaw_unrelated",
        "distances of pose.csv agree with the treads (correlation "
        f"{distance.correlation:.2f}), but yaw points nowhere near the course (concentration "
        f"{evidence.best_concentration:.2f})",
        "The column yaw holds something else than the heading, all along or in a part (a component "
        "of a quaternion, another axis, another unit, a bearing, an angle without its sign)",
        "Leave yaw empty, or convert it",
    )


def _finding(name: str, seen: str, cause: str, remedy: str) -> Finding:
    return Finding(name, Level.WARNING, seen, cause, remedy)


SPANS_S = (15.0, 5.0, 1.5)  # over which headings of gyroscope and poses are compared
APART_RAD = 0.3  # good recordings stay below 0.21 (nine in ten spans)
OF_TURN = 0.03  # of all turns within a span, by which a gyroscope may differ
LEAST_SPANS_S = 10.0
SCALE, SMALL_SCALE = 0.1, 0.03  # of the turns, by which gyroscope and measured yaw differ
CORRELATED = 0.9
CLOSELY = 0.99  # noise of a gyroscope lowers its ratio by two hundredths there, at most
CERTAIN = 5.0  # standard deviations
LEAST_SCALED_RAD = 1.0  # range of the heading from which the ratio of a gyroscope is compared


def scales_apart(evidence: Evidence) -> str:
    """Turns of gyroscope and poses that have a constant ratio other than one."""
    fit = _turn_ratio(evidence, SCALE, CORRELATED)
    tilted = " (a scale of either, or an axis that is tilted)"
    return "" if fit is None else _ratio_words(fit) + tilted


def gyroscope_scale(evidence: Evidence) -> Iterator[Finding]:
    """A ratio nearer to one than `scales_apart` asks: a robot is as wrong in each of its turns."""
    fit = _turn_ratio(evidence, SMALL_SCALE, CLOSELY)
    if fit is None or scales_apart(evidence):
        return
    tilt = np.degrees(np.arccos(min(1 / fit.slope, 1.0)))
    tilted = f", or its axis is tilted by {tilt:.0f} degrees" if fit.slope > 1 else ""
    yield Finding(
        "gyroscope_scale",
        Level.NOTE,
        _ratio_words(fit),
        f"The gyroscope has a wrong scale{tilted}; or the yaw of the poses has one",
        f"Multiply gyro_z by {fit.slope:.3f} if the yaw of the poses is right",
    )


def _turn_ratio(evidence: Evidence, apart: float, correlated: float) -> Relation | None:
    """Measured turns by those of the gyroscope, where these surely differ by more than a share."""
    fit = evidence.pose_turn_by_gyroscope
    if fit is None or not fit.distinct or fit.correlation < correlated:
        return None
    if not evidence.yaw_measured or abs(fit.slope - 1) < apart + CERTAIN * fit.slope_sigma:
        return None
    if lasting_turn_rad(evidence.pose_turn_rad, evidence.motion.lasts_s) < LEAST_SCALED_RAD:
        return None
    return fit


def _ratio_words(fit: Relation) -> str:
    times = f"{fit.slope:.3f} +- {fit.slope_sigma:.3f} times"
    return f"measured yaw turns by {times} what the gyroscope turns"


def headings_apart(evidence: Evidence) -> str:
    """Headings of gyroscope and poses that part within some seconds, apart from scale and bias."""
    spans, fit = heading_spans(evidence, *SPANS_S), evidence.pose_turn_by_gyroscope
    if spans is None or fit is None:
        return ""
    if np.ptp(spans.start_s) < LEAST_SPANS_S:
        return ""
    expected = fit.slope * spans.gyroscope_rad + fit.coefficients[1] * spans.lasts_s
    apart = np.abs(spans.pose_rad - expected) - OF_TURN * spans.turned_rad
    off = float(np.quantile(apart, 0.9))
    if off < APART_RAD:
        return ""
    return (
        f"headings of gyroscope and poses part by {np.degrees(off):.0f} degrees within "
        f"{np.median(spans.lasts_s):.0f} s (in one of ten spans)"
    )
