"""Spectral densities of windows, the log power of bands, and how axes go together in them."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from odometry.arrays import FloatArray, IntArray

TAPERS = 4  # more smooth the spectrum: by 1.25 Hz to either side in windows of 2 s
LOWEST_HZ = 1.0  # of the bands: below it are slopes and steering
LEAST_POWER = 1e-12  # added, so that a silent axis has a logarithm
SHRUNK = 0.05  # of a correlation: no matrix of correlations is singular


def cross_densities(windows: FloatArray, rate_hz: float) -> FloatArray:
    """Real parts of one-sided cross spectral densities, the mean over sine tapers.

    Parameters
    ----------
    windows : (..., A, N)
        Even samples of A axes; their mean and slope are taken out.
    rate_hz : float

    Returns
    -------
    (..., A (A + 1) / 2, N // 2 + 1)
        Of the pairs of `numpy.triu_indices(A)`, those of an axis with itself among them: product
        of the units per Hz at the frequencies k * rate_hz / N.

    References
    ----------
    Riedel and Sidorenko 1995, "Minimum bias multiple taper spectral estimation", eq. 12.
    """
    count = windows.shape[-1]
    line = np.linspace(-1, 1, count)
    level = windows - windows.mean(axis=-1, keepdims=True)
    level = level - ((level @ line) / (line @ line))[..., None] * line
    places = np.arange(1, count + 1) * np.pi / (count + 1)
    one, other = np.triu_indices(windows.shape[-2])
    summed = np.zeros((*windows.shape[:-2], len(one), count // 2 + 1))
    for order in range(1, TAPERS + 1):
        taper = np.sqrt(2 / (count + 1)) * np.sin(order * places)
        waves = np.fft.rfft(level * taper, axis=-1)
        summed += (waves[..., one, :] * waves[..., other, :].conj()).real
    return np.asarray(2 * summed / (TAPERS * rate_hz))


def pair_rows(axes: int, rows: Sequence[int]) -> IntArray:
    """Where the pairs of some of the axes stand among those of all: (R (R + 1) / 2,)."""
    numbers = np.zeros((axes, axes), dtype=np.int64)
    numbers[np.triu_indices(axes)] = np.arange(axes * (axes + 1) // 2)
    numbers = np.maximum(numbers, numbers.T)
    one, other = np.triu_indices(len(rows))
    return np.asarray(numbers[np.asarray(rows)[one], np.asarray(rows)[other]])


def band_edges_hz(bands: int, top_hz: float) -> FloatArray:
    """Edges (bands + 1,) of equally wide bands from LOWEST_HZ to `top_hz`."""
    return np.linspace(LOWEST_HZ, top_hz, bands + 1)


def band_powers(densities: FloatArray, step_hz: float, edges_hz: FloatArray) -> FloatArray:
    """Logarithm (..., bands) of the mean density (..., F) of each band."""
    return np.asarray(np.log(_band_means(densities, step_hz, edges_hz) + LEAST_POWER))


def log_correlations(densities: FloatArray, step_hz: float, edges_hz: FloatArray) -> FloatArray:
    """How A axes go together in each band, (..., A (A - 1) / 2, bands), whatever their size.

    Parameters
    ----------
    densities : (..., A (A + 1) / 2, F)
        See `cross_densities`.
    step_hz : float
    edges_hz : (bands + 1,)

    References
    ----------
    Archakov and Hansen 2021, "A new parametrization of correlation matrices", eq. 1: entries
    beside the diagonal of the logarithm of the matrix.
    """
    means = np.moveaxis(_band_means(densities, step_hz, edges_hz), -1, -2)
    axes = round((np.sqrt(8 * means.shape[-1] + 1) - 1) / 2)
    one, other = np.triu_indices(axes)
    whole = np.zeros((*means.shape[:-1], axes, axes))
    whole[..., one, other] = whole[..., other, one] = means
    size = np.sqrt(np.diagonal(whole, axis1=-2, axis2=-1)) + np.sqrt(LEAST_POWER)
    shares = (1 - SHRUNK) * whole / (size[..., :, None] * size[..., None, :])
    shares[..., range(axes), range(axes)] = 1.0
    roots, vectors = np.linalg.eigh(shares)
    logs = (vectors * np.log(roots)[..., None, :]) @ np.swapaxes(vectors, -1, -2)
    upper = np.triu_indices(axes, 1)
    return np.asarray(np.moveaxis(logs[..., upper[0], upper[1]], -1, -2))


def _band_means(densities: FloatArray, step_hz: float, edges_hz: FloatArray) -> FloatArray:
    """A frequency on an edge belongs to the band above it, the highest to the last band."""
    first = np.searchsorted(np.arange(densities.shape[-1]) * step_hz, edges_hz - 1e-9)
    first[-1] = np.searchsorted(
        np.arange(densities.shape[-1]) * step_hz, edges_hz[-1] + step_hz / 2
    )
    means = [densities[..., a:b].mean(axis=-1) for a, b in pairwise(first)]
    return np.stack(means, axis=-1)


def shapes(densities: FloatArray, step_hz: float, top_hz: float) -> FloatArray:
    """Log flatness and bandwidth [Hz] (..., 2) of densities (..., F), whatever their size.

    Flatness is the geometric mean over the arithmetic mean; the bandwidth is the standard
    deviation of frequency, weighted by density. From LOWEST_HZ up to `top_hz`.

    References
    ----------
    Gray and Markel 1974, "A spectral-flatness measure for studying the autocorrelation method".
    """
    frequencies_hz = np.arange(densities.shape[-1]) * step_hz
    within = (frequencies_hz >= LOWEST_HZ - 1e-9) & (frequencies_hz <= top_hz + step_hz / 2)
    part, frequencies_hz = densities[..., within] + LEAST_POWER, frequencies_hz[within]
    flatness = np.log(part).mean(axis=-1) - np.log(part.mean(axis=-1))
    share = part / part.sum(axis=-1, keepdims=True)
    mean_hz = (share @ frequencies_hz)[..., None]
    width_hz = np.sqrt((share * (frequencies_hz - mean_hz) ** 2).sum(axis=-1))
    return np.stack([flatness, width_hz], axis=-1)
