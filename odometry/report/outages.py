"""Lines that are not drawn over stretches of time without measurements."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.pose_watch import OUTAGE_PERIODS, OUTAGE_S


def broken_at_outages(stamps_s: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Measured values with a row of NaN in the middle of each outage, where a line breaks.

    An outage is what the filter takes for one: longer than 2 s and than 10 usual periods.

    Parameters
    ----------
    stamps_s : (N,)
        Rising.
    values : (N,) or (N, K)

    Returns
    -------
    stamps_s : (N + outages,)
    values : (N + outages,) or (N + outages, K)
    """
    if len(stamps_s) < 2:
        return stamps_s, values
    lasts_s = np.diff(stamps_s)
    long = lasts_s > max(OUTAGE_S, OUTAGE_PERIODS * float(np.median(lasts_s)))
    rows = np.flatnonzero(long) + 1
    middles_s = (stamps_s[rows - 1] + stamps_s[rows]) / 2
    return np.insert(stamps_s, rows, middles_s), np.insert(values, rows, np.nan, axis=0)
