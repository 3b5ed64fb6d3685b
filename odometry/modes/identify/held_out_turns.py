"""How far the yaw rate gain of a velocity mode is off on turns that it was not identified from."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.identify.held_out_centres import OUT
from odometry.modes.identify.held_out_gains import LEAST_RAD_S, PARTS, gain_sums, spread_and_power
from odometry.modes.models.response import Record, Response, gains_at, simulated

# Of turning, the straights between turns left out: the first as long as a short turn, the second
# as a long one. Chosen in development (tests/studies/modes.md).
TURNED_S = (1.5, 4.0)
REST_S = 10.0  # by which gains are found that predict the others: as much as a terrain needs
OVERLAP = 2  # windows overlap by half


def turning_clock(
    predicted: FloatArray, errors: FloatArray, lasts_s: FloatArray | float
) -> FloatArray:
    """For how long (N,) the robot has turned, where it was measured: on straights it stands still.

    By predicted yaw rates (N,) and errors (N,), NaN where they do not count [rad/s].
    """
    turns: BoolArray = np.isfinite(errors) & (np.abs(predicted) > LEAST_RAD_S)
    return np.asarray(np.cumsum(np.where(turns, lasts_s, 0.0)))


def turn_errors(
    records: Mapping[str, Sequence[Record]], row: int, responses: Mapping[str, Response]
) -> tuple[FloatArray, FloatArray] | None:
    """Spread and power (M, 2) of the errors of gains: variance = spread^2 + power / information.

    Every record of a mode (each quarter of its only one) is predicted by gains of the others, and
    by those of the mode: the first err by more than the mode does on a new drive, since they are of
    fewer drives, and the second by less. By TURNED_S, as a share of the gain and [rad^2/s]; None
    where too little turns. `row` is the yaw rate among the columns of a record.
    """
    found = []
    for turned_s in TURNED_S:
        out, own = [], []
        for name, response in responses.items():
            parts = _parts(records[name])
            out.append(np.concatenate(list(_held_out(parts, row, response.rate_hz, turned_s))))
            own.append(np.concatenate([_windows(of, row, response, turned_s) for of in parts]))
        both = spread_and_power(out), spread_and_power(own)
        if both[0] is None or both[1] is None:
            return None
        (spread_out, power_out), (spread_own, power_own) = both[0], both[1]
        squares = OUT * spread_out**2 + (1 - OUT) * spread_own**2
        power = OUT * power_out + (1 - OUT) * power_own
        found.append((np.sqrt(squares), np.full(len(squares), power)))
    spreads, powers = zip(*found, strict=True)
    return np.column_stack(spreads), np.column_stack(powers)


def _parts(records: Sequence[Record]) -> list[Record]:
    """The records of a mode; the quarters of one beside which the others are too short."""
    lasts_s = [record.step_s * len(record.table) for record in records]
    return [
        Record(record.step_s, part)
        for record, own_s in zip(records, lasts_s, strict=True)
        for part in np.array_split(record.table, PARTS if sum(lasts_s) - own_s < REST_S else 1)
    ]


def _held_out(
    parts: Sequence[Record], row: int, rate_hz: float, turned_s: float
) -> Iterator[FloatArray]:
    """Windows (K, 2) of each part by gains of the others."""
    for place, part in enumerate(parts):
        gains, _ = gains_at([*parts[:place], *parts[place + 1 :]], row, rate_hz)
        yield _windows(part, row, Response(rate_hz, gains), turned_s)


def _windows(record: Record, row: int, response: Response, turned_s: float) -> FloatArray:
    """Error of the gain and its information (K, 2)."""
    inputs, target = simulated(record, row, response.rate_hz)
    predicted = inputs @ response.gains
    errors = target - predicted
    clock_s = turning_clock(predicted, errors, record.step_s)
    off, information, _ = gain_sums(predicted, errors, clock_s, turned_s)
    rows = np.searchsorted(clock_s, np.arange(turned_s, clock_s[-1], turned_s / OVERLAP))
    return np.column_stack([off[rows], information[rows]])
