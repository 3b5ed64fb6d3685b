"""Power spectral densities of windows, and the log power of bands."""

from itertools import pairwise

import numpy as np

from odometry.arrays import FloatArray

TAPERS = 4  # more smooth the spectrum: by 1.25 Hz to either side in windows of 2 s
LOWEST_HZ = 1.0  # of the bands: below it are slopes and steering
LEAST_POWER = 1e-12  # added, so that a silent axis has a logarithm


def power_densities(windows: FloatArray, rate_hz: float) -> FloatArray:
    """One-sided power spectral densities, the mean over sine tapers.

    Parameters
    ----------
    windows : (..., N)
        Even samples; their mean and slope are taken out.
    rate_hz : float

    Returns
    -------
    (..., N // 2 + 1)
        Unit squared per Hz at the frequencies k * rate_hz / N.

    References
    ----------
    Riedel and Sidorenko 1995, "Minimum bias multiple taper spectral estimation", eq. 12.
    """
    count = windows.shape[-1]
    line = np.linspace(-1, 1, count)
    level = windows - windows.mean(axis=-1, keepdims=True)
    level = level - ((level @ line) / (line @ line))[..., None] * line
    places = np.arange(1, count + 1) * np.pi / (count + 1)
    summed = np.zeros((*windows.shape[:-1], count // 2 + 1))
    for order in range(1, TAPERS + 1):
        taper = np.sqrt(2 / (count + 1)) * np.sin(order * places)
        summed += np.abs(np.fft.rfft(level * taper, axis=-1)) ** 2
    return np.asarray(2 * summed / (TAPERS * rate_hz))


def band_edges_hz(bands: int, top_hz: float) -> FloatArray:
    """Edges (bands + 1,) of equally wide bands from LOWEST_HZ to `top_hz`."""
    return np.linspace(LOWEST_HZ, top_hz, bands + 1)


def band_powers(densities: FloatArray, step_hz: float, edges_hz: FloatArray) -> FloatArray:
    """Logarithm (..., bands) of the mean density (..., F) of each band.

    A frequency on an edge belongs to the band above it, the highest to the last band.
    """
    first = np.searchsorted(np.arange(densities.shape[-1]) * step_hz, edges_hz - 1e-9)
    first[-1] = np.searchsorted(
        np.arange(densities.shape[-1]) * step_hz, edges_hz[-1] + step_hz / 2
    )
    means = [densities[..., a:b].mean(axis=-1) for a, b in pairwise(first)]
    return np.asarray(np.log(np.stack(means, axis=-1) + LEAST_POWER))


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
