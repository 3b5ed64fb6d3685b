"""Errors of positions that last, as those of satellites do, beside their scatter."""

import math

import numpy as np

from odometry.arrays import FloatArray
from odometry.dead_reckoning import dead_reckon
from odometry.recording.run import Run
from odometry.recording.sensors import gyroscope_of

WINDOW_S = 120.0  # over which treads and gyroscope keep the shape of a path
LAGS_S = (2.0, 8.0)  # over which scatter is independent and errors that last are not
FEWEST = 24  # positions of a window
USUAL = 1.0  # of the scatter, as receivers have them, where less than two windows show them
MOST = 2.0  # of the scatter: what is more may be slip
LEFT_BY_FITS = 0.25  # of the variance of errors that last for 30 s; 0.3 of 15 s, 0.17 of 60 s
SIGMAS = 2.0


def lasting_sigma_m(
    run: Run, stamps_s: FloatArray, positions_m: FloatArray, scatter_m: float
) -> float:
    """Standard deviation of errors of positions that last, per axis: what may be there.

    In windows of two minutes the path by treads and gyroscope is fitted to the positions (place,
    heading, one scale, the gyroscope's bias). What scatters is independent from one position to
    those 2 to 8 s later; what lasts is not, and their mean product is its variance. Two deviations
    of such a mean are added, so that short recordings are not taken for free of such errors.

    Parameters
    ----------
    run : Run
    stamps_s : (M,)
        Ascending.
    positions_m : (M, 2)
    scatter_m : float
        Standard deviation of the scatter, per axis.

    Returns
    -------
    float
        `USUAL` of the scatter where there is no gyroscope, or too few positions for a window; at
        least as much where there is one window alone.
    """
    path = _reckoned(run, stamps_s)
    if path is None:
        return USUAL * scatter_m
    places = positions_m[:, 0] + 1j * positions_m[:, 1]
    period_s = float(np.median(np.diff(stamps_s)))
    first, last = (max(1, round(lag_s / period_s)) for lag_s in LAGS_S)
    windows = max(1, int((stamps_s[-1] - stamps_s[0]) / WINDOW_S))
    products = list[FloatArray]()
    for rows in np.array_split(np.arange(len(stamps_s)), windows):
        if len(rows) >= max(FEWEST, 2 * last):
            off = _residuals(path[rows], places[rows])
            lagged = ((off[:-lag] * off[lag:].conj()).real for lag in range(first, last + 1))
            products.append(np.array([np.mean(each) / 2 for each in lagged]))
    if not products:
        return USUAL * scatter_m
    counted = len(products) * (len(stamps_s) // windows) * (last - first + 1)
    variance = float(np.mean(products)) + SIGMAS * scatter_m**2 / math.sqrt(2 * counted)
    least = USUAL * scatter_m if len(products) == 1 else 0.0
    return max(min(math.sqrt(max(variance, 0.0) / LEFT_BY_FITS), MOST * scatter_m), least)


def _reckoned(run: Run, stamps_s: FloatArray) -> FloatArray | None:
    """Places (M,) that treads and gyroscope reckon, as x + i y, and their derivative by its bias.

    (M, 2); None without a gyroscope.
    """
    gyroscope = gyroscope_of(run.yaw_rate)
    if gyroscope is None:
        return None
    at_s = run.odometry.stamps_s
    speeds = np.nan_to_num(run.odometry.stack("v_left", "v_right").mean(axis=1))
    rates = np.nan_to_num(np.append(gyroscope.mean_rates_rad_s(at_s)[1:], 0.0))
    twists = np.column_stack([speeds, np.zeros_like(speeds), rates])
    x, y, _ = dead_reckon(at_s, twists, np.zeros(3)).poses.T
    steps = np.diff(x + 1j * y)
    by_bias = np.append(0.0, np.cumsum(1j * (at_s[1:] - at_s[0]) * steps))
    return np.column_stack([np.interp(stamps_s, at_s, each) for each in (x + 1j * y, by_bias)])


def _residuals(path: FloatArray, places: FloatArray) -> FloatArray:
    """Places (M,) less the path (M, 2) that is moved, turned, scaled and bent to fit them."""
    columns = np.column_stack([np.ones(len(path)), path - path.mean(axis=0)])
    fitted, *_ = np.linalg.lstsq(columns, places, rcond=1e-8)
    return np.asarray(places - columns @ fitted)
