"""Rows of odometry.csv that are missing while the robot moves on, as its held speed says."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.recorded.spans import touched

LONG_S = 1.0  # from which a time without rows is noted
# A log of changes has rows at odd times: of an even one 95 in 100 rows follow within two periods.
EVEN, PERIODS, MANY_PERIODS = 0.95, 2.0, 20.0
MOVED_M = 0.3  # by poses, or by the held speed of the faster tread


def silent_rows(evidence: Evidence) -> Iterator[Finding]:
    """Times without rows in an even log, in which the robot moved and nothing contradicts it.

    Where something does, it is a gap of its own name.
    """
    stamps_s, lasts_s = evidence.stamps_s, np.diff(evidence.stamps_s)
    if float(np.quantile(lasts_s, EVEN)) > PERIODS * evidence.period_s:
        return
    long = np.flatnonzero(lasts_s > max(LONG_S, MANY_PERIODS * evidence.period_s))
    begin_s, end_s = stamps_s[long], stamps_s[long + 1]
    known = touched(odometry_gaps(evidence.run).spans_s, begin_s, end_s)
    moves = evidence.travel_m(end_s) - evidence.travel_m(begin_s) > MOVED_M
    rows = np.flatnonzero(~known & (moves | (_moved_m(evidence, begin_s, end_s) > MOVED_M)))
    if not len(rows):
        return
    spans = tuple(
        (evidence.run_time_s(b), evidence.run_time_s(e))
        for b, e in zip(begin_s[rows], end_s[rows], strict=True)
    )
    whole_s = sum(e - b for b, e in spans)
    yield Finding(
        "odometry_silent",
        Level.NOTE,
        f"odometry.csv has no rows for {whole_s:.1f} s in {counted(len(spans), 'place')} (first "
        f"for {spans[0][1] - spans[0][0]:.1f} s at {spans[0][0]:.1f} s) while the robot moves",
        "Rows are lost, or speeds were logged only where they change; the last speed is held "
        "meanwhile, and no other sensor contradicts it by much",
        "Nothing to do where the speed was constant; else cut with --from and --to",
        spans,
    )


def _moved_m(evidence: Evidence, begin_s: FloatArray, end_s: FloatArray) -> FloatArray:
    """Distance (K,) of measured positions between stamps (K,) and others; 0 without poses."""
    pose, used = evidence.run.pose, evidence.poses_used
    if pose is None or used is None or used.sum() < 2:
        return np.zeros(len(begin_s))
    positions = pose.stack("x", "y")[used]
    ends = (
        np.interp(end_s, pose.stamps_s[used], column)
        - np.interp(begin_s, pose.stamps_s[used], column)
        for column in positions.T
    )
    return np.asarray(np.hypot(*ends))
