"""What the velocities of velocity.csv add up to in the windows of the other sensors."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.tables.table import Table

NAMES = ("vx", "vy", "wz")
LONGEST_S, PERIODS = 0.5, 5.0  # between two velocities: across more than both nothing is known
LEAST_ROWS = 20


@dataclass(frozen=True)
class VelocityWays:
    """Integrals over the K windows of `Evidence.motion`, NaN where not measured.

    Attributes
    ----------
    ahead, left : (K,)
        Of vx and vy: metres where the file is in m/s.
    turned : (K,)
        Of wz: radians where the file is in rad/s.
    length : (K,)
        Of the size of both.
    """

    ahead: FloatArray
    left: FloatArray
    turned: FloatArray
    length: FloatArray


def velocity_ways(evidence: Evidence) -> VelocityWays | None:
    """The integrals; None without velocities."""
    table, m = evidence.run.velocity, evidence.motion
    if table is None or len(table) < LEAST_ROWS:
        return None
    vx, vy, wz = (table[name] for name in NAMES)
    columns = (vx, vy, wz, np.hypot(vx, vy))
    return VelocityWays(*(_ways(table, column, m.start_s, m.end_s) for column in columns))


def _ways(table: Table, rates: FloatArray, begin_s: FloatArray, end_s: FloatArray) -> FloatArray:
    """Integrals (K,) of rates (N,) between stamps, by the trapezoidal rule."""
    known = np.isfinite(rates)
    stamps_s, rates = table.stamps_s[known], rates[known]
    if len(stamps_s) < LEAST_ROWS:
        return np.full(len(begin_s), np.nan)
    steps_s = np.diff(stamps_s)
    silent = steps_s > max(LONGEST_S, PERIODS * float(np.median(steps_s)))
    parts = np.where(silent, 0.0, (rates[1:] + rates[:-1]) / 2 * steps_s)
    sums, gaps = (np.append(0.0, np.cumsum(part)) for part in (parts, silent * steps_s))
    of, lost = (
        np.interp(end_s, stamps_s, whole, left=np.nan, right=np.nan)
        - np.interp(begin_s, stamps_s, whole, left=np.nan, right=np.nan)
        for whole in (sums, gaps)
    )
    return np.where(lost > 0, np.nan, of)
