"""Stretches of time that odometry.csv does not cover, and clocks that were set."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level

OFTEN = 20
LONG_S, LONG_PERIODS = 1.0, 20.0  # a hold longer than both may be a gap
MISSED_M = 0.3  # of motion that the held speeds do not have
STOOD = 0.3  # share of the motion at the held speed below which the robot stood: the clock was set


def gaps(evidence: Evidence) -> Iterator[Finding]:
    """Long holds of odometry.csv that other files contradict, else with the treads turning."""
    stamps_s = evidence.stamps_s
    lasts_s = np.diff(stamps_s)
    long = np.flatnonzero(lasts_s > max(LONG_S, LONG_PERIODS * evidence.period_s))
    found = [(row, _what(evidence, row)) for row in long.tolist()]
    if len(long) > OFTEN and float(lasts_s[long].sum()) > 0.2 * evidence.duration_s:
        yield Finding(
            "uneven_stamps",
            Level.WARNING,
            f"rows of odometry.csv come in {len(long)} bursts, {lasts_s[long].max():.2f} s apart "
            f"at most, while the usual period is {evidence.period_s:.3f} s",
            "Stamps are those of arrival: rows were sent in bursts (buffered), not when they were "
            "measured",
            "Use the stamps of the sensor (header time), or spread the rows evenly",
        )
    for kind, name, cause, remedy in (
        (
            "lost",
            "odometry_gap",
            "Rows of odometry.csv are lost: a true gap (the logger or the bus stopped)",
            "Windows do not cross it; cut with --from and --to",
        ),
        (
            "clock",
            "clock_set",
            "The clock jumps: it was set ahead while recording (time synchronisation), or the "
            "recording was paused",
            "Cut the recording there with --from and --to",
        ),
    ):
        rows = [row for row, what in found if what == kind]
        if rows:
            yield Finding(
                name,
                Level.WARNING,
                f"odometry.csv has no rows for {sum(lasts_s[row] for row in rows):.1f} s in "
                f"{len(rows)} places (first for {lasts_s[rows[0]]:.2f} s at "
                f"{evidence.run_time_s(stamps_s[rows[0]]):.1f} s) while the robot "
                + ("moves differently" if kind == "lost" else "does not move on"),
                cause,
                remedy,
                tuple(
                    (evidence.run_time_s(stamps_s[row]), evidence.run_time_s(stamps_s[row + 1]))
                    for row in rows
                ),
            )


def _what(evidence: Evidence, row: int) -> str:
    """Say "lost", "clock" (it was set), or "held": a speed that holds in a log of changes."""
    begin_s, end_s = evidence.stamps_s[row], evidence.stamps_s[row + 1]
    speeds = evidence.speeds_m_s[row]
    moved = _moved_m(evidence, begin_s, end_s)
    held_m = float(np.abs(speeds).mean() * (end_s - begin_s))
    if moved is None:
        return "lost" if np.abs(speeds).max() > 0.1 * evidence.fastest_m_s else "held"
    if _others_go_on(evidence, begin_s, end_s):
        return "lost" if _differs_m(evidence, row, moved) else "held"
    scale = evidence.metres_per_metre or 1.0
    along_m = float(abs(speeds.mean()) * (end_s - begin_s)) * scale
    if held_m * scale > MISSED_M and along_m > MISSED_M and moved < STOOD * along_m:
        return "clock"
    return "lost" if abs(moved - along_m) > MISSED_M + 0.3 * along_m else "held"


def _others_go_on(evidence: Evidence, begin_s: float, end_s: float) -> bool:
    """Whether poses go on meanwhile at their usual pace."""
    if evidence.run.pose is None:
        return False
    pose_s = evidence.run.pose.stamps_s
    inside = int(np.sum((pose_s > begin_s) & (pose_s < end_s)))
    return inside > 0.5 * (end_s - begin_s) / float(np.median(np.diff(pose_s)))


def _differs_m(evidence: Evidence, row: int, moved_m: float) -> bool:
    """Whether the way of the poses in a hold differs from that at the held speed."""
    begin_s, end_s = evidence.stamps_s[row], evidence.stamps_s[row + 1]
    assert evidence.run.pose is not None  # noqa: S101 - the caller has looked
    pose_s = evidence.run.pose.stamps_s
    inside = (pose_s >= begin_s) & (pose_s <= end_s) & np.isfinite(evidence.run.pose["x"])
    steps = np.diff(evidence.run.pose.stack("x", "y")[inside], axis=0)
    way_m = float(np.sum(np.hypot(*steps.T)))
    scale = evidence.metres_per_metre or 1.0
    held_m = float(abs(evidence.speeds_m_s[row].mean()) * (end_s - begin_s)) * scale
    return (
        abs(way_m - held_m) > MISSED_M + 0.3 * held_m or abs(moved_m - held_m) > 1.0 + 0.5 * held_m
    )


def _moved_m(evidence: Evidence, begin_s: float, end_s: float) -> float | None:
    """Distance between the measured positions nearest to two stamps; None without."""
    if evidence.run.pose is None or evidence.poses_used is None:
        return None
    rows = np.flatnonzero(evidence.poses_used)
    pose_s = evidence.run.pose.stamps_s[rows]
    first = int(np.clip(np.searchsorted(pose_s, begin_s, side="right") - 1, 0, len(rows) - 1))
    last = int(np.clip(np.searchsorted(pose_s, end_s), 0, len(rows) - 1))
    step = evidence.run.pose.stack("x", "y")[[rows[first], rows[last]]]
    return float(np.hypot(*(step[1] - step[0])))
