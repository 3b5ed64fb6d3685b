"""How late positions without yaw are beside the treads and the gyroscope.

The path that these two make has the shape of the positions where it is sampled as late as they
are. Late treads alone are told apart: the gyroscope then agrees with the positions as they are.
"""

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.gyroscope_yaw import path_misfit
from odometry.windows.record import Record

LONGEST_S, COARSE_S, FINE_S = 1.0, 0.1, 0.01
LENGTH_M = 20.0  # of the pieces of path that are compared
# Of the misfit as recorded, where positions are late: 0.92 and more in 26 recordings as they are.
CLEARLY = 0.8
BESIDE_TREADS = 0.9  # of the misfit with late treads alone


def positions_late_s(record: Record) -> float:
    """How late positions are beside treads and gyroscope, by at most LONGEST_S; early is negative.

    0 where the positions do not clearly say so, or no gyroscope was recorded.
    """
    rates = record.inputs.yaw_rate_rad_s
    if rates is None:
        return 0.0
    speeds = record.inputs.tread_speeds_m_s.mean(axis=1)
    stamps_s = record.stamps_s

    def misfit(late_s: float, turns_late_s: float) -> float:
        of = _delayed(stamps_s, speeds, late_s), _delayed(stamps_s, rates, turns_late_s)
        return path_misfit(record, *of, LENGTH_M)

    tried = np.arange(-LONGEST_S, LONGEST_S + COARSE_S / 2, COARSE_S)
    coarse = [misfit(late_s, late_s) for late_s in tried]
    best = int(np.argmin(coarse))
    if best in (0, len(tried) - 1) or coarse[best] > CLEARLY * misfit(0.0, 0.0):
        return 0.0
    if coarse[best] > BESIDE_TREADS * min(misfit(late_s, 0.0) for late_s in tried):
        return 0.0
    near = tried[best] + np.arange(-COARSE_S, COARSE_S + FINE_S / 2, FINE_S)
    return float(near[np.argmin([misfit(late_s, late_s) for late_s in near])])


def _delayed(stamps_s: FloatArray, rates: FloatArray, late_s: float) -> FloatArray:
    """Rates (N,) in force from each stamp on, later by some time; means up to the next stamp."""
    summed = np.append(0.0, np.cumsum(rates[:-1] * np.diff(stamps_s)))
    moved = np.interp(stamps_s - late_s, stamps_s, summed)
    return np.append(np.diff(moved) / np.diff(stamps_s), 0.0)
