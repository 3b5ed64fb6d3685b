import numpy as np
import pytest
from scipy.signal import convolve2d

from terrain.classification.features.gabor_statistics import (
    ANGLES_DEG,
    WAVELENGTHS_PX,
    energies,
    gabor_names,
    gabor_statistics,
    log_energies,
)

ROWS, COLUMNS = np.mgrid[0:96, 0:128].astype(np.float32)


def noise(rng, shape=(96, 128)):
    return rng.integers(0, 256, shape).astype(np.float32)


def wave(wavelength_px, angle_deg, amplitude=40.0):
    turn = np.radians(angle_deg)
    along = np.cos(turn) * COLUMNS + np.sin(turn) * ROWS
    return (128 + amplitude * np.cos(2 * np.pi / wavelength_px * along)).astype(np.float32)


@pytest.mark.parametrize("wavelength_px", [3.0, 4.25])
def test_energies_are_those_of_full_kernels(wavelength_px, rng):
    grey = noise(rng, (40, 50))
    sigma = 0.5 * wavelength_px
    reach = int(np.ceil(2.5 * sigma))
    down, across = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    gaussian = np.exp(-(across**2 + down**2) / (2 * sigma**2))
    for angle, found in zip(np.radians(ANGLES_DEG), energies(grey, wavelength_px), strict=True):
        phase = 2 * np.pi / wavelength_px * (np.cos(angle) * across + np.sin(angle) * down)
        kernel = gaussian / gaussian.sum() * np.exp(1j * phase)
        expected = np.abs(convolve2d(np.pad(grey, reach, mode="reflect"), kernel, mode="valid"))
        np.testing.assert_allclose(found, expected, atol=1e-3)  # of up to 255 greys, in float32


def test_a_wave_has_half_its_amplitude_in_its_own_direction():
    for place, angle in enumerate(ANGLES_DEG):
        found = [energy[20:-20, 20:-20].mean() for energy in energies(wave(5.0, angle) - 128, 5.0)]
        assert found[place] == pytest.approx(20, rel=0.02)
        assert np.argmax(found) == place


def test_each_wavelength_is_loudest_at_its_own():
    for place, length in enumerate(WAVELENGTHS_PX):
        images = log_energies(wave(length, 0))
        assert np.argmax([images[4 * i].mean() for i in range(4)]) == place


def test_bytes_are_logarithms_at_half_the_size(rng):
    grey = noise(rng)
    images = log_energies(grey)
    assert len(images) == 16
    assert {image.shape for image in images} == {(48, 64)}
    assert {image.dtype for image in images} == {np.dtype(np.uint8)}
    flat = log_energies(np.full((96, 128), 90, np.float32))
    assert max(image.max() for image in flat) == 0


def test_statistics_are_those_of_the_bytes(rng):
    grey = noise(rng)
    maps = np.array([image.ravel() for image in log_energies(grey)]).reshape(4, 4, -1) / 32
    found = dict(zip(gabor_names(), gabor_statistics(grey), strict=True))
    assert found["gabor_mean_5"] == pytest.approx(maps[1].mean())
    means = maps.mean(axis=2)
    assert found["gabor_twice_8.5"] == pytest.approx(abs(means[2] @ [1, -1, 1, -1]))
    assert found["gabor_once_8.5"] == pytest.approx(abs(means[2] @ [1, 1j, -1, -1j]))
    covariance = np.cov(maps.reshape(16, -1), bias=True).reshape(4, 4, 4, 4)
    apart = [covariance[0, i, 3, (i + 2) % 4] for i in range(4)]
    assert found["gabor_covariance_90_3_14"] == pytest.approx(np.mean(apart))
    aslant = [covariance[1, i, 2, j] for i in range(4) for j in ((i + 1) % 4, (i - 1) % 4)]
    assert found["gabor_covariance_45_5_8.5"] == pytest.approx(np.mean(aslant))
    cubes = ((maps[3] - means[3][:, None]) ** 3).mean()
    assert found["gabor_third_14"] == pytest.approx(cubes)


def test_mirrors_and_quarter_turns_change_nothing(rng):
    """But for bytes that are rounded the other way."""
    grey = noise(rng) * (0.2 + 0.8 * (wave(9.0, 45) > 128))
    before = gabor_statistics(grey.astype(np.float32))
    for changed in (grey[:, ::-1], grey[::-1], np.rot90(grey), np.rot90(grey, 2)):
        after = gabor_statistics(np.ascontiguousarray(changed, np.float32))
        np.testing.assert_allclose(after, before, atol=1e-3)


def test_brightness_does_not_matter(rng):
    grey = rng.integers(0, 128, (96, 96)).astype(np.float32)
    np.testing.assert_allclose(gabor_statistics(grey + 100), gabor_statistics(grey), atol=1e-3)


def test_46_names():
    assert len(set(gabor_names())) == len(gabor_statistics(np.zeros((32, 32), np.float32))) == 46
