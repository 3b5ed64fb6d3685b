"""How errors of an open-loop odometer add up along its path, to first order.

An error along x, along y or of yaw, made at one place, moves every later pose; one of yaw turns
all of the path after it. There are two kinds. A random error is another one at each step,
independent of those before: its variance grows with the wheel travel and with the angle turned. A
constant error is one unknown factor for the whole path (a tread's scale, a bias): the error itself
grows with the signed distance of the treads and the signed turn. Each of the twelve SOURCES has
one variance; sums along the path give the covariance between any two of its poses.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.geometry.angles import wrap

COMPONENTS = ("x", "y", "yaw")
AMOUNTS = ("per_m", "per_rad")
SOURCES = tuple(
    f"{kind}_{component}_{amount}"
    for kind in ("random", "constant")
    for component in COMPONENTS
    for amount in AMOUNTS
)
TOGETHER = 4096  # poses whose matrices are multiplied at a time


@dataclass(frozen=True)
class OpenLoopPath:
    """A path reckoned without correction, and what its treads travelled.

    Attributes
    ----------
    poses : (N, 3)
        x, y [m], yaw [rad].
    travel_m, signed_m : (N,)
        Wheel travel, the integral of (|v_left| + |v_right|) / 2, and the integral of
        (v_left + v_right) / 2, at each pose.
    """

    poses: FloatArray
    travel_m: FloatArray
    signed_m: FloatArray

    def unit_covariances(self, first: IntArray, last: IntArray) -> FloatArray:
        """Covariances (K, 12, 3, 3) of the motion from some poses to later ones.

        Parameters
        ----------
        first : (K,) or (1,)
        last : (K,)

        Returns
        -------
        (K, 12, 3, 3)
            By source of variance 1, in the frame of the first pose.
        """
        return np.stack(list(self._units(first, last)), axis=1)

    def _units(self, first: IntArray, last: IntArray) -> Iterator[FloatArray]:
        """`unit_covariances` (K, 3, 3) of one source after the other."""
        turn = np.asarray(wrap(np.diff(self.poses[:, 2])))
        heading = self.poses[:-1, 2] + turn / 2
        middle = (self.poses[1:, :2] + self.poses[:-1, :2]) / 2 - self.poses[0, :2]
        ends = self.poses[last, :2] - self.poses[0, :2]
        along = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        back = _turns(-self.poses[first, 2])

        def of_first(world: FloatArray) -> FloatArray:
            for some in (slice(at, at + TOGETHER) for at in range(0, len(world), TOGETHER)):
                own = back[some] if len(back) > 1 else back
                world[some] = own @ world[some] @ np.swapaxes(own, -1, -2)
            return world

        random_by = (np.diff(self.travel_m), np.abs(turn))
        for direction in (along, across):
            for by in random_by:
                squares = by[:, None, None] * direction[:, :, None] * direction[:, None, :]
                yield of_first(_of_places(_between(squares, first, last)))
        for by in random_by:
            yield of_first(_random_yaw(by, middle, ends, first, last))
        constant_by = (np.diff(self.signed_m), turn)
        for direction in (along, across):
            for by in constant_by:
                moved = _between(by[:, None] * direction, first, last)
                yield of_first(_of_places(moved[:, :, None] * moved[:, None, :]))
        for by in constant_by:
            turned = _between(by, first, last)
            lever = ends * turned[:, None] - _between(by[:, None] * middle, first, last)
            error = np.column_stack([-lever[:, 1], lever[:, 0], turned])
            yield of_first(error[:, :, None] * error[:, None, :])

    def covariances(self, variances: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
        """Covariances (K, 3, 3) of motions in the frame of their first pose, by variances (12,)."""
        found = np.zeros((len(last), 3, 3))
        for variance, unit in zip(variances, self._units(first, last), strict=True):
            found += np.multiply(unit, variance, out=unit)
        return found

    def moved_by(self, errors: FloatArray) -> FloatArray:
        """How far errors of its steps move each pose, to first order, in the frame of the path.

        Parameters
        ----------
        errors : (N - 1, 3)
            Along x, along y [m], of yaw [rad], in the robot frame at the middle of each step.

        Returns
        -------
        (N, 3)
        """
        heading = self.poses[:-1, 2] + wrap(np.diff(self.poses[:, 2])) / 2
        middle = (self.poses[1:, :2] + self.poses[:-1, :2]) / 2
        cosine, sine = np.cos(heading), np.sin(heading)
        aside = np.column_stack(
            [
                cosine * errors[:, 0] - sine * errors[:, 1] + middle[:, 1] * errors[:, 2],
                sine * errors[:, 0] + cosine * errors[:, 1] - middle[:, 0] * errors[:, 2],
                errors[:, 2],
            ]
        )
        found = np.concatenate([np.zeros((1, 3)), np.cumsum(aside, axis=0)])
        found[:, 0] -= self.poses[:, 1] * found[:, 2]
        found[:, 1] += self.poses[:, 0] * found[:, 2]
        return found

    def carried(self, start: FloatArray, variances: FloatArray) -> FloatArray:
        """Covariances (N, 3, 3) of all poses in the frame of the path.

        Parameters
        ----------
        start : (3, 3)
            Of the first pose.
        variances : (12,)
        """
        count = len(self.poses)
        found = self.covariances(variances, np.zeros(1, np.int64), np.arange(count))
        turn = _turns(self.poses[:1, 2])
        for some in (slice(at, at + TOGETHER) for at in range(0, count, TOGETHER)):
            poses = self.poses[some]
            by_start = np.tile(np.eye(3), (len(poses), 1, 1))
            by_start[:, 0, 2] = self.poses[0, 1] - poses[:, 1]
            by_start[:, 1, 2] = poses[:, 0] - self.poses[0, 0]
            held = by_start @ start @ np.swapaxes(by_start, -1, -2)
            found[some] = held + turn @ found[some] @ np.swapaxes(turn, -1, -2)
        return found


def _of_places(covariances: FloatArray) -> FloatArray:
    """Covariances (K, 2, 2) of x and y as (K, 3, 3), of a yaw that is known."""
    found = np.zeros((len(covariances), 3, 3))
    found[:, :2, :2] = covariances
    return found


def _random_yaw(
    variance: FloatArray, middle: FloatArray, ends: FloatArray, first: IntArray, last: IntArray
) -> FloatArray:
    """Covariances (K, 3, 3) by independent errors of yaw: each turns what comes after it."""
    total = _between(variance, first, last)[:, None, None]
    weighted = _between(variance[:, None] * middle, first, last)
    squares = _between(
        variance[:, None, None] * middle[:, :, None] * middle[:, None, :], first, last
    )
    crossed = ends[:, :, None] * weighted[:, None, :]
    lever = total[:, 0] * ends - weighted
    levers = total * ends[:, :, None] * ends[:, None, :] - crossed
    levers += squares - np.swapaxes(crossed, -1, -2)
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    found = np.zeros((len(last), 3, 3))
    found[:, :2, :2] = quarter @ levers @ quarter.T
    found[:, :2, 2] = found[:, 2, :2] = lever @ quarter.T
    found[:, 2, 2] = total[:, 0, 0]
    return found


def _between(steps: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
    """Sums of steps (N - 1, ...) from some samples (K,) to later ones (K,)."""
    running = np.concatenate([np.zeros((1, *steps.shape[1:])), np.cumsum(steps, axis=0)])
    return np.asarray(running[last] - running[first])


def _turns(yaw: FloatArray) -> FloatArray:
    """Rotations (K, 3, 3) of x and y by yaw (K,); the third entry stays."""
    turns = np.zeros((len(yaw), 3, 3))
    turns[:, 0, 0] = turns[:, 1, 1] = np.cos(yaw)
    turns[:, 0, 1], turns[:, 1, 0] = -np.sin(yaw), np.sin(yaw)
    turns[:, 2, 2] = 1.0
    return turns
