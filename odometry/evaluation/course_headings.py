"""The heading of a reference that measured positions alone, from its course."""

import numpy as np

from odometry.arrays import FloatArray, IntArray

LEAST_SPREAD = 0.1  # of the reach: positions closer than this give no heading


def course_headings(
    poses: FloatArray,
    true_poses: FloatArray,
    travelled_m: FloatArray,
    rows: IntArray,
    reach_m: float,
) -> FloatArray:
    """Yaw (K,) of a reference at some rows, from the positions around each.

    The part of the trajectory within `reach_m` of wheel travel before and after a row is turned
    onto the reference's positions there by least squares (the plane's case of Umeyama 1991, IEEE
    TPAMI 13(4), without scale). A heading error that grows evenly with travel is 0 at the middle
    of such a part, so that it turns the part's ends against each other and not the part: errors
    measured from this heading are neither hidden by the alignment nor added to by it.

    Parameters
    ----------
    poses, true_poses : (N, 3)
        Of the trajectory and of the reference at the same stamps; the reference's yaw is not read.
    travelled_m : (N,)
        Wheel travel at each stamp, not decreasing.
    rows : (K,)
        Rows at which the heading is wanted.
    reach_m : float

    Returns
    -------
    (K,)
        NaN where either side is shorter than `reach_m`, or where the positions spread over less
        than LEAST_SPREAD of it.
    """
    begins = np.searchsorted(travelled_m, travelled_m[rows] - reach_m - 1e-9)
    ends = np.searchsorted(travelled_m, travelled_m[rows] + reach_m + 1e-9, side="right")
    ours = poses[:, 0] + 1j * poses[:, 1]
    true = true_poses[:, 0] + 1j * true_poses[:, 1]
    ours, true = ours - ours[0], true - true[0]  # smaller numbers, less rounding
    count = ends - begins
    our_mean, true_mean = (_sums(line, begins, ends) / count for line in (ours, true))
    turned = _sums(np.conj(ours) * true, begins, ends) / count - np.conj(our_mean) * true_mean
    variance = _sums(np.abs(true) ** 2, begins, ends) / count - np.abs(true_mean) ** 2
    whole = travelled_m[rows] - travelled_m[0] >= reach_m - 1e-9
    whole &= travelled_m[-1] - travelled_m[rows] >= reach_m - 1e-9
    told = whole & (variance > (LEAST_SPREAD * reach_m) ** 2) & (np.abs(turned) > 0)
    return np.where(told, poses[rows, 2] + np.angle(turned), np.nan)


def _sums(values: FloatArray, begins: IntArray, ends: IntArray) -> FloatArray:
    """Sums (K,) of values from each begin up to, not including, each end."""
    running = np.append(0.0, np.cumsum(values))
    return np.asarray(running[ends] - running[begins])
