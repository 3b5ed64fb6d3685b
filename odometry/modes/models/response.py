"""How one quantity answers to others: a first-order lag, fitted to what it simulates."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.signal import lfilter

from odometry.arrays import FloatArray, IntArray

SLOWEST_HZ, FASTEST_HZ = 0.3, 30.0
LOG_RATE_TOLERANCE = 1e-9  # the file is then the same on other processors, but for rounding
RIDGE = 1e-3  # of the mean square of an input: what inputs that go together leave open is small
BLOCK_S = 2.0  # over which errors of a model are correlated
LEAST_VARIANCE = 1e-10

SHORTEST_LAG_S = 1e-3


@dataclass(frozen=True)
class Record:
    """Speed, yaw rate and both tread speeds (N, 4) at even steps."""

    step_s: float
    table: FloatArray

    @property
    def lasts_s(self) -> float:
        """Duration."""
        return self.step_s * (len(self.table) - 1)


@dataclass(frozen=True)
class Response:
    """dq/dt = -rate q + gains (other quantity, v_left, v_right).

    Attributes
    ----------
    rate_hz : float
        Inverse of the lag [1/s].
    gains : (3,)
    """

    rate_hz: float
    gains: FloatArray

    def row_of(self, row: int) -> FloatArray:
        """The row (4,) of (A, B) for speed (0) or yaw rate (1)."""
        whole = np.zeros(4)
        whole[row] = -self.rate_hz
        whole[_others(row)] = self.gains
        return whole


def fitted_response(records: Sequence[Record], row: int) -> Response:
    """The response whose simulation is nearest to quantity `row` in the mean square.

    At a given rate the simulation is linear in the gains, so that the rate alone is searched
    (variable projection, Golub and Pereyra 1973).
    """

    def cost(log_rate: float) -> float:
        return gains_at(records, row, float(np.exp(log_rate)))[1]

    grid = np.linspace(np.log(SLOWEST_HZ), np.log(FASTEST_HZ), 25)
    best = int(np.argmin([cost(log_rate) for log_rate in grid]))
    bounds = (grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)])
    log_rate = minimize_scalar(
        cost, bounds=bounds, method="bounded", options={"xatol": LOG_RATE_TOLERANCE}
    ).x
    rate_hz = float(np.exp(log_rate))
    return Response(rate_hz, gains_at(records, row, rate_hz)[0])


@dataclass(frozen=True)
class Errors:
    """What a response does not explain of a quantity.

    Attributes
    ----------
    variance : float
        Mean square.
    power : float
        At low frequency, times second: the variance of means over blocks of seconds, times
        their duration.
    """

    variance: float
    power: float


def errors_of(records: Sequence[Record], row: int, response: Response) -> Errors:
    """Errors of the simulation of whole records; they last, and `power` states how long."""
    left = [left_of(record, row, response) for record in records]
    blocks = [
        block_powers(errors, record.step_s) for errors, record in zip(left, records, strict=True)
    ]
    powers = np.concatenate(blocks)
    variance = max(float(np.mean(np.concatenate(left) ** 2)), LEAST_VARIANCE)
    return Errors(variance, float(powers.mean()) if len(powers) else 0.0)


def block_powers(errors: FloatArray, step_s: float) -> FloatArray:
    """Power at low frequency (K,): squared means over blocks of seconds, times their duration."""
    return np.asarray(_block_size(step_s) * step_s * block_means(errors, step_s) ** 2)


def block_means(values: FloatArray, step_s: float, block_s: float = BLOCK_S) -> FloatArray:
    """Means (K,) of values (N,) over blocks of seconds."""
    size = _block_size(step_s, block_s)
    count = len(values) // size
    return np.asarray(values[: count * size].reshape(count, size).mean(axis=1))


def _block_size(step_s: float, block_s: float = BLOCK_S) -> int:
    return max(1, round(block_s / step_s))


def gains_at(records: Sequence[Record], row: int, rate_hz: float) -> tuple[FloatArray, float]:
    """Gains (3,) of least squares at a rate, and the mean square that they leave."""
    parts = [simulated(record, row, rate_hz) for record in records]
    table = np.concatenate([inputs for inputs, _ in parts])
    wanted = np.concatenate([target for _, target in parts])
    normal = table.T @ table
    normal += RIDGE * np.diag(np.diag(normal)) * [1.0, 0.0, 0.0]
    gains = np.linalg.solve(normal + 1e-12 * np.eye(3), table.T @ wanted)
    return np.asarray(gains), float(np.mean((wanted - table @ gains) ** 2))


def without_biases(
    records: Sequence[Record], row: int, response: Response, sigma: float
) -> Response:
    """The response with gains that are found together with a bias of each record.

    A constant that a sensor adds is otherwise an answer to the treads, above all of slow drives. It
    has the deviation `sigma` about 0, and what the response leaves counts by what lasts of it.

    Parameters
    ----------
    records : sequence of Record
    row : int
        Of the quantity that has biases.
    response : Response
        As `fitted_response` finds it.
    sigma : float
        In the unit of the quantity.
    """
    power = max(errors_of(records, row, response).power, LEAST_VARIANCE)
    square, right = np.zeros((3, 3)), np.zeros(3)
    for record in records:
        inputs, target = simulated(record, row, response.rate_hz)
        ones = _projected(np.ones((len(target), 1)), record, response.rate_hz)[:, 0]
        least = power / record.step_s / sigma**2
        # the bias that is best for given gains is put in their place
        taken = ones / (ones @ ones + least)
        square += inputs.T @ inputs - np.outer(inputs.T @ ones, taken @ inputs)
        right += inputs.T @ target - (inputs.T @ ones) * (taken @ target)
    square += RIDGE * np.diag(np.diag(square)) * [1.0, 0.0, 0.0]
    gains = np.asarray(np.linalg.solve(square + 1e-12 * np.eye(3), right))
    return Response(response.rate_hz, gains)


def left_of(record: Record, row: int, response: Response) -> FloatArray:
    """What a response does not explain (N,) of quantity `row`."""
    inputs, target = simulated(record, row, response.rate_hz)
    return np.asarray(target - inputs @ response.gains)


def simulated(record: Record, row: int, rate_hz: float) -> tuple[FloatArray, FloatArray]:
    """Answers to each input (N, 3), and what they are to explain (N,).

    What the unknown value at the start leaves behind is projected out of both.
    """
    table = np.column_stack([_answers(record, row, rate_hz), record.table[:, row]])
    table = _projected(table, record, rate_hz)
    return table[:, :3], table[:, 3]


def _projected(table: FloatArray, record: Record, rate_hz: float) -> FloatArray:
    forgotten = np.exp(-rate_hz * record.step_s * np.arange(len(record.table)))
    forgotten /= np.linalg.norm(forgotten)
    return np.asarray(table - np.outer(forgotten, forgotten @ table))


def _answers(record: Record, row: int, rate_hz: float) -> FloatArray:
    """What a lag makes of each input (N, 3), held over steps: exact for tread speeds."""
    decay = np.exp(-rate_hz * record.step_s)
    inputs = record.table[:, _others(row)]
    gain = (1 - decay) / rate_hz
    return np.asarray(lfilter([0.0, gain], [1.0, -decay], inputs, axis=0))


def _others(row: int) -> IntArray:
    """Columns of the inputs: the other quantity, and both treads."""
    return np.array([1 - row, 2, 3])


def lagged(values: FloatArray, time_s: FloatArray, lag_s: float) -> FloatArray:
    """Values (N,) at times (N,), each held to the next, as a first-order lag follows them."""
    since_s = time_s - time_s[0]
    steps = max(1, round(float(since_s[-1] / np.median(np.diff(since_s)))))
    even_s, step_s = np.linspace(0.0, since_s[-1], steps + 1, retstep=True)
    held = values[np.searchsorted(since_s, even_s + 1e-3 * step_s, side="right") - 1]
    lasting = np.exp(-step_s / max(lag_s, SHORTEST_LAG_S))
    followed, _ = lfilter([0.0, 1 - lasting], [1.0, -lasting], held, zi=held[:1])
    return np.asarray(np.interp(since_s, even_s, followed))
