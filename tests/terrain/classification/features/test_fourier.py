import numpy as np
import pytest

from terrain.classification.neighbours.metric import MOST, WIDTH, FourierFeatures


def test_products_of_cosines_are_the_kernel(rng):
    """Rahimi and Recht 2007: the mean product tends to the Gaussian kernel."""
    samples = rng.normal(size=(MOST, 30))
    features = FourierFeatures().fit(samples).transform(samples)
    np.testing.assert_array_equal(features[:, :30], samples)
    cosines = features[:, 30:]
    assert cosines.shape == (MOST, MOST)
    apart = ((samples[:40, None] - samples[None, :40]) ** 2).sum(axis=2)
    products = cosines[:40] @ cosines[:40].T / MOST
    off = products - np.exp(-WIDTH * apart / 30)
    assert np.sqrt(np.mean(off**2)) < 2 / np.sqrt(MOST)


def test_there_are_no_more_than_samples(rng):
    few = rng.normal(size=(12, 4))
    again = [FourierFeatures().fit(few).transform(few) for _ in range(2)]
    assert again[0].shape == (12, 4 + 12)
    np.testing.assert_array_equal(*again)
    assert again[0][:, 4:] == pytest.approx(again[0][:, 4:].clip(-np.sqrt(2), np.sqrt(2)))
