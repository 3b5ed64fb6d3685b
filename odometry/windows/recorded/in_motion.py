"""Samples and windows in which the robot moves: what is usual is that of motion.

However long it stands beside them: standing still, everything agrees to within noise.
"""

import numpy as np

from odometry.arrays import BoolArray, FloatArray

SPIKE = 3  # samples; a longer one moves the robot
MOVING = 0.2  # of the fastest motion of some samples: less is standing, or its noise
SAYS = 0.05  # of the largest values of a column: less says nothing of its factor
FEWEST = 8  # windows


def moving_samples(sizes: FloatArray) -> BoolArray:
    """Which samples (N,) of speeds or steps are of a robot that moves; all of one that stands."""
    padded = np.pad(sizes, (SPIKE, 0), mode="edge")
    shifted = [padded[first : first + len(sizes)] for first in range(SPIKE + 1)]
    lasting = np.minimum.reduce(shifted)  # of a spike nothing is left
    return np.asarray(lasting >= MOVING * np.quantile(lasting, 0.99))


def moving_windows(columns: FloatArray, fewest: int = FEWEST) -> BoolArray:
    """Windows (K,) in which a column (P, K) is not nearly zero.

    All of them where half of them are, as medians then are of such windows; or fewer than `fewest`.
    """
    sizes = np.abs(columns)
    if sizes.shape[1] < fewest:
        return np.ones(sizes.shape[1], dtype=np.bool_)
    large = np.quantile(sizes, 0.99, axis=1, keepdims=True)
    moves = np.asarray((sizes > SAYS * large).any(axis=0))
    few = fewest <= moves.sum() < len(moves) / 2
    return moves if few else np.ones_like(moves)
