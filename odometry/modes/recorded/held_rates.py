"""Yaw rates that are one reading held: a gyroscope that stopped answers nothing."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.windows.recorded.spans import runs_of

CHANCE = 1e-9  # of so many repeated readings in a row, by how often the others are repeated
LEAST_OTHERS = 30  # readings that say how often


def held_rates(yaw_rates: FloatArray, tread_speeds_m_s: FloatArray) -> BoolArray:
    """Where (N,) a reading repeats the one before it more often in a row than readings do.

    A gyroscope of few digits, or slower than the rows, repeats readings as well, and so does one
    without noise while the treads keep their speeds: the chance of a stretch is by how often
    readings outside it are the same as the one before, where the treads are and where they are not.

    Parameters
    ----------
    yaw_rates : (N,)
        NaN where not measured.
    tread_speeds_m_s : (N, 2)

    Examples
    --------
    >>> import numpy as np
    >>> from odometry.modes.recorded.held_rates import held_rates
    >>> rates = np.append(np.sin(np.arange(50.0)), np.full(20, 0.3))
    >>> np.flatnonzero(held_rates(rates, np.sin(np.arange(140.0)).reshape(70, 2)))[[0, -1]].tolist()
    [51, 69]
    """
    known = np.flatnonzero(np.isfinite(yaw_rates))
    held = np.zeros(len(yaw_rates), dtype=np.bool_)
    same = np.diff(yaw_rates[known]) == 0
    keep = (np.diff(tread_speeds_m_s[known], axis=0) == 0).all(axis=1)
    sums = [np.append(0, np.cumsum(of)) for of in (keep, ~keep, keep & same, ~keep & same)]
    for first, after in runs_of(same):
        in_it = np.array([of[after] - of[first] for of in sums[:2]])
        others = np.array([of[-1] for of in sums[:2]]) - in_it
        repeated = np.array([of[-1] for of in sums[2:]]) - in_it
        counts = others >= LEAST_OTHERS
        # the rule of succession
        log_chance = np.log((repeated[counts] + 1) / (others[counts] + 2))
        if in_it[counts] @ log_chance < np.log(CHANCE):
            held[known[first + 1 : after + 1]] = True
    return held
