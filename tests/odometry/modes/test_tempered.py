"""A tempered bank: likelihoods to a power, and nothing else."""

import numpy as np
import pytest

from odometry.estimation.ekf_bank import EkfBank
from odometry.modes.tempered import TemperedBank
from tests.odometry.modes.mode_examples import velocity_set


@pytest.mark.parametrize("independent", [0.0, 0.25, 1.0])
def test_log_likelihoods_are_scaled_and_the_rest_is_that_of_the_bank(independent):
    bank = EkfBank(velocity_set().modes.model(), 2)
    tempered = TemperedBank(bank, independent)
    means, covariances = np.array([[0.5, 0.1], [0.4, -0.2]]), np.tile(0.1 * np.eye(2), (2, 1, 1))
    u, z = np.array([0.3, 0.6]), np.array([0.5, 0.25])
    before, same = (one.predicted(means, covariances, u, 0.1) for one in (bank, tempered))
    for plain, own in zip(before, same, strict=True):
        np.testing.assert_array_equal(plain, own)
    plain, own = (one.updated(*before, z) for one in (bank, tempered))
    for place in (0, 1, 3):
        np.testing.assert_array_equal(plain[place], own[place])
    np.testing.assert_allclose(own[2], independent * plain[2])
    assert tempered.modes == 2
