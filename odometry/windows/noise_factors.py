"""Factors of the covariance of dense windows, by which likely variances are found fast.

Each part of the covariance is F F', of an F whose columns are picks, sums or running sums of
residuals: products with it need no matrix product, but for the one of the turns.
"""

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.dense import DenseWindows

ORDER = (0, 4, 1, 2, 3)  # the part of most work last: it meets the smallest products alone


def added_travel_m(scene: DenseWindows) -> FloatArray:
    """Wheel travel (K, n) between poses of each window."""
    travel_m = scene.travel_m[np.searchsorted(scene.time_s, scene.pose_s[scene.windows])]
    return np.asarray(np.diff(travel_m, axis=1))


def wandering_turns(scene: DenseWindows) -> FloatArray:
    """Residuals (K, n, R) that a standard deviation of the yaw of each step makes."""
    motion, added_m = scene.measured, added_travel_m(scene)
    count, steps, _ = motion.shape
    j = np.arange(steps)
    places = np.concatenate([np.zeros((count, 1, 2)), motion[..., :2]], axis=1)
    spread = places[:, None, 1:, :] - places[:, :-1, None, :]  # (K, i, j, 2) from i on
    swing = np.stack([-spread[..., 1], spread[..., 0], np.ones(spread.shape[:-1])], axis=-1)
    swing *= (j[None, :] >= j[:, None])[None, :, :, None]
    swing *= np.sqrt(added_m)[:, :, None, None]
    turns = swing.reshape(count, steps, 3 * steps)
    if scene.reported_turns is None:
        return turns
    return np.concatenate([turns, np.sqrt(added_m)[:, :, None] * np.eye(steps)], axis=-1)


class Factors:
    """F of each of the five variances, of residuals in the order x, y, yaw, gyroscope."""

    def __init__(self, scene: DenseWindows) -> None:
        motion = scene.measured
        self._steps = steps = motion.shape[1]
        of_poses = np.arange(3 * steps).reshape(steps, 3).T.ravel()
        self.order = np.concatenate([of_poses, np.arange(3 * steps, scene.rows_per_window)])
        lever = np.stack([-motion[..., 1], motion[..., 0], np.ones(motion.shape[:2])], axis=1)
        self._lever = lever.reshape(len(scene), 1, -1)
        self._added = np.sqrt(added_travel_m(scene))[..., None]
        self._turns = wandering_turns(scene)[..., self.order]
        self._seconds = np.sqrt(np.diff(scene.pose_s[scene.windows], axis=1))[..., None]

    def times(self, part: int, columns: FloatArray) -> FloatArray:
        """F' (K, c, R) of a part times columns (K, R, C)."""
        steps = self._steps
        x, y, yaw = (columns[:, i * steps : (i + 1) * steps] for i in range(3))
        if part == 0:
            sums = [of.sum(axis=1, keepdims=True) for of in (x, y)]
            return np.concatenate([x, y, *sums], axis=1)
        if part == 1:
            return np.concatenate([self._lever @ columns[:, : 3 * steps], yaw], axis=1)
        if part == 2:
            later = [np.cumsum(of[:, ::-1], axis=1)[:, ::-1] * self._added for of in (x, y)]
            return np.concatenate(later, axis=1)
        if part == 3:
            return np.asarray(self._turns @ columns)
        gyroscope = columns[:, 3 * steps :]
        return np.asarray(gyroscope * self._seconds[:, : gyroscope.shape[1]])

    def score(self, inverse: FloatArray, rows: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Score (5,) and expected information (5, 5) of the variances.

        Parameters
        ----------
        inverse : (K, R, R)
            Of the covariance.
        rows : (K, R)
            Residuals, both in this order.
        """
        weighted = inverse @ rows[..., None]
        score, information = np.zeros(len(ORDER)), np.zeros((len(ORDER), len(ORDER)))
        for count, part in enumerate(ORDER, 1):
            columns = np.ascontiguousarray(self.times(part, inverse).swapaxes(1, 2))
            for other in ORDER[:count]:
                product = self.times(other, columns)
                information[part, other] = information[other, part] = np.vdot(product, product) / 2
            explained = np.trace(product, axis1=1, axis2=2).sum()  # of the part with itself
            own = self.times(part, weighted)
            score[part] = (np.vdot(own, own) - explained) / 2
        return score, information
