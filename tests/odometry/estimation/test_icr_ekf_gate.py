"""Poses that the filter of pose and ICRs refuses, and for how long."""

import numpy as np
import pytest
from scipy.stats import binomtest

from tests.odometry.estimation.icr_ekf_drives import drawn_pose, driven, filter_of, frame, table


@pytest.mark.parametrize("probability", [0.9, 0.99])
def test_the_gate_is_a_probability(probability, rng):
    """Of true poses it refuses 1 - probability, within what chance allows once in 1000."""
    terrains = {"a": table(0.3, -0.3, 0, 0.02)}
    ekf = filter_of(terrains=terrains, gate_probability=probability)
    before = driven(ekf)
    at_the_pose = ekf.step(before, frame(3.1), "a")
    poses = [drawn_pose(ekf, at_the_pose, rng) for _ in range(2000)]
    answers = [ekf.step(before, frame(3.1, pose), "a").innovation.accepted for pose in poses]
    refused = answers.count(False)
    assert binomtest(refused, 2000, 1 - probability).pvalue > 1e-3


def test_a_refused_pose_changes_nothing_but_the_count():
    ekf = filter_of(gate_probability=0.99)
    before = driven(ekf)
    refused = ekf.step(before, frame(3.1, (1e3, 0, 0)), "a")
    without = ekf.step(before, frame(3.1), "a")
    np.testing.assert_array_equal(refused.mean, without.mean)
    np.testing.assert_array_equal(refused.covariance, without.covariance)
    assert (refused.innovation.accepted, len(refused.refused)) == (False, 1)


def test_patience_then_the_pose_is_believed():
    ekf = filter_of(gate_probability=0.99, gate_patience=3)
    estimate = driven(ekf)
    icr_block = estimate.covariance[3:6, 3:6]
    for i in range(1, 4):
        estimate = ekf.step(estimate, frame(3 + 0.1 * i, (100, 50, 1)), "a")
        assert not estimate.innovation.accepted
        if i < 3:
            assert len(estimate.refused) == i
            assert abs(estimate.mean[0]) < 50
    np.testing.assert_array_equal(estimate.mean[:3], [100, 50, 1])
    assert len(estimate.refused) == 0
    np.testing.assert_allclose(np.diag(estimate.covariance)[:3], [4e-4, 4e-4, 1e-4])
    assert np.all(estimate.covariance[:3, 3:6] == 0)
    assert np.all(np.diag(estimate.covariance)[3:6] >= np.diag(icr_block))


def test_a_pose_that_passes_ends_the_row():
    ekf = filter_of(gate_probability=0.99)
    before = driven(ekf)
    refused = ekf.step(before, frame(3.1, (1e3, 0, 0)), "a")
    after = ekf.step(refused, frame(3.1, refused.mean[:3]), "a")
    assert (after.innovation.accepted, len(after.refused)) == (True, 0)
