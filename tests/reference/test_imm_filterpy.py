"""The IMM against filterpy's, where that has no fault: linear filters, each step measured."""

import numpy as np
from filterpy.kalman import IMMEstimator, KalmanFilter
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.estimation.imm.estimator import Imm, Members
from odometry.estimation.imm.mode_belief import ModeBelief
from tests.odometry.estimation.imm.ekf_member import EkfMember
from tests.reference.imm_systems import assert_same, linear_model, linear_system


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1), st.integers(2, 3), st.integers(1, 3))
def test_filterpy_where_it_has_no_fault(seed, modes, states):
    """Linear filters, each step measured, likelihoods far from underflow."""
    rng = np.random.default_rng(seed)
    systems, transition, start = linear_system(rng, modes, states, states)
    members = []
    for (F, G, Q, H, R), mean, covariance in zip(systems, start[1], start[2], strict=True):
        member = KalmanFilter(dim_x=states, dim_z=states, dim_u=2)
        member.F, member.B, member.Q, member.H, member.R = F, G, Q, H, R
        member.x, member.P = mean[:, None], covariance
        members.append(member)
    theirs = IMMEstimator(members, start[0], transition)
    bank = Members(tuple(EkfMember(linear_model(*system)) for system in systems))
    imm = Imm(bank, lambda _: transition, floor=0.0)
    belief = ModeBelief(start[1], start[2], np.log(start[0]))
    for _ in range(8):
        u, z = rng.normal(size=2), rng.normal(size=states)
        theirs.predict(u[:, None])
        theirs.update(z[:, None])
        belief = imm.step(belief, u, z, 0.1)
        each = theirs.mu, [f.x[:, 0] for f in members], [f.P for f in members]
        assert_same(belief, each, 1e-9)
        mean, covariance = imm.merged(belief)
        np.testing.assert_allclose(mean, theirs.x[:, 0], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(covariance, theirs.P, rtol=1e-9, atol=1e-9)
