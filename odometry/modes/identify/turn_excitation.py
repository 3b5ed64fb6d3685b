"""Whether the drives of a terrain excite turns: gains of others are not identified.

Straight on, on one circle, or at one rate on the spot, the difference of the treads goes with their
speed or does not change. A pull, or a bias of the gyroscope, then explains the yaw rate as well as
any gain does (persistence of excitation: Ljung 1999, System Identification, 13.2).
"""

from collections.abc import Sequence

import numpy as np

from odometry.modes.models.response import Record, block_means

BLOCK_S = 1.0  # of means: noise of the treads is no turn
# As a share of the tread speeds. Made drives straight on or on one circle have 0.001 to 0.008,
# each of 22 recorded drives 0.16 to 1.05, drives of 30 made robots 0.15 or more.
LEAST_EXCITATION = 0.04


def turn_excitation(records: Sequence[Record]) -> float:
    """How much the difference of the treads varies, as a share of the tread speeds.

    Root mean squares over all records, beside what is constant or goes with the speed.

    Examples
    --------
    >>> import numpy as np
    >>> from odometry.modes.identify.turn_excitation import turn_excitation
    >>> from odometry.modes.models.response import Record
    >>> circle = np.tile([0.5, 0.4, 0.4, 0.6], (400, 1))
    >>> both_ways = np.where(np.arange(400)[:, None] < 200, circle, circle[:, [0, 1, 3, 2]])
    >>> [round(turn_excitation([Record(0.05, of)]), 3) for of in (circle, both_ways)]
    [0.0, 0.277]
    """
    treads = np.concatenate(
        [
            np.column_stack([block_means(of, one.step_s, BLOCK_S) for of in one.table[:, 2:].T])
            for one in records
        ]
    )
    left, right = treads.T
    beside = np.column_stack([np.ones(len(treads)), left + right])
    own = right - left - beside @ np.linalg.lstsq(beside, right - left)[0]
    return float(np.linalg.norm(own) / max(float(np.linalg.norm(treads)), 1e-12))
