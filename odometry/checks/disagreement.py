"""Sensors that speak of one motion and differ, where no cause of the catalogue explains it."""

from collections.abc import Iterator, Sequence

import numpy as np

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.heading import headings
from odometry.checks.turning import lasting_turn_rad

SPAN_S = 15.0  # over which headings of gyroscope and poses are compared
APART_RAD = 0.3  # good recordings stay below 0.21 (nine in ten spans)
OF_TURN = 0.03  # of all turns within a span, by which a gyroscope may differ
LEAST_SPANS = 10
SCALE = 0.1  # of the turns, by which gyroscope and measured yaw differ
CERTAIN = 5.0  # standard deviations
LEAST_TURN_RAD = 3.0  # range of the heading from which turns are compared
LEAST_SCALED_RAD = 1.0  # the same, for the ratio of a gyroscope
ALIKE = 0.3  # share of the changing part of the turns that the treads explain at least
CHANGING = 0.1  # share of the squared turns that changes, from which it is compared
LEAST_WINDOWS = 30
PIECES = 8  # of the recording, in each of which yaw has one offset to the course
PIECE_HELD = 0.9  # concentration in a piece
OFFSETS_RAD = np.radians(25)  # between pieces


def sensors_disagree(evidence: Evidence, found: Sequence[Finding]) -> Iterator[Finding]:
    """One warning where sensors differ and nothing `found` explains it."""
    if any(finding.level is not Level.NOTE for finding in found):
        return
    seen = [
        words
        for words in (
            _scales(evidence),
            _headings_apart(evidence),
            _yaw_wanders(evidence),
            *_treads_unlike(evidence),
        )
        if words
    ]
    if seen:
        yield disagreement("; ".join(seen))


def disagreement(seen: str) -> Finding:
    """The finding where sensors differ and the cause cannot be told."""
    return Finding(
        "sensors_disagree",
        Level.WARNING,
        seen,
        "The cause cannot be told: no single known fault explains it",
        "Look where they part: check --picture",
    )


def _scales(evidence: Evidence) -> str:
    """Turns of gyroscope and poses that have a constant ratio other than one."""
    fit = evidence.pose_turn_by_gyroscope
    if fit is None or not fit.distinct or fit.correlation < 0.9:
        return ""
    if abs(fit.slope - 1) < SCALE + CERTAIN * fit.slope_sigma:
        return ""
    if lasting_turn_rad(evidence.pose_turn_rad, evidence.motion.lasts_s) < LEAST_SCALED_RAD:
        return ""
    return (
        f"measured yaw turns by {fit.slope:.3f} +- {fit.slope_sigma:.3f} times what the gyroscope "
        "turns (a scale of either, or an axis that is tilted)"
    )


def _headings_apart(evidence: Evidence) -> str:
    """Headings of gyroscope and poses that part within some seconds, apart from scale and bias."""
    pose, fit = evidence.run.pose, evidence.pose_turn_by_gyroscope
    if pose is None or evidence.poses_used is None or fit is None or not evidence.yaw_measured:
        return ""
    inside = (pose.stamps_s >= evidence.stamps_s[0]) & (pose.stamps_s <= evidence.stamps_s[-1])
    rows = np.flatnonzero(evidence.poses_used & inside)
    stamps_s = pose.stamps_s[rows]
    turned = evidence.integrals.gyroscope_rad(stamps_s)
    known = np.isfinite(turned)
    rows, stamps_s, turned = rows[known], stamps_s[known], turned[known]
    if len(rows) < LEAST_WINDOWS:
        return ""
    yaw = np.radians(pose["yaw"][rows]) if evidence.yaw_in_degrees else pose["yaw"][rows]
    apart = np.unwrap(yaw - fit.slope * turned - fit.coefficients[1] * stamps_s)
    first = np.arange(len(rows))
    last = np.searchsorted(stamps_s, stamps_s + SPAN_S)
    first = first[(last < len(rows))]
    last = last[first]
    whole = stamps_s[last] - stamps_s[first] < 1.2 * SPAN_S
    if "window" in pose:
        window = np.nan_to_num(pose["window"][rows])
        whole &= window[first] == window[last]
    first, last = first[whole], last[whole]
    if len(first) == 0 or np.ptp(stamps_s[first]) < LEAST_SPANS:
        return ""
    all_turns = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(turned)))])
    allowed = OF_TURN * (all_turns[last] - all_turns[first])
    off = float(np.quantile(np.abs(apart[last] - apart[first]) - allowed, 0.9))
    if off < APART_RAD:
        return ""
    return (
        f"headings of gyroscope and poses part by {np.degrees(off):.0f} degrees within "
        f"{SPAN_S:g} s (in one of ten spans)"
    )


def _yaw_wanders(evidence: Evidence) -> str:
    """Yaw that fits the course in each piece of the recording, with another offset in each."""
    m = evidence.motion
    offsets = []
    for rows in np.array_split(np.arange(len(m)), PIECES):
        piece = m.rows(rows)
        heading = headings(piece, evidence.turn_rad(piece)).get("radians")
        if heading is not None and heading.concentration > PIECE_HELD:
            offsets.append(heading.offset_rad)
    if len(offsets) < PIECES / 2:
        return ""
    middle = np.angle(np.exp(2j * np.array(offsets)).sum()) / 2
    away = np.angle(np.exp(2j * (np.array(offsets) - middle))) / 2
    if np.ptp(away) < OFFSETS_RAD:
        return ""
    return (
        f"yaw of pose.csv fits its course with offsets of {np.degrees(away.min()):+.0f} to "
        f"{np.degrees(away.max()):+.0f} degrees in pieces of the recording"
    )


def _treads_unlike(evidence: Evidence) -> Iterator[str]:
    """Turns, apart from their mean rate, of which the treads explain little."""
    for name, motion, turns in (
        ("the gyroscope", evidence.uniform, evidence.uniform.gyroscope_rad),
        ("the poses", evidence.motion, evidence.pose_turn_rad),
    ):
        columns = np.stack([motion.left_m, motion.right_m, motion.lasts_s, turns], axis=-1)
        known = np.isfinite(columns).all(axis=1)
        if known.sum() < LEAST_WINDOWS:
            continue
        if lasting_turn_rad(turns, motion.lasts_s) < LEAST_TURN_RAD:
            continue
        columns = columns[known]
        whole = float(np.sum(columns[:, 3] ** 2))
        columns = columns - columns.mean(axis=0)
        design, target = columns[:, :3], columns[:, 3]
        if np.sum(target**2) < CHANGING * whole:
            continue  # a steady turn: what changes is slip
        left = target - design @ np.linalg.lstsq(design, target, rcond=None)[0]
        share = 1 - float(np.sum(left**2) / max(np.sum(target**2), 1e-300))
        if share < ALIKE:
            yield (
                f"the treads explain {100 * max(share, 0.0):.0f} % of the changing turns of {name} "
                "(slip alone leaves more on most terrain)"
            )
