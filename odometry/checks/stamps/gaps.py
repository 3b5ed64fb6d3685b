"""Stretches of time that odometry.csv does not cover, and clocks that were set."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.tables.row_values import are_changes
from odometry.windows.recorded.gaps import odometry_gaps

OFTEN = 20
FEW = 0.3  # share of the long holds that are gaps: where there are fewer, it is a log of changes
LONG_S, LONG_PERIODS = 1.0, 20.0  # a hold longer than both may be a gap
MISSED_M = 0.3  # of motion that the held speeds do not have
TURNED_RAD = 0.3  # in a gap: the robot drove on, however little it moved
LOST = "Rows of odometry.csv are lost: a true gap (the logger or the bus stopped)"
BEFORE, CLOSER = 40, 0.9  # rows before a gap, and their period as a share of the usual one
CLOSER_ROWS = "; or their stamps are wrong: rows before it come closer together than elsewhere"
BURST = 0.3  # of the mean time between rows, that the usual one has in bursts, or in changes
MISSING = 0.5  # of the rows that gaps lack, which the whole file lacks at least
AS_LONG = 0.2  # of the gaps, that odometry.csv may end later or earlier than the poses and these
STOOD = 0.3  # share of the motion at the held speed below which the robot stood: the clock was set


def gaps(evidence: Evidence) -> Iterator[Finding]:
    """True gaps of odometry.csv (a hold of a log of changes is none), and clocks that were set."""
    stamps_s = evidence.stamps_s
    lasts_s = np.diff(stamps_s)
    long = np.flatnonzero(lasts_s > max(LONG_S, LONG_PERIODS * evidence.period_s))
    found = odometry_gaps(evidence.run)
    many = len(long) > OFTEN
    of_changes = len(found) < FEW * len(long) or (many and are_changes(evidence.run.odometry))
    was_set = [_clock_was_set(evidence, span) for span in found.spans_s]
    clock, lost = (
        [span for span, was in zip(found.spans_s, was_set, strict=True) if was is kind]
        for kind in (True, False)
    )
    if lost:
        reason = str(found.reasons[0])
        yield _finding(
            evidence,
            "odometry_gap",
            lost,
            level=Level.NOTE if of_changes else Level.WARNING,
            reason=reason,
            cause=_why_lost(evidence, lost),
            remedy="Windows do not cross it; cut with --from and --to",
        )
    if clock:
        yield _finding(
            evidence,
            "clock_set",
            clock,
            level=Level.WARNING,
            reason="the robot does not move on meanwhile",
            cause=("Either rows come in bursts; or the" if _in_bursts(evidence) else "The")
            + " clock jumps: it was set ahead while recording (time synchronisation), or the "
            "recording was paused",
            remedy="Cut the recording there with --from and --to",
        )


def _finding(
    evidence: Evidence,
    name: str,
    spans_s: list[FloatArray],
    *,
    level: Level,
    reason: str,
    cause: str,
    remedy: str,
) -> Finding:
    whole_s = sum(float(end_s - begin_s) for begin_s, end_s in spans_s)
    first_s, first_end_s = spans_s[0]
    return Finding(
        name,
        level,
        f"odometry.csv has no rows for {whole_s:.1f} s in {counted(len(spans_s), 'place')} (first "
        f"for {first_end_s - first_s:.2f} s at {evidence.run_time_s(first_s):.1f} s): {reason}",
        cause,
        remedy,
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in spans_s),
    )


def _why_lost(evidence: Evidence, lost_s: list[FloatArray]) -> str:
    """Rows that are lost are missing in the file; rows whose stamps are wrong are elsewhere in it.

    Where a stretch of stamps goes back, rows that are sorted by time lie between others.
    """
    lasts_s, period_s = np.diff(evidence.stamps_s), evidence.period_s
    if _in_bursts(evidence):
        return (
            "Either rows come in bursts with stamps of arrival, or were logged as the speeds "
            "change; or rows of odometry.csv are lost"
        )
    lacks_s = float(np.sum(lasts_s[lasts_s > 2 * period_s] - period_s))
    if evidence.duration_s - len(lasts_s) * period_s < MISSING * lacks_s:
        return (
            f"Either the stamps are wrong: the file has the {len(lasts_s) + 1} rows that its time "
            "asks for, some of them too close to others (stamps that went back and were sorted, a "
            "clock that ran slow and was set); or rows of odometry.csv are lost, and others came "
            "faster"
        )
    later_s, whole_s = _ends_later_s(evidence), sum(float(e - b) for b, e in lost_s)
    if abs(later_s - whole_s) < AS_LONG * whole_s:
        return (
            "Either the clock of odometry.csv was set ahead there: the file ends "
            f"{later_s:.1f} s after the poses; or its rows are lost, and poses at the end"
        )
    closer = any(_is_closer_before(evidence, begin_s) for begin_s, _ in lost_s)
    return LOST + CLOSER_ROWS * closer


def _ends_later_s(evidence: Evidence) -> float:
    """By how much odometry.csv ends later than the measured poses; 0 without them."""
    if evidence.run.pose is None or evidence.positions_measured is None:
        return 0.0
    measured_s = evidence.run.pose.stamps_s[evidence.positions_measured]
    return float(evidence.stamps_s[-1] - measured_s[-1])


def _in_bursts(evidence: Evidence) -> bool:
    """Whether most rows come far closer to each other than their number asks for."""
    return evidence.period_s < BURST * evidence.duration_s / max(len(evidence.stamps_s) - 1, 1)


def _is_closer_before(evidence: Evidence, begin_s: float) -> bool:
    last = int(np.searchsorted(evidence.stamps_s, begin_s))
    periods_s = np.diff(evidence.stamps_s[max(last - BEFORE, 0) : last + 1])
    return len(periods_s) > 0 and float(np.median(periods_s)) < CLOSER * evidence.period_s


def _clock_was_set(evidence: Evidence, span_s: FloatArray) -> bool:
    """Whether the robot drove before a gap and is at nearly the same pose after it."""
    begin_s, end_s = span_s
    moved = _moved_m(evidence, begin_s, end_s)
    if moved is None or _others_go_on(evidence, begin_s, end_s):
        return False
    row = int(np.searchsorted(evidence.stamps_s, begin_s, side="right")) - 1
    scale = evidence.metres_per_metre or 1.0
    along_m = float(abs(evidence.speeds_m_s[row].mean()) * (end_s - begin_s)) * scale
    if (_turned_rad(evidence, begin_s, end_s) or 0.0) > TURNED_RAD:
        return False  # on the spot
    return along_m > MISSED_M and moved < STOOD * along_m


def _others_go_on(evidence: Evidence, begin_s: float, end_s: float) -> bool:
    """Whether poses go on meanwhile at their usual pace."""
    if evidence.run.pose is None:
        return False
    pose_s = evidence.run.pose.stamps_s
    inside = int(np.sum((pose_s > begin_s) & (pose_s < end_s)))
    return inside > 0.5 * (end_s - begin_s) / float(np.median(np.diff(pose_s)))


def _moved_m(evidence: Evidence, begin_s: float, end_s: float) -> float | None:
    """Distance between the measured positions nearest to two stamps; None without."""
    rows = _rows_beside(evidence, begin_s, end_s)
    if rows is None or evidence.run.pose is None:
        return None
    first, last = evidence.run.pose.stack("x", "y")[list(rows)]
    return float(np.hypot(*(last - first)))


def _turned_rad(evidence: Evidence, begin_s: float, end_s: float) -> float | None:
    """Turn between the measured yaws nearest to two stamps, without sign; None without."""
    rows = _rows_beside(evidence, begin_s, end_s)
    if rows is None or evidence.run.pose is None or not evidence.yaw_measured:
        return None
    around_s = evidence.run.pose.stamps_s[list(rows)]
    if around_s[0] > begin_s or around_s[1] < end_s:
        return None
    turn = float(np.diff(evidence.run.pose["yaw"][list(rows)])[0])
    turn = np.radians(turn) if evidence.yaw_in_degrees else turn
    return float(abs((turn + np.pi) % (2 * np.pi) - np.pi))


def _rows_beside(evidence: Evidence, begin_s: float, end_s: float) -> tuple[int, int] | None:
    """Rows of the poses that are last before and first after a time."""
    if evidence.run.pose is None or evidence.poses_used is None:
        return None
    rows = np.flatnonzero(evidence.poses_used)
    pose_s = evidence.run.pose.stamps_s[rows]
    first = int(np.clip(np.searchsorted(pose_s, begin_s, side="right") - 1, 0, len(rows) - 1))
    last = int(np.clip(np.searchsorted(pose_s, end_s), 0, len(rows) - 1))
    return int(rows[first]), int(rows[last])
