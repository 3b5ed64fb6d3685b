"""The filters of all modes at once give what filterpy's give one after the other."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import EstimationError
from odometry.estimation.imm.ekf_bank import EkfBank
from odometry.estimation.imm.estimator import Members
from tests.odometry.estimation.imm.ekf_member import EkfMember
from tests.odometry.estimation.imm.imm_banks import pose_model


@given(
    seed=st.integers(0, 2**32 - 1),
    modes=st.integers(1, 6),
    measured=st.lists(st.booleans(), min_size=3, max_size=3).filter(any),
    own_noise=st.booleans(),
)
def test_they_agree_with_the_members(seed, modes, measured, own_noise):
    rng = np.random.default_rng(seed)
    k, m = rng.uniform(0.3, 1, (2, modes))
    roots = rng.normal(size=(2, modes, 3, 3))
    R, covariances = roots @ roots.swapaxes(-1, -2) + 0.1 * np.eye(3)
    R = R if own_noise else np.tile(R[0], (modes, 1, 1))
    members = Members(tuple(EkfMember(pose_model(*mode)) for mode in zip(k, m, R, strict=True)))
    bank = EkfBank(pose_model(k, m, R if own_noise else R[0]), modes)
    means = rng.uniform(-np.pi, np.pi, (modes, 3))
    u, z = rng.normal(size=2), np.where(measured, rng.uniform(-4, 4, 3), np.nan)
    predicted = [each.predicted(means, covariances, u, 0.3) for each in (members, bank)]
    updated = [
        each.updated(*prediction, z)
        for each, prediction in zip((members, bank), predicted, strict=True)
    ]
    for looped, at_once in [*zip(*predicted, strict=True), *zip(*updated, strict=True)]:
        np.testing.assert_allclose(at_once, looped, rtol=1e-10, atol=1e-11)


def test_modes_may_share_jacobians_and_noise():
    """A Jacobian and a process noise without the modes in front hold for all."""
    k, m = np.array([0.5, 1.0]), np.array([0.4, 0.9])
    plain = pose_model(k, m)
    shared = replace(plain, measurement_jacobian=lambda _: np.eye(3))
    means, covariances = np.array([[0.0, 1, 2], [3, 2, 1]]), np.tile(np.eye(3), (2, 1, 1))
    z = np.array([np.nan, 0.3, 0.4])
    for one, other in zip(
        EkfBank(plain, 2).updated(means, covariances, z),
        EkfBank(shared, 2).updated(means, covariances, z),
        strict=True,
    ):
        np.testing.assert_allclose(one, other, rtol=1e-14, atol=1e-15)


def test_other_sizes_are_refused():
    bank = EkfBank(pose_model(np.ones(2), np.ones(2)), 2)
    with pytest.raises(EstimationError, match="4 states, expected 3"):
        bank.predicted(np.zeros((2, 4)), np.tile(np.eye(4), (2, 1, 1)), np.zeros(2), 0.1)
    with pytest.raises(EstimationError, match=r"shape .4,., expected .3,."):
        bank.updated(np.zeros((2, 3)), np.tile(np.eye(3), (2, 1, 1)), np.zeros(4))
