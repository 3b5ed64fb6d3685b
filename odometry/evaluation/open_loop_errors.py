"""How errors of an open-loop odometer add up along its path, to first order.

An error along x, along y or of yaw, made at one place, moves every later pose; one of yaw turns
all of the path after it. There are two kinds. A random error is another one at each step,
independent of those before: its variance grows with the wheel travel and with the angle turned. A
constant error is one unknown factor for the whole path (a tread's scale, a bias): the error itself
grows with the signed distance of the treads and the signed turn. Each of the twelve SOURCES has
one variance; sums along the path give the covariance between any two of its poses.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.blocks import running_sums
from odometry.evaluation.unit_covariances import COLUMNS, turns_by, unit_covariances, weighed
from odometry.geometry.angles import wrap

COMPONENTS = ("x", "y", "yaw")
AMOUNTS = ("per_m", "per_rad")
SOURCES = tuple(
    f"{kind}_{component}_{amount}"
    for kind in ("random", "constant")
    for component in COMPONENTS
    for amount in AMOUNTS
)


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
        first, last : (K,)
            Not decreasing.

        Returns
        -------
        (K, 12, 3, 3)
            By source of variance 1, in the frame of the first pose.
        """
        return np.stack(list(self._units(first, last)), axis=1)

    def covariances(self, variances: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
        """Covariances (K, 3, 3) of motions in the frame of their first pose, by variances (12,)."""
        return weighed(variances, self._units(first, last), len(last))

    def carried(self, start: FloatArray, variances: FloatArray) -> Iterator[FloatArray]:
        """Covariances (k, 3, 3) of all poses in the frame of the path, block by block.

        Parameters
        ----------
        start : (3, 3)
            Of the first pose.
        variances : (12,)
        """
        back, turn = turns_by(-self.poses[:1, 2]), turns_by(self.poses[:1, 2])
        for rows, sums in running_sums(self._amounts, len(self.poses)):
            units = unit_covariances(sums, self._ends(rows), back)
            found = weighed(variances, units, len(sums))
            poses = self.poses[rows]
            by_start = np.tile(np.eye(3), (len(poses), 1, 1))
            by_start[:, 0, 2] = self.poses[0, 1] - poses[:, 1]
            by_start[:, 1, 2] = poses[:, 0] - self.poses[0, 0]
            held = by_start @ start @ np.swapaxes(by_start, -1, -2)
            yield held + turn @ found @ np.swapaxes(turn, -1, -2)

    def _units(self, first: IntArray, last: IntArray) -> Iterator[FloatArray]:
        """`unit_covariances` (K, 3, 3) of one source after the other."""
        at_first, at_last = np.empty((2, len(last), COLUMNS))
        for rows, sums in running_sums(self._amounts, len(self.poses)):
            for found, at in ((at_first, first), (at_last, last)):
                here = slice(*np.searchsorted(at, [rows.start, rows.stop]))
                found[here] = sums[at[here] - rows.start]
        back = turns_by(-self.poses[first, 2])
        return unit_covariances(np.subtract(at_last, at_first, out=at_last), self._ends(last), back)

    def _ends(self, last: IntArray | slice) -> FloatArray:
        return np.asarray(self.poses[last, :2] - self.poses[0, :2])

    def _amounts(self, steps: slice) -> FloatArray:
        """What some steps add to the sums that `unit_covariances` takes, (k, COLUMNS)."""
        poses = self.poses[steps.start : steps.stop + 1]
        turn = np.asarray(wrap(np.diff(poses[:, 2])))
        heading = poses[:-1, 2] + turn / 2
        middle = (poses[1:, :2] + poses[:-1, :2]) / 2 - self.poses[0, :2]
        along = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        rows = slice(steps.start, steps.stop + 1)
        random_by = (np.diff(self.travel_m[rows]), np.abs(turn))
        constant_by = (np.diff(self.signed_m[rows]), turn)
        amounts = [
            by[:, None, None] * direction[:, :, None] * direction[:, None, :]
            for direction in (along, across)
            for by in random_by
        ]
        for by in random_by:
            squares = by[:, None, None] * middle[:, :, None] * middle[:, None, :]
            amounts += [by, by[:, None] * middle, squares]
        amounts += [by[:, None] * direction for direction in (along, across) for by in constant_by]
        for by in constant_by:
            amounts += [by, by[:, None] * middle]
        return np.column_stack([amount.reshape(len(turn), -1) for amount in amounts])

    def moved_by(self, errors: Callable[[slice], FloatArray]) -> Iterator[FloatArray]:
        """How far errors of its steps move each pose, to first order, in the frame of the path.

        Parameters
        ----------
        errors : callable
            Gives those (k, 3, P) of a slice of steps, by P sources: along x, along y [m], of yaw
            [rad], in the robot frame at the middle of each step.

        Yields
        ------
        (k, 3, P)
            Of the poses, block by block.
        """

        def aside(steps: slice) -> FloatArray:
            poses = self.poses[steps.start : steps.stop + 1]
            heading = poses[:-1, 2] + wrap(np.diff(poses[:, 2])) / 2
            middle = ((poses[1:, :2] + poses[:-1, :2]) / 2)[..., None]
            cosine, sine = np.cos(heading)[:, None], np.sin(heading)[:, None]
            x, y, yaw = np.moveaxis(errors(steps), 1, 0)
            return np.stack(
                [
                    cosine * x - sine * y + middle[:, 1] * yaw,
                    sine * x + cosine * y - middle[:, 0] * yaw,
                    yaw,
                ],
                axis=1,
            )

        for rows, sums in running_sums(aside, len(self.poses)):
            found = sums.copy()
            found[:, 0] -= self.poses[rows, 1, None] * found[:, 2]
            found[:, 1] += self.poses[rows, 0, None] * found[:, 2]
            yield found
