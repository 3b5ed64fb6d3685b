"""Power of what a mode's speed is off by, beside the noise of the positions it was measured by.

Speeds that come of positions err by their noise, which does not grow with the distance: the mean
over a block is off by the noise of its two ends. Of a slow robot that is most of what is left; as
power it would hide that another distance was travelled.
"""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import nnls

from odometry.arrays import FloatArray
from odometry.modes.models.response import Record, Response, block_means, left_of

BLOCKS_S = (2.0, 4.0, 8.0, 16.0)


def travel_power(records: Sequence[Record], row: int, response: Response, *, by: int) -> FloatArray:
    """Power of errors (2,) at low frequency [m^2/s]: where column `by` is 0, what its square adds.

    Over blocks of T seconds the squared mean times T is that power, and twice the variance of a
    position divided by T, which is found with it and left out. Of blocks of one duration alone it
    cannot be found, and is in the power.

    Parameters
    ----------
    records : sequence of Record
    row : int
        Of the speed.
    response : Response
    by : int
    """
    found = [
        _blocks(record, row, response, by, block_s) for block_s in BLOCKS_S for record in records
    ]
    lasts_s, powers, squares = np.concatenate(found).T
    if not len(powers):
        return np.zeros(2)
    table = np.column_stack([np.ones(len(powers)), squares, 1 / lasts_s])
    if np.ptp(lasts_s) == 0:
        table = table[:, :2]
    # there are as many fewer blocks as they are longer: each duration counts alike
    weights = np.sqrt(lasts_s)
    values, _ = nnls(table * weights[:, None], powers * weights)
    return np.asarray(values[:2])


def _blocks(record: Record, row: int, response: Response, by: int, block_s: float) -> FloatArray:
    """Duration, power and mean square of column `by` of each block (K, 3)."""
    means = block_means(left_of(record, row, response), record.step_s, block_s)
    squares = block_means(record.table[:, by] ** 2, record.step_s, block_s)
    return np.column_stack([np.full(len(means), block_s), block_s * means**2, squares])
