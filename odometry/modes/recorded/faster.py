"""Where treads run faster than in any run that modes were identified from."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.windows.recorded.spans import runs_of

MOST_FASTER = 1.2  # times the fastest run of identification: beyond, models are not valid


def faster_than(tread_speeds_m_s: FloatArray, fastest_m_s: float) -> BoolArray:
    """Where (N,) a tread (N, 2) runs far faster than in the fastest run of identification."""
    return np.asarray(np.abs(tread_speeds_m_s).max(axis=1) > MOST_FASTER * fastest_m_s)


def with_faster_spans(
    gaps_s: FloatArray, stamps_s: FloatArray, tread_speeds_m_s: FloatArray, fastest_m_s: float
) -> FloatArray:
    """Gaps (G, 2) and the spans in which a tread runs too fast, in order and apart.

    A filter of poses that is not valid for a while does not know where it is after that: as after a
    gap, its motion begins anew.

    Parameters
    ----------
    gaps_s : (G, 2)
        Between which stamps the speeds are not known.
    stamps_s, tread_speeds_m_s : (N,), (N, 2)
        In force from each stamp to the next.
    fastest_m_s : float
    """
    runs = runs_of(faster_than(tread_speeds_m_s, fastest_m_s))
    after = np.minimum(runs[:, 1], len(stamps_s) - 1)
    found = np.concatenate([gaps_s, np.column_stack([stamps_s[runs[:, 0]], stamps_s[after]])])
    found = found[np.argsort(found[:, 0], kind="stable")]
    united: list[list[float]] = []
    for begin_s, end_s in found.tolist():
        if united and begin_s <= united[-1][1]:
            united[-1][1] = max(united[-1][1], end_s)
        else:
            united.append([begin_s, end_s])
    return np.array(united).reshape(-1, 2)
