"""Measured yaw that knows a few directions alone."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level

LEAST_STEP_RAD = np.radians(4.0)
FEWEST, TIMES = 4, 8  # directions, and rows for each of them
ROUNDED_RAD = 1e-3  # of the digits of a log


def coarse_yaw(evidence: Evidence) -> Iterator[Finding]:
    """All of yaw is a multiple of one large step, apart from a constant."""
    if not evidence.yaw_measured or evidence.run.pose is None:
        return
    yaw = evidence.run.pose["yaw"]
    yaw = yaw[np.isfinite(yaw)]
    yaw = np.radians(yaw) if evidence.yaw_in_degrees else yaw
    values = np.unique(np.round(yaw % (2 * np.pi) / ROUNDED_RAD)) * ROUNDED_RAD
    if not FEWEST <= len(values) <= len(yaw) / TIMES:
        return
    apart = np.diff(values)
    apart = apart[apart > 2 * ROUNDED_RAD]  # two roundings of one direction
    if len(apart) < FEWEST - 1:
        return
    step_rad = float(apart.min())
    counts = apart / step_rad
    off = np.abs(counts - np.round(counts)) * step_rad
    if step_rad < LEAST_STEP_RAD or float(off.max()) > 3 * ROUNDED_RAD * float(counts.max()):
        return
    yield Finding(
        "coarse_yaw",
        Level.WARNING,
        f"yaw of pose.csv has {len(apart) + 1} directions alone, {np.degrees(step_rad):.3g} "
        "degrees apart",
        "Yaw is rounded to coarse steps (a compass of few directions, a log of sectors)",
        "Leave yaw empty, or log it with its digits",
    )
