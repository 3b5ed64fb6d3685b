import numpy as np
import pytest
from scipy.linalg import logm
from scipy.signal import butter, csd, sosfilt, welch

from odometry.feel.recorded.spectra import (
    SHRUNK,
    band_edges_hz,
    band_powers,
    cross_densities,
    log_correlations,
    pair_rows,
    shapes,
)


def power_densities(windows, rate_hz):
    """Of one axis (W, N)."""
    return cross_densities(windows[..., None, :], rate_hz)[..., 0, :]


def test_the_density_adds_up_to_the_variance():
    noise = np.random.default_rng(0).normal(0.0, 2.0, size=(400, 200))
    densities = power_densities(noise, 100.0)
    assert densities.shape == (400, 101)
    assert densities.sum(axis=1).mean() * 0.5 == pytest.approx(4.0, rel=0.03)


def test_it_agrees_with_an_independent_estimate():
    sos = butter(2, [8, 20], "bandpass", fs=100, output="sos")
    signal = sosfilt(sos, np.random.default_rng(1).normal(size=100_000))
    own = power_densities(signal.reshape(-1, 200), 100.0).mean(axis=0)
    _, other = welch(signal, 100.0, nperseg=200)
    inside = slice(20, 36)
    np.testing.assert_allclose(own[inside], other[inside], rtol=0.15)


def test_level_and_slope_have_no_power():
    line = 5.0 + 3.0 * np.linspace(0, 1, 200)[None]
    assert power_densities(line, 100.0).max() < 1e-20


def test_bands_in_hertz_are_the_same_at_another_rate():
    rng, edges = np.random.default_rng(2), band_edges_hz(8, 50.0)
    sos = butter(4, 40, fs=400, output="sos")
    signal = sosfilt(sos, rng.normal(size=400 * 400))
    bands = []
    for every, rate_hz in ((4, 100.0), (2, 200.0), (1, 400.0)):
        densities = power_densities(signal[::every].reshape(-1, round(2 * rate_hz)), rate_hz)
        bands.append(band_powers(densities, 0.5, edges).mean(axis=0))
    np.testing.assert_allclose(bands[0][:6], bands[1][:6], atol=0.1)
    np.testing.assert_allclose(bands[1][:6], bands[2][:6], atol=0.1)


def test_a_tone_is_in_its_band():
    tone = np.sin(2 * np.pi * 23.0 * np.arange(200) / 100.0)[None]
    bands = band_powers(power_densities(tone, 100.0), 0.5, band_edges_hz(7, 50.0))
    assert bands[0].argmax() == 3  # 22 to 29 Hz
    assert np.isfinite(bands).all()


def test_the_highest_frequency_is_in_the_last_band():
    densities = np.zeros((1, 101))
    densities[0, 100] = 1.0
    bands = band_powers(densities, 0.5, band_edges_hz(6, 50.0))
    assert bands[0].argmax() == 5


def test_shapes_are_those_of_known_spectra():
    flat, line = np.ones(101), np.zeros(101)
    line[40] = 1.0
    found = shapes(np.stack([flat, 7 * flat, line]), 0.5, 50.0)
    uniform_hz = np.sqrt(((np.arange(99) * 0.5) ** 2).mean() - ((np.arange(99) * 0.5).mean()) ** 2)
    np.testing.assert_allclose(found[0], [0.0, uniform_hz], atol=1e-9)
    np.testing.assert_allclose(found[1], found[0], atol=1e-9)
    assert found[2, 0] < -20
    assert found[2, 1] == pytest.approx(0.0, abs=0.01)


def three_axes():
    """Windows (W, 3, 200) of axes that share a band of 8 to 20 Hz, the third against the first."""
    rng = np.random.default_rng(3)
    sos = butter(2, [8, 20], "bandpass", fs=100, output="sos")
    shared, *own = rng.normal(size=(4, 100_000))
    shared = 3 * sosfilt(sos, shared)
    axes = np.stack([own[0] + shared, 5 * (own[1] + 0.5 * shared), own[2] - shared])
    return axes, np.swapaxes(axes.reshape(3, -1, 200), 0, 1)


def test_cross_densities_agree_with_an_independent_estimate():
    axes, windows = three_axes()
    own = cross_densities(windows, 100.0).mean(axis=0)
    inside = slice(20, 36)
    for pair, (one, other) in enumerate(zip(*np.triu_indices(3), strict=True)):
        _, expected = csd(axes[one], axes[other], 100.0, nperseg=200)
        np.testing.assert_allclose(own[pair, inside], expected.real[inside], rtol=0.15)


def test_pairs_of_some_axes_are_found_among_those_of_all():
    _, windows = three_axes()
    rows = [2, 0]
    among = cross_densities(windows, 100.0)[:, pair_rows(3, rows)]
    np.testing.assert_allclose(among, cross_densities(windows[:, rows], 100.0), atol=1e-12)


def test_correlations_are_the_logarithm_of_their_matrix_whatever_the_units():
    _, windows = three_axes()
    edges = band_edges_hz(4, 50.0)
    densities = cross_densities(windows[:1], 100.0)
    found = log_correlations(densities, 0.5, edges)
    assert found.shape == (1, 3, 4)
    part = densities[0][:, 2:27].mean(axis=1)  # 1 up to 13.25 Hz, steps of 0.5 Hz
    whole = np.zeros((3, 3))
    whole[np.triu_indices(3)] = part
    whole = whole + np.triu(whole, 1).T
    size = np.sqrt(np.diag(whole))
    shares = (1 - SHRUNK) * whole / np.outer(size, size) + SHRUNK * np.eye(3)
    expected = logm(shares)[np.triu_indices(3, 1)]
    np.testing.assert_allclose(found[0, :, 0], expected, atol=0.02)
    assert found[0, 0, 0] > 0.2
    assert found[0, 1, 0] < -0.2
    scaled = cross_densities(windows[:1] * np.array([1e-2, 1.0, 50.0])[:, None], 100.0)
    np.testing.assert_allclose(log_correlations(scaled, 0.5, edges), found, atol=1e-3)


def test_a_silent_axis_goes_with_none():
    silent = np.zeros((1, 2, 200))
    silent[0, 0] = np.random.default_rng(4).normal(size=200)
    found = log_correlations(cross_densities(silent, 100.0), 0.5, band_edges_hz(4, 50.0))
    np.testing.assert_allclose(found, 0.0, atol=1e-6)
