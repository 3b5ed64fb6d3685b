"""Measured yaw that knows a few directions alone."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level

LEAST_STEP_RAD = np.radians(4.0)
FEWEST, TIMES = 4, 8  # directions, and rows for each of them
MANY = 20  # directions that are no multiples of a large step by chance, with any number of rows
ROUNDED_RAD = 1e-3  # of the digits of a log


def coarse_yaw(evidence: Evidence) -> Iterator[Finding]:
    """All of yaw is a multiple of one large step, apart from a constant."""
    if not evidence.yaw_measured or evidence.run.pose is None:
        return
    yaw = evidence.run.pose["yaw"]
    yaw = yaw[np.isfinite(yaw)]
    yaw = np.radians(yaw) if evidence.yaw_in_degrees else yaw
    found = (_directions(yaw), _directions(yaw % (2 * np.pi)))
    known = next((one for one in found if one is not None), None)
    if known is None:
        return
    count, step_rad = known
    yield Finding(
        "coarse_yaw",
        Level.WARNING,
        f"yaw of pose.csv has {count} directions alone, {np.degrees(step_rad):.3g} degrees apart",
        "Yaw is rounded to coarse steps (a compass of few directions, a log of sectors)",
        "Leave yaw empty, or log it with its digits",
    )


def _directions(yaw: FloatArray) -> tuple[int, float] | None:
    """How many directions yaw (M,) has and the step between them [rad]; None where it has many.

    A full turn need not be a multiple of the step: as written and within a turn are two questions.
    """
    values = np.unique(np.round(yaw / ROUNDED_RAD)) * ROUNDED_RAD
    if len(values) < FEWEST or len(yaw) / TIMES < len(values) < MANY:
        return None
    apart = np.diff(values)
    apart = apart[apart > 2 * ROUNDED_RAD]  # two roundings of one direction
    if len(apart) < FEWEST - 1:
        return None
    step_rad = float(apart.min())
    counts = apart / step_rad
    off = np.abs(counts - np.round(counts)) * step_rad
    exact = bool((off <= 3 * ROUNDED_RAD * counts).all())
    return (len(apart) + 1, step_rad) if exact and step_rad >= LEAST_STEP_RAD else None
