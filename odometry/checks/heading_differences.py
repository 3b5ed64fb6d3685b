"""Headings that part: of gyroscope and poses, of yaw and course."""

import numpy as np

from odometry.checks.evidence import Evidence
from odometry.checks.heading import headings
from odometry.checks.heading_spans import heading_spans
from odometry.checks.turn_signs import lasting_turn_rad

SPANS_S = (15.0, 5.0, 1.5)  # over which headings of gyroscope and poses are compared
APART_RAD = 0.3  # good recordings stay below 0.21 (nine in ten spans)
OF_TURN = 0.03  # of all turns within a span, by which a gyroscope may differ
LEAST_SPANS_S = 10.0
SCALE = 0.1  # of the turns, by which gyroscope and measured yaw differ
CERTAIN = 5.0  # standard deviations
LEAST_SCALED_RAD = 1.0  # range of the heading from which the ratio of a gyroscope is compared
LEAST_WINDOWS = 30
PIECES = 8  # of the recording, in each of which yaw has one offset to the course
PIECE_HELD = 0.9  # concentration in a piece
OFFSETS_RAD = np.radians(25)  # between pieces


def scales_apart(evidence: Evidence) -> str:
    """Turns of gyroscope and poses that have a constant ratio other than one."""
    fit = evidence.pose_turn_by_gyroscope
    if fit is None or not fit.distinct or fit.correlation < 0.9:
        return ""
    if not evidence.yaw_measured or abs(fit.slope - 1) < SCALE + CERTAIN * fit.slope_sigma:
        return ""
    if lasting_turn_rad(evidence.pose_turn_rad, evidence.motion.lasts_s) < LEAST_SCALED_RAD:
        return ""
    return (
        f"measured yaw turns by {fit.slope:.3f} +- {fit.slope_sigma:.3f} times what the gyroscope "
        "turns (a scale of either, or an axis that is tilted)"
    )


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


def yaw_wanders(evidence: Evidence) -> str:
    """Yaw that fits the course in each piece of the recording, with another offset in each."""
    m = evidence.motion
    offsets = []
    count = min(PIECES, len(m) // LEAST_WINDOWS)
    for rows in np.array_split(np.arange(len(m)), max(count, 1)):
        piece = m.rows(rows)
        heading = headings(piece, evidence.turn_rad(piece)).get("radians")
        if heading is not None and heading.concentration > PIECE_HELD:
            offsets.append(heading.offset_rad)
    if len(offsets) < max(count, PIECES) / 2:
        return ""
    middle = np.angle(np.exp(2j * np.array(offsets)).sum()) / 2
    away = np.angle(np.exp(2j * (np.array(offsets) - middle))) / 2
    if np.ptp(away) < OFFSETS_RAD:
        return ""
    return (
        f"yaw of pose.csv fits its course with offsets of {np.degrees(away.min()):+.0f} to "
        f"{np.degrees(away.max()):+.0f} degrees in pieces of the recording"
    )
