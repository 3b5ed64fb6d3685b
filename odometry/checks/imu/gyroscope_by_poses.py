"""Turns of the gyroscope against those of the poses: a scale, and headings that part."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import Relation
from odometry.checks.turns.heading_spans import heading_spans
from odometry.checks.turns.turn_signs import lasting_turn_rad

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
        f"headings of gyroscope and poses differ by {np.degrees(off):.0f} degrees or more within "
        f"{np.median(spans.lasts_s):.0f} s, in one of ten such spans"
    )
