"""One filter of a bank, against filterpy and scipy."""

from dataclasses import replace

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter
from scipy.stats import multivariate_normal

from odometry.errors import EstimationError
from odometry.estimation.imm.ekf_bank import EkfModel
from tests.odometry.estimation.imm.ekf_member import EkfMember
from tests.odometry.estimation.imm.imm_banks import pose_model


def linear_model(rng, states=4, measured=3):
    F, H = rng.normal(size=(states, states)) / 2, rng.normal(size=(measured, states))
    Q, R = np.diag(rng.uniform(0.1, 1, states)), np.diag(rng.uniform(0.1, 1, measured))
    R[0, 1] = R[1, 0] = 0.05
    return EkfModel(
        states=states,
        transition=lambda x, *_: F @ x,
        transition_jacobian=lambda *_: F,
        process_noise=lambda *_: Q,
        measurement=lambda x: H @ x,
        measurement_jacobian=lambda _: H,
        measurement_covariance=R,
    )


def test_a_linear_model_gives_filterpys_kalman_filter(rng):
    model = linear_model(rng)
    theirs = KalmanFilter(dim_x=4, dim_z=3)
    theirs.F, theirs.Q = model.transition_jacobian(), model.process_noise()
    theirs.H, theirs.R = model.measurement_jacobian(0), model.measurement_covariance
    mean, covariance = np.zeros(4), np.eye(4)
    for _ in range(100):
        z = rng.normal(size=3)
        theirs.predict()
        theirs.update(z[:, None])
        mean, covariance = EkfMember(model).predicted(mean, covariance, None, 0.1)
        mean, covariance, log_likelihood, squared = EkfMember(model).updated(mean, covariance, z)
        np.testing.assert_allclose(mean, theirs.x[:, 0], atol=1e-12)
        np.testing.assert_allclose(covariance, theirs.P, atol=1e-12)
        assert log_likelihood == pytest.approx(theirs.log_likelihood, abs=1e-10)
        assert np.sqrt(squared) == pytest.approx(theirs.mahalanobis, abs=1e-10)


def test_covariances_are_symmetric_to_the_last_bit(rng):
    member = EkfMember(linear_model(rng))
    root = rng.normal(size=(4, 4))
    mean, covariance = member.predicted(np.zeros(4), root @ root.T, None, 0.1)
    np.testing.assert_array_equal(covariance, covariance.T)
    _, covariance, *_ = member.updated(mean, covariance, np.ones(3))
    np.testing.assert_array_equal(covariance, covariance.T)


@pytest.mark.parametrize("missing", [(0,), (2,), (0, 1), (1, 2)])
def test_entries_that_are_nan_are_left_out(rng, missing):
    """As a model that measures the others alone; its likelihood is theirs, by scipy."""
    model = linear_model(rng)
    kept = [i for i in range(3) if i not in missing]
    H, R = model.measurement_jacobian(0)[kept], model.measurement_covariance[np.ix_(kept, kept)]
    fewer = replace(
        model,
        measurement=lambda x: H @ x,
        measurement_jacobian=lambda _: H,
        measurement_covariance=R,
    )
    mean, covariance, z = rng.normal(size=4), np.diag([1.0, 2, 3, 4]), rng.normal(size=3)
    z[list(missing)] = np.nan
    result = EkfMember(model).updated(mean, covariance, z)
    for one, other in zip(result, EkfMember(fewer).updated(mean, covariance, z[kept]), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-13)
    expected = multivariate_normal.logpdf(z[kept], H @ mean, H @ covariance @ H.T + R)
    assert result[2] == pytest.approx(expected, abs=1e-10)


def test_headings_meet_on_the_short_way():
    """Measured -3.1, predicted 3.1, with equal variance: the answer lies 0.04 from both, at pi."""
    member = EkfMember(pose_model(1.0, 1.0, np.eye(3)))
    mean, _, _, squared = member.updated(np.array([0, 0, 3.1]), np.eye(3), np.array([0, 0, -3.1]))
    assert abs(mean[2]) == pytest.approx(np.pi, abs=1e-12)
    assert squared == pytest.approx((2 * np.pi - 6.2) ** 2 / 2)


def test_a_prediction_keeps_the_heading_in_its_range():
    mean, _ = EkfMember(pose_model(1.0, 1.0)).predicted(
        np.array([0, 0, 3.1]), np.eye(3), np.array([0, 1.0]), 0.1
    )
    assert mean[2] == pytest.approx(3.2 - 2 * np.pi)


def test_input_stays():
    """Even where the transition returns the very array it was given."""
    member = EkfMember(replace(pose_model(0.9, 0.8), transition=lambda x, *_: x))
    mean, covariance, z = np.array([1.0, 2, 4]), np.eye(3), np.array([1.1, np.nan, -3])
    copies = mean.copy(), covariance.copy(), z.copy()
    member.predicted(mean, covariance, np.array([1.0, 1.0]), 0.1)
    member.updated(mean, covariance, z)
    for one, copy in zip((mean, covariance, z), copies, strict=True):
        np.testing.assert_array_equal(one, copy)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"measurement_covariance": np.zeros((3, 3))}, "expected positive definite"),
        ({"measurement_covariance": np.ones(3)}, "expected square"),
        ({"state_angles": (3,)}, "state angles .3,., expected below 3"),
        ({"measurement_angles": (-1,)}, "measurement angles .-1,., expected below 3"),
    ],
)
def test_what_is_no_model_is_refused(changes, message):
    with pytest.raises(EstimationError, match=message):
        replace(pose_model(1.0, 1.0), **changes)


def test_other_sizes_are_refused():
    member = EkfMember(pose_model(1.0, 1.0))
    with pytest.raises(EstimationError, match=r"shape .2,., expected .3,."):
        member.updated(np.zeros(3), np.eye(3), np.zeros(2))
    with pytest.raises(EstimationError, match="4 states, expected 3"):
        member.predicted(np.zeros(4), np.eye(4), np.zeros(2), 0.1)
