"""Stretches of time without poses."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level, counted

LEAST_S, LEAST_PERIODS = 5.0, 10.0  # an outage is longer than both
LEAST_M = 1.0  # that the treads travel meanwhile


def pose_outages(evidence: Evidence) -> Iterator[Finding]:
    """A reference that was lost, and said nothing meanwhile."""
    if evidence.run.pose is None or evidence.positions_measured is None:
        return
    stamps_s = evidence.run.pose.stamps_s[evidence.positions_measured]
    inside = (stamps_s >= evidence.stamps_s[0]) & (stamps_s <= evidence.stamps_s[-1])
    stamps_s = stamps_s[inside]
    if len(stamps_s) < 2:
        return
    lasts_s = np.diff(stamps_s)
    driven_m = np.diff(evidence.travel_m(stamps_s))
    long = lasts_s > max(LEAST_S, LEAST_PERIODS * float(np.median(lasts_s)))
    rows = np.flatnonzero(long & (driven_m > LEAST_M))
    if not len(rows):
        return
    spans = [(evidence.run_time_s(stamps_s[i]), evidence.run_time_s(stamps_s[i + 1])) for i in rows]
    yield Finding(
        "pose_outage",
        Level.NOTE,
        f"pose.csv has no positions for {lasts_s[rows].sum():.1f} s in "
        f"{counted(len(rows), 'place')} (first from {spans[0][0]:.1f} s on, for "
        f"{lasts_s[rows[0]]:.1f} s) while the treads travel {driven_m[rows].sum():.3g} m",
        "The reference was lost for a while (an outage), or its rows were",
        "Nothing to do: windows do not cross it, and the filter goes on by the odometer",
        tuple(spans),
    )
