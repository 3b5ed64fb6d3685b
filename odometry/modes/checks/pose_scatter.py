"""Poses that scatter more than in the runs from which modes were identified.

A filter that trusts poses too far takes their noise for motion of no mode. Noise changes from pose
to pose, what a mode does wrong lasts: so the noise is what is left of a pose less what is left of
the one before.
"""

import numpy as np

from odometry.arrays import FloatArray
from odometry.modes.models.innovation_test import Innovations

WINDOW_S, EVERY_S = 10.0, 1.0
LEAST_POSES = 10  # of a window
MOST_ALIKE = 0.5  # correlation of what is left of neighbours: more is motion of another mode
MEDIAN_OF_SIGMA = 0.6745  # of the size of a normal deviate
POSE = slice(0, 3)  # place and yaw among what traction modes measure


def pose_scatter(innovations: Innovations) -> FloatArray:
    """How many times as far (N,) poses scatter as the modes expect; NaN: undetermined.

    Over the last WINDOW_S before each stamp, by the median of the most probable mode's innovations.

    Parameters
    ----------
    innovations : Innovations
        Of traction modes: pose and yaw rate.
    """
    left = innovations.of_leading[:, POSE]
    rows = np.flatnonzero(np.isfinite(left).all(axis=1))
    stamps_s, left = innovations.stamps_s, left[rows]
    ends_s = np.arange(stamps_s[0] + WINDOW_S, stamps_s[-1], EVERY_S)
    found = np.full(len(ends_s) + 1, np.nan)
    first = np.searchsorted(stamps_s[rows], ends_s - WINDOW_S)
    after = np.searchsorted(stamps_s[rows], ends_s, side="right")
    for place, (begin, end) in enumerate(zip(first, after, strict=True)):
        if end - begin >= LEAST_POSES:
            found[place] = _scatter(left[begin:end])
    # the last place, undetermined, is of stamps before the first window
    return np.asarray(found[np.searchsorted(ends_s, stamps_s, side="right") - 1])


def _scatter(left: FloatArray) -> float:
    """Of the innovations (K, 3) of neighbouring poses, in their standard deviations."""
    together = float((left[1:] * left[:-1]).sum() / max(float((left**2).sum()), 1e-12))
    if together > MOST_ALIKE:
        return float("nan")
    return float(np.median(np.abs(np.diff(left, axis=0))) / MEDIAN_OF_SIGMA / np.sqrt(2.0))
