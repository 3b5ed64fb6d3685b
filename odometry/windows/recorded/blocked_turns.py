"""Stretches in which the treads turn on the spot and the gyroscope reads that nothing turns."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.recorded.spans import runs_of

BLOCKED_S = 5.0  # real robots that slip into a turn stand for up to 4 s
STANDS = 0.1  # share of an ideal drive's turn, up to which the robot does not turn
MEAN_S = 0.5  # over which yaw rates are taken: a robot that is blocked shakes
TURNS_M_S = 0.05  # by which treads differ at least


def blocked_spans(
    stamps_s: FloatArray, speeds_m_s: FloatArray, yaw_rates: FloatArray, track_width: float
) -> FloatArray:
    """Begins and ends (R, 2) [s].

    Parameters
    ----------
    stamps_s : (N,)
    speeds_m_s : (N, 2)
        Of the left and the right tread.
    yaw_rates : (N,)
        [rad/s]; NaN where not measured.
    track_width : float
        [m]
    """
    left, right = speeds_m_s.T
    asked = np.abs(right - left)
    on_the_spot = asked > np.maximum(TURNS_M_S, np.abs(left + right) / 2)
    means = _means(stamps_s, yaw_rates)
    stands = np.abs(means) < STANDS * asked / track_width
    runs = runs_of(on_the_spot & stands)
    spans_s = np.column_stack([stamps_s[runs[:, 0]], stamps_s[runs[:, 1] - 1]])
    long = [
        stamps_s[after - 1] - stamps_s[first] >= BLOCKED_S and _is_read(yaw_rates[first:after])
        for first, after in runs
    ]
    # a mean is of what the robot did on both sides: it stands before and after as well
    around_s = np.array([-MEAN_S / 2, MEAN_S / 2])
    return np.asarray(spans_s[np.array(long, dtype=np.bool_)] + around_s)


def _is_read(yaw_rates: FloatArray) -> bool:
    """Whether they change: a gyroscope that repeats one value says nothing."""
    return bool(np.nanmax(yaw_rates) > np.nanmin(yaw_rates))


def _means(stamps_s: FloatArray, yaw_rates: FloatArray) -> FloatArray:
    """Means (N,) of the rates (N,) that were measured around each stamp; NaN without one."""
    known = np.isfinite(yaw_rates)
    sums, counts = (
        np.append(0.0, np.cumsum(of)) for of in (np.where(known, yaw_rates, 0.0), known)
    )
    first, after = (np.searchsorted(stamps_s, stamps_s + s) for s in (-MEAN_S / 2, MEAN_S / 2))
    after = np.maximum(after, np.arange(len(stamps_s)) + 1)
    count = counts[after] - counts[first]
    return np.where(count > 0, (sums[after] - sums[first]) / np.maximum(count, 1), np.nan)
