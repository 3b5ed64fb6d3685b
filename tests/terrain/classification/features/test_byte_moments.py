import numpy as np
import pytest

from terrain.classification.features.byte_moments import byte_moments, third_moments


@pytest.mark.parametrize("shape", [(1, 1), (3, 5), (16, 16), (40, 77), (300, 310)])
def test_means_and_covariance_are_those_of_numpy(shape, rng):
    images = rng.integers(0, 256, (5, *shape), dtype=np.uint8)
    means, covariance = byte_moments(images)
    pixels = images.reshape(5, -1).astype(float)
    np.testing.assert_allclose(means, pixels.mean(axis=1), rtol=1e-14)
    np.testing.assert_allclose(covariance, np.cov(pixels, bias=True), rtol=1e-10, atol=1e-9)


def test_third_moments_are_mean_cubes_of_deviations(rng):
    images = (rng.random((4, 30, 20)) ** 3 * 255).astype(np.uint8)
    deviations = images - images.mean(axis=(1, 2), keepdims=True)
    np.testing.assert_allclose(third_moments(images), (deviations**3).mean(axis=(1, 2)), rtol=1e-9)


def test_the_sums_of_white_and_of_black_images_are_exact():
    """No larger sums of odd numbers can occur."""
    greys = np.array([255, 1, 255], np.uint8)
    means, covariance = byte_moments(np.broadcast_to(greys[:, None, None], (3, 128, 130)))
    np.testing.assert_array_equal(means, greys)
    np.testing.assert_array_equal(covariance, 0.0)


def test_the_order_of_the_pixels_changes_no_bit(rng):
    images = rng.integers(100, 256, (6, 96 * 96), dtype=np.uint8)
    shuffled = images[:, rng.permutation(96 * 96)]
    for of, again in zip(byte_moments(images), byte_moments(shuffled), strict=True):
        assert of.tobytes() == again.tobytes()
