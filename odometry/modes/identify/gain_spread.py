"""How much the gain of a quantity differs from one turn to the next."""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.optimize import nnls

from odometry.arrays import FloatArray
from odometry.modes.models.response import (
    LEAST_VARIANCE,
    Record,
    Response,
    block_means,
    block_powers,
    left_of,
    simulated,
)

LEAST_TURN_RAD_S, LEAST_TURN_S, LEAST_TURNS = 0.1, 1.0, 5  # of which a gain says something


def growing_power(
    records: Sequence[Record], row: int, response: Response, *, by: int
) -> FloatArray:
    """Power of errors (2,) at low frequency: where column `by` is 0, and what its square adds."""
    blocks = [
        (
            block_powers(left_of(record, row, response), record.step_s),
            block_means(record.table[:, by] ** 2, record.step_s),
        )
        for record in records
    ]
    powers = np.concatenate([power for power, _ in blocks])
    squares = np.concatenate([square for _, square in blocks])
    if not len(powers):
        return np.zeros(2)
    values, _ = nnls(np.column_stack([np.ones(len(powers)), squares]), powers)
    return np.asarray(values)


def gain_spread(records: Sequence[Record], row: int, response: Response) -> float:
    """Standard deviation of the gain from one turn to the next, as a share of it.

    Of what is measured over what the response predicts, turn by turn, beyond what noise that does
    not grow with the turn makes of it (the moment estimate of DerSimonian and Laird 1986,
    Controlled Clinical Trials 7, 177). A gain that depends on the run, on the speed or on how tight
    a turn is differs from turn to turn, and no noise of single measurements tells of that.
    """
    noise = float(growing_power(records, row, response, by=row)[0])
    found = [turn for one in records for turn in _gains_of_turns(one, row, response)]
    gains, squares = np.array(found).reshape(-1, 2).T
    if len(gains) < LEAST_TURNS:
        return 0.0
    weights = squares / max(noise, LEAST_VARIANCE)
    mean = weights @ gains / weights.sum()
    beyond = weights @ (gains - mean) ** 2 - (len(gains) - 1)
    scale = weights.sum() - weights @ weights / weights.sum()
    return float(np.sqrt(max(beyond / scale, 0.0)) / abs(mean))


def _gains_of_turns(record: Record, row: int, response: Response) -> Iterator[tuple[float, float]]:
    """Of each turn to one side the gain, and the time integral of what is predicted, squared."""
    inputs, target = simulated(record, row, response.rate_hz)
    predicted = inputs @ response.gains
    side = np.where(np.abs(predicted) > LEAST_TURN_RAD_S, np.sign(predicted), 0.0)
    changes = np.flatnonzero(np.diff(side)) + 1
    for turn in np.split(np.arange(len(side)), changes):
        if side[turn[0]] and len(turn) * record.step_s >= LEAST_TURN_S:
            square = float(predicted[turn] @ predicted[turn])
            yield float(predicted[turn] @ target[turn]) / square, square * record.step_s
