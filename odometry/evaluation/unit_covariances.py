"""Covariances of motions by sources of variance 1, from sums along a path.

The sources are those of `open_loop_errors`; the sums are taken there, of every step.
"""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.blocks import blocks_of

# columns of the sums: random errors of place, of yaw (variance, by middle, by their products),
# constant errors of place, of yaw (turn, by middle), each by travel and by turn
SIZES = (4, 4, 4, 4, 1, 2, 4, 1, 2, 4, 2, 2, 2, 2, 1, 2, 1, 2)
COLUMNS = sum(SIZES)


def weighed(variances: FloatArray, units: Iterator[FloatArray], count: int) -> FloatArray:
    """Covariances (count, 3, 3) by variances (12,) of sources with unit covariances."""
    found = np.zeros((count, 3, 3))
    for variance, unit in zip(variances, units, strict=True):
        found += np.multiply(unit, variance, out=unit)
    return found


def unit_covariances(
    amounts: FloatArray, ends: FloatArray, back: FloatArray
) -> Iterator[FloatArray]:
    """Covariances (K, 3, 3) of motions by one source after the other, in the frame of the first.

    Parameters
    ----------
    amounts : (K, COLUMNS)
        Sums of `OpenLoopPath._amounts` along each motion.
    ends : (K, 2)
        Where it ends, from the first pose of the path [m].
    back : (K, 3, 3) or (1, 3, 3)
        Rotations into the frames of the first poses.
    """

    def of_first(world: FloatArray) -> FloatArray:
        for some in blocks_of(len(world)):
            own = back[some] if len(back) > 1 else back
            world[some] = own @ world[some] @ np.swapaxes(own, -1, -2)
        return world

    of = iter(np.split(amounts, np.cumsum(SIZES)[:-1], axis=1))
    for _ in range(4):
        yield of_first(_of_places(next(of).reshape(-1, 2, 2)))
    for _ in range(2):
        yield of_first(_random_yaw(next(of), next(of), next(of).reshape(-1, 2, 2), ends))
    for _ in range(4):
        moved = next(of)
        yield of_first(_of_places(moved[:, :, None] * moved[:, None, :]))
    for _ in range(2):
        turned, weighted = next(of), next(of)
        lever = ends * turned - weighted
        error = np.column_stack([-lever[:, 1], lever[:, 0], turned])
        yield of_first(error[:, :, None] * error[:, None, :])


def _of_places(covariances: FloatArray) -> FloatArray:
    """Covariances (K, 2, 2) of x and y as (K, 3, 3), of a yaw that is known."""
    found = np.zeros((len(covariances), 3, 3))
    found[:, :2, :2] = covariances
    return found


def _random_yaw(
    total: FloatArray, weighted: FloatArray, squares: FloatArray, ends: FloatArray
) -> FloatArray:
    """Covariances (K, 3, 3) by independent errors of yaw: each turns what comes after it.

    `total` (K, 1) is the sum of their variances, `weighted` (K, 2) and `squares` (K, 2, 2) the
    sums of these times the middles of their steps and the middles' products.
    """
    crossed = ends[:, :, None] * weighted[:, None, :]
    lever = total * ends - weighted
    levers = total[:, None] * ends[:, :, None] * ends[:, None, :] - crossed
    levers += squares - np.swapaxes(crossed, -1, -2)
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    found = np.zeros((len(ends), 3, 3))
    found[:, :2, :2] = quarter @ levers @ quarter.T
    found[:, :2, 2] = found[:, 2, :2] = lever @ quarter.T
    found[:, 2, 2] = total[:, 0]
    return found


def turns_by(yaw: FloatArray) -> FloatArray:
    """Rotations (K, 3, 3) of x and y by yaw (K,); the third entry stays."""
    turns = np.zeros((len(yaw), 3, 3))
    turns[:, 0, 0] = turns[:, 1, 1] = np.cos(yaw)
    turns[:, 0, 1], turns[:, 1, 0] = -np.sin(yaw), np.sin(yaw)
    turns[:, 2, 2] = 1.0
    return turns
