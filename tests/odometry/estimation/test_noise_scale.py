"""Scales of noise after one more innovation, by hand."""

import numpy as np
import pytest

from odometry.estimation.noise_scale import MOST_SQUARED, NoiseScale, adapted

RATE = 0.1
UNIT = np.ones(3)  # an innovation of one deviation each: its normalised square is 3


def after(scale, residual, covariance=1.0):
    """With an innovation of this variance for each entry."""
    weighed = residual / covariance
    return adapted(scale, residual, weighed, float(residual @ weighed), RATE)


def logs(scale):
    return scale.slip_log, scale.pose_log


def test_a_first_innovation_as_large_as_expected_changes_nothing():
    found = after(NoiseScale(), 0.1 * UNIT, covariance=0.01)
    assert logs(found) == pytest.approx((0.0, 0.0), abs=1e-15)
    np.testing.assert_allclose(found.weighed, 10.0)


@pytest.mark.parametrize("squared", [0.25, 1.0, 2.0, 3.9])
def test_a_first_innovation_that_is_larger_or_smaller_scales_both(squared):
    found = after(NoiseScale(0.3, -0.2), np.sqrt(squared) * UNIT)
    assert logs(found) == pytest.approx((0.3 + RATE * (squared - 1), -0.2 + RATE * (squared - 1)))
    assert (found.slip, found.pose) == pytest.approx(tuple(np.exp(logs(found))))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_innovations_that_resemble_each_other_are_slip_and_those_that_alternate_are_noise(sign):
    """Half of their correlation, which is 0.8 here, goes from one to the other."""
    found = after(after(NoiseScale(), 0.8 * sign * UNIT), UNIT)
    first = RATE * (0.8**2 - 1)
    expected = first + RATE * 0.4 * sign, first - RATE * 0.4 * sign
    assert logs(found) == pytest.approx(expected)


def test_an_outlier_counts_no_more_than_the_most():
    largest = np.sqrt(MOST_SQUARED) * UNIT
    one, two = (after(NoiseScale(), times * largest) for times in (1.0, 50.0))
    assert logs(two) == pytest.approx(logs(one))
    np.testing.assert_allclose(two.weighed, one.weighed)
    third = after(one, largest), after(two, 50.0 * largest)
    assert logs(third[1]) == pytest.approx(logs(third[0]))
    assert logs(third[0])[0] - logs(one)[0] == pytest.approx(RATE * (MOST_SQUARED - 1 + 1))


def test_innovations_of_other_entries_are_not_compared():
    found = after(NoiseScale(weighed=UNIT[:2]), UNIT)
    assert logs(found) == pytest.approx((0.0, 0.0), abs=1e-15)


def test_scales_stay_within_their_bounds():
    low = high = NoiseScale()
    for _ in range(100):
        low, high = after(low, 0 * UNIT), after(high, 2 * UNIT)
    assert logs(low) == (-3.0, -3.0)
    assert logs(high)[0] == 6.0
