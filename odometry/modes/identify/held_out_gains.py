"""How far the yaw rate gain of a traction mode is off on drives that it was not identified from."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.optimize import nnls

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.models.innovation_test import windowed
from odometry.modes.models.response import lagged
from odometry.modes.models.traction import RIGHT_TURN, TractionModes, requested, turns_of
from odometry.modes.models.yaw_rate_noise import YawRateStretch

WINDOW_S = 4.0  # as long as a turn
LEAST_RAD_S = 0.05  # predicted: less is no turn
CLIP_RAD_S = 0.3  # of one error: a spike is no turn
PARTS = 4  # of a mode's only stretch
LEAST_WINDOWS = 8
USUAL = 0.3  # deviation of each gain from eq. 3, as in `identify_traction`
OMEGA = 2  # row of the gains


def gain_errors(
    modes: TractionModes, measured: Mapping[str, Sequence[YawRateStretch]]
) -> tuple[FloatArray, float] | None:
    """Spread and power of the errors of gains: their variance is spread^2 + power / information.

    Every stretch of a mode is predicted by gains of its others (of one stretch alone, each quarter
    by the rest), by linear least squares with the lag of the mode. The information of a window is
    the time integral of the predicted yaw rate squared; both numbers are those of least squares
    over the windows of all modes. A mode whose own windows have a larger spread keeps that.

    Parameters
    ----------
    modes : TractionModes
    measured : Mapping of sequences of YawRateStretch
        Yaw rates that a gyroscope measured in each mode.

    Returns
    -------
    ((M,), float) or None
        As a share of the gain, and [rad^2/s]; None where too little was measured.
    """
    by_mode = [
        np.array(
            [
                window
                for part in _held_out(modes, place, measured[name])
                for window in _windows(*part)
            ]
        ).reshape(-1, 2)
        for place, name in enumerate(modes.names)
    ]
    return spread_and_power(by_mode)


def spread_and_power(by_mode: Sequence[FloatArray]) -> tuple[FloatArray, float] | None:
    """Spread (M,) and power, of errors and information (K, 2) of the windows of each mode."""
    every = np.concatenate(by_mode)
    if len(every) < LEAST_WINDOWS:
        return None
    errors, information = every.T
    # windows that hardly turn do not outweigh the others
    most = np.median(1 / information)
    weights = 1 / np.maximum(1 / information, most)
    table = np.column_stack([np.ones(len(every)), 1 / information]) * weights[:, None]
    (squared, power), _ = nnls(table, errors**2 * weights)
    squares = np.full(len(by_mode), squared)
    for place, own in enumerate(by_mode):
        if len(own) >= LEAST_WINDOWS:
            beyond = own[:, 0] ** 2 - power / own[:, 1]
            mean = np.average(beyond, weights=1 / np.maximum(1 / own[:, 1], most))
            squares[place] = max(squared, mean)
    return np.sqrt(squares), float(power)


def gain_sums(
    predicted: FloatArray, errors: FloatArray, stamps_s: FloatArray, window_s: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """By how much (N,) the gain is off in a window up to each stamp, information, and turning time.

    Parameters
    ----------
    predicted, errors : (N,)
        Predicted yaw rate, and measured less predicted, NaN where it does not count [rad/s].
    stamps_s : (N,)
    window_s : float
    """
    turns = np.isfinite(errors) & (np.abs(predicted) > LEAST_RAD_S)
    lasts_s = np.where(turns, np.diff(stamps_s, prepend=stamps_s[0]), 0.0)
    clipped = np.clip(np.where(turns, errors, 0.0), -CLIP_RAD_S, CLIP_RAD_S)
    columns = lasts_s[:, None] * np.column_stack(
        [np.ones(len(predicted)), predicted**2, predicted * clipped]
    )
    turned_s, information, product = windowed(columns, stamps_s, window_s).T
    some = np.where(information > 1e-6, information, np.nan)
    return product / some, some, turned_s


def _windows(
    stamps_s: FloatArray, predicted: FloatArray, errors: FloatArray
) -> Iterator[tuple[float, float]]:
    """Error of the gain and its information in windows that overlap by half."""
    off, information, _ = gain_sums(predicted, errors, stamps_s, WINDOW_S)
    ends_s = np.arange(stamps_s[0] + WINDOW_S, stamps_s[-1], WINDOW_S / 2)
    rows = np.searchsorted(stamps_s, ends_s)
    known = rows[np.isfinite(off[rows])]
    yield from zip(off[known].tolist(), information[known].tolist(), strict=True)


def _held_out(
    modes: TractionModes, place: int, measured: Sequence[YawRateStretch]
) -> Iterator[tuple[FloatArray, FloatArray, FloatArray]]:
    """Stamps, predicted yaw rates and errors (N,) of each part that is left out in turn."""
    gains, variance = modes.gains[place, :, OMEGA], modes.measurement_variance[3]
    tables = [_table(one, float(modes.lag_s[place])) for one in measured]
    first = np.zeros(8)
    first[1] = np.mean(gains[:, 1])
    every = [_normal(table, one, one.driving) for table, one in zip(tables, measured, strict=True)]
    for table, one in zip(tables, measured, strict=True):
        for part in [one.driving] if len(measured) > 1 else _quarters(one):
            rest = np.sum(every, axis=0) - _normal(table, one, part)
            prior = np.eye(8) * variance / USUAL**2
            predicted = table @ np.linalg.solve(rest[:, :8] + prior, rest[:, 8] + prior @ first)
            yield one.stamps_s, predicted, np.where(part, one.yaw_rates - predicted, np.nan)


def _normal(table: FloatArray, one: YawRateStretch, rows: BoolArray) -> FloatArray:
    """Normal equations (8, 9) of some rows: the square matrix, and the right-hand side."""
    return table[rows].T @ np.column_stack([table, one.yaw_rates])[rows]


def _quarters(one: YawRateStretch) -> list[BoolArray]:
    """Rows (N,) while driving of each quarter of the time."""
    since_s = one.stamps_s - one.stamps_s[0]
    part = np.minimum((PARTS * since_s / since_s[-1]).astype(np.int64), PARTS - 1)
    return [one.driving & (part == number) for number in range(PARTS)]


def _table(one: YawRateStretch, lag_s: float) -> FloatArray:
    """What each gain of the yaw rate is multiplied by (N, 8): two shared, three for each side."""
    terms = requested(one.tread_speeds_m_s, one.track_width)
    right = (turns_of(one.tread_speeds_m_s) == RIGHT_TURN)[:, None]
    of_side = [np.where(side, terms[:, 2:], 0.0) for side in (~right, right)]
    columns = np.column_stack([terms[:, :2], *of_side]).T
    return np.column_stack([lagged(column, one.stamps_s, lag_s) for column in columns])
