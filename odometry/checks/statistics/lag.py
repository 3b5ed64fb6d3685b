"""By how much one sensor is late against another: correlation of yaw rates."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray

Signal = Callable[[FloatArray], FloatArray]
Rate = Callable[[FloatArray, float], FloatArray]  # of stamps, over a width [s] around each
GRID_S = 0.05
LEAST_CORRELATION = 0.7
RIVAL = 0.9  # a second peak as high as this share of the first: the motion is periodic
LEAST_SIZE = 1e-9  # of the product of both; smaller ones stand still
LEAST_SHARE = 1e-12  # of the squares, that are left of the mean: less is their rounding
PIECES, FEWEST = 8, 3
LEAST_PIECE_S = 8.0
TOGETHER_S, CUTOFF = 0.15, 4.0  # seconds, or standard deviations, from the line through the pieces


@dataclass(frozen=True)
class Lag:
    """How much later a signal is than another.

    Attributes
    ----------
    seconds, sigma_s : float
        Mean over pieces of the recording, and the standard deviation of that mean.
    drift, drift_sigma : float
        Seconds per second by which the lag grows.
    correlation : float
        Of the two rates at that lag, median over pieces.
    pieces : int
    together : float
        Share of the pieces whose lag lies near the line through all of them.
    """

    seconds: float
    sigma_s: float
    drift: float
    drift_sigma: float
    correlation: float
    pieces: int
    together: float


class Lags(NamedTuple):
    """Lags (P,) of pieces around their middles, standard deviations, and correlations."""

    middles_s: FloatArray
    lags_s: FloatArray
    sigmas_s: FloatArray
    correlations: FloatArray


def lag_between(
    late: Signal, early: Signal, span_s: tuple[float, float], width_s: float, most_s: float
) -> Lag | None:
    """The lag of one heading behind another: `lag_of_rates` of their differences over a width."""
    return lag_of_rates(partial(_rate, late), partial(_rate, early), span_s, width_s, most_s)


def lag_of_rates(
    late: Rate, early: Rate, span_s: tuple[float, float], width_s: float, most_s: float
) -> Lag | None:
    """The lag of `late` behind `early`, from pieces of the time between two stamps.

    Both are rates over the same width, so that the filter shifts neither. None where fewer than
    three pieces have a clear peak.

    Parameters
    ----------
    late, early : callable of stamps (K,) and a width [s] to (K,)
    span_s : (float, float)
        Stamps.
    width_s : float
        Over which a rate is taken: not less than the period of the slower sensor.
    most_s : float
        Largest lag searched for, to both sides.
    """
    count = int(np.clip((span_s[1] - span_s[0]) / LEAST_PIECE_S, 1, PIECES))
    found = lags_in_pieces(late, early, np.linspace(*span_s, count + 1), width_s, most_s)
    return _summarised(found) if len(found.lags_s) >= FEWEST else None


def lags_in_pieces(
    late: Rate, early: Rate, edges_s: FloatArray, width_s: float, most_s: float
) -> Lags:
    """The lags of `late` behind `early` in the pieces between some stamps, where a peak is clear.

    As in `lag_of_rates`, with the edges (P + 1,) of the pieces.
    """
    lags, middles, correlations, sigmas = [], [], [], []
    for begin_s, stop_s in pairwise(edges_s.tolist()):
        found = _peak(late, early, (begin_s, stop_s), width_s, most_s)
        if found is not None:
            lags.append(found[0])
            correlations.append(found[1])
            sigmas.append(_peak_sigma_s(found[1], stop_s - begin_s, width_s))
            middles.append((begin_s + stop_s) / 2)
    return Lags(*(np.array(of) for of in (middles, lags, sigmas, correlations)))


def _peak(
    late: Rate, early: Rate, span_s: tuple[float, float], width_s: float, most_s: float
) -> tuple[float, float] | None:
    """Lag and correlation at the peak; None where the peak is low, at the edge or not alone."""
    begin_s, stop_s = span_s
    at_s = np.arange(begin_s, stop_s, GRID_S)
    reference = late(at_s, width_s)
    lags = np.arange(-most_s, most_s + GRID_S / 2, GRID_S)
    reach = round(most_s / GRID_S)
    around_s = np.asarray(begin_s + GRID_S * np.arange(-reach, len(at_s) + reach), dtype=float)
    other = early(around_s, width_s)
    known = np.isfinite(reference)
    if known.sum() < LEAST_PIECE_S / GRID_S / 2:
        return None
    correlations = _correlations(reference, other)[::-1]
    best = int(np.nanargmax(correlations)) if np.isfinite(correlations).any() else 0
    if not 0 < best < 2 * reach or correlations[best] < LEAST_CORRELATION:
        return None
    if _rival(correlations, best) > RIVAL * correlations[best]:
        return None
    left, top, right = correlations[best - 1 : best + 2]
    bend = left - 2 * top + right
    shift = 0.5 * (left - right) / bend if np.isfinite(bend) and bend < 0 else 0.0
    return float(lags[best] + shift * GRID_S), float(top)


def _rival(correlations: FloatArray, best: int) -> float:
    """The highest other local maximum."""
    inner = correlations[1:-1]
    peak = (inner >= correlations[:-2]) & (inner >= correlations[2:])
    peak[max(best - 1, 0)] = False
    return float(np.nanmax(np.where(peak, inner, -1.0)))


def _rate(heading: Signal, at_s: FloatArray, width_s: float) -> FloatArray:
    return (heading(at_s + width_s / 2) - heading(at_s - width_s / 2)) / width_s


def _correlations(one: FloatArray, other: FloatArray) -> FloatArray:
    """Correlation (m,) of a signal (n,) with each n neighbours of another (n + m - 1,).

    Of what both know; NaN where that is too little, or where one of them stands still.
    """
    (of_one, known), (of_other, known_other) = _from_mean(one), _from_mean(other)
    counts = np.maximum(_sums(known_other, known), 1)
    a, b = _sums(known_other, of_one), _sums(of_other, known)
    of_a, of_b = _sums(known_other, of_one**2), _sums(of_other**2, known)
    left_a, left_b = of_a - a**2 / counts, of_b - b**2 / counts
    sizes = np.sqrt(np.maximum(left_a * left_b, 0.0))
    clear = (left_a > LEAST_SHARE * of_a) & (left_b > LEAST_SHARE * of_b) & (sizes > LEAST_SIZE)
    clear &= counts >= LEAST_PIECE_S / GRID_S / 2
    products = _sums(of_other, of_one) - a * b / counts
    return np.where(clear, products, np.nan) / np.where(clear, sizes, 1.0)


def _from_mean(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values (n,) less their mean, 0 where they are not known, and 1 (n,) where they are."""
    known = np.isfinite(values)
    mean = values[known].mean() if known.any() else 0.0
    return np.where(known, values - mean, 0.0), known.astype(np.float64)


def _sums(longer: FloatArray, shorter: FloatArray) -> FloatArray:
    """Sums (m,) of the products of n neighbours (n + m - 1,) with others (n,), at each place."""
    return np.correlate(longer, shorter, mode="valid")


def _peak_sigma_s(correlation: float, lasts_s: float, width_s: float) -> float:
    """Standard deviation of one peak: rates over `width_s` are so many independent samples.

    The bound of time delay estimation, for signals whose band is that of the width (Carter 1987).
    """
    noise = max(1 - correlation**2, 0.0) / correlation**2
    return float(width_s * np.sqrt(noise * width_s / lasts_s))


def _summarised(found: Lags) -> Lag:
    """Median lag, and a line through the pieces by the medians of slopes (Theil and Sen)."""
    middles, lags, sigmas, correlations = found
    i, j = np.triu_indices(len(lags), 1)
    drift = float(np.median((lags[j] - lags[i]) / (middles[j] - middles[i])))
    left = lags - np.median(lags) - drift * (middles - np.median(middles))
    spread = 1.4826 * float(np.median(np.abs(left - np.median(left)))) + GRID_S / 10
    spread = max(spread, float(np.median(sigmas)))  # few pieces may agree by chance
    span = float(np.sqrt(np.sum((middles - middles.mean()) ** 2)))
    return Lag(
        float(np.median(lags)),
        1.25 * spread / np.sqrt(len(lags)),
        drift,
        1.25 * spread / span,
        float(np.median(correlations)),
        len(lags),
        float(np.mean(np.abs(left) < np.maximum(TOGETHER_S, CUTOFF * sigmas))),
    )
