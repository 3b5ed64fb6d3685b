"""Predict and update against filterpy's, and what they keep."""

import numpy as np
import pytest
from filterpy.kalman import ExtendedKalmanFilter
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import EstimationError
from odometry.estimation.kalman import predicted, updated, updated_beside, updated_by_number
from odometry.estimation.measurement import Measurement
from odometry.estimation.transition import STATES

seeds, sizes = st.integers(0, 10**6), st.integers(1, 3)


def drawn(seed, size):
    """A belief, a measurement of it and the Jacobian of a step."""
    rng = np.random.default_rng(seed)
    scales = 10.0 ** rng.uniform(-3, 1, STATES)
    root = rng.normal(size=(STATES, STATES)) * scales[:, None]
    noise = np.diag(10.0 ** rng.uniform(-4, 0, size))
    measured = Measurement(rng.normal(size=size), rng.normal(size=(size, STATES)), noise)
    jacobian = np.eye(STATES) + rng.normal(0, 0.1, (STATES, STATES))
    return (rng.normal(size=STATES), root @ root.T), measured, jacobian


def filterpys(belief, size):
    ekf = ExtendedKalmanFilter(STATES, size)
    ekf.x, ekf.P = belief
    return ekf


def assert_alike(covariance, other):
    sigmas = np.sqrt(np.diag(other))
    np.testing.assert_allclose(covariance / np.outer(sigmas, sigmas),
                               other / np.outer(sigmas, sigmas), atol=1e-7)  # fmt: skip


@given(seeds)
def test_a_step_is_filterpys_with_half_of_the_noise_before_it(seed):
    belief, _, jacobian = drawn(seed, 1)
    half_noise = np.diag(np.random.default_rng(seed).uniform(0, 1, STATES))
    ekf = filterpys((belief[0], belief[1] + half_noise), 1)
    ekf.F, ekf.Q = jacobian, half_noise
    ekf.predict(0)
    assert_alike(predicted(belief[1], jacobian, half_noise), ekf.P)


@given(seeds, sizes)
def test_an_update_is_filterpys(seed, size):
    belief, measured, _ = drawn(seed, size)
    ekf = filterpys(belief, size)
    ekf.update(measured.residual, lambda _: measured.jacobian, lambda _: 0.0, measured.covariance)
    after = updated(belief, measured)
    np.testing.assert_allclose(after.mean, ekf.x, rtol=1e-6, atol=1e-8)
    assert_alike(after.covariance, ekf.P)
    np.testing.assert_allclose(after.weighed, ekf.SI @ ekf.y, rtol=1e-6)
    assert after.squared == pytest.approx(ekf.y @ ekf.SI @ ekf.y, rel=1e-6)
    assert np.array_equal(after.covariance, after.covariance.T)


@given(seeds, sizes)
def test_states_that_are_kept_count_for_what_is_expected(seed, size):
    belief, measured, _ = drawn(seed, size)
    mean, covariance = belief
    kept = np.array([3, 4, 5, 7, 8])
    after = updated_beside(belief, measured, kept)
    assert_alike(
        updated_beside(belief, measured, kept[:0]).covariance, updated(belief, measured).covariance
    )
    assert np.array_equal(after.mean[kept], mean[kept])
    of_kept = np.ix_(kept, kept)
    np.testing.assert_allclose(
        after.covariance[of_kept], covariance[of_kept], rtol=1e-9, atol=1e-12
    )
    # the error of the others after the same gain, over draws of the state and of the noise
    gain = covariance @ measured.jacobian.T
    gain = gain @ np.linalg.inv(measured.jacobian @ gain + measured.covariance)
    gain[kept] = 0.0
    np.testing.assert_allclose(after.mean, mean + gain @ measured.residual, rtol=1e-6, atol=1e-8)
    stays = np.eye(STATES) - gain @ measured.jacobian
    roots = np.hstack([stays @ np.linalg.cholesky(covariance), gain @ np.sqrt(measured.covariance)])
    assert_alike(after.covariance, roots @ roots.T)


@given(seeds)
def test_an_update_by_a_number_is_an_update(seed):
    belief, measured, _ = drawn(seed, 1)
    by_state = measured.jacobian[0]
    shared = belief[1] @ by_state
    variance = float(by_state @ shared + measured.covariance[0, 0])
    mean, covariance = updated_by_number(belief, shared, float(measured.residual[0]), variance)
    after = updated(belief, measured)
    np.testing.assert_allclose(mean, after.mean, rtol=1e-6, atol=1e-8)
    assert_alike(covariance, after.covariance)
    assert np.array_equal(covariance, covariance.T) == np.array_equal(belief[1], belief[1].T)


def test_a_place_that_nobody_knew_takes_the_variance_of_a_precise_pose():
    """The plain form P - K S K^T would be left with rounding errors of P."""
    measured = Measurement(np.zeros(2), np.eye(2, STATES), 1e-12 * np.eye(2))
    _, covariance, _, _ = updated((np.zeros(STATES), 1e6 * np.eye(STATES)), measured)
    np.testing.assert_allclose(np.diag(covariance)[:2], 1e-12, rtol=1e-3)


def test_a_covariance_that_is_none_is_an_error():
    measured = Measurement(np.zeros(1), np.eye(1, STATES), np.eye(1))
    with pytest.raises(EstimationError, match="not positive definite"):
        updated((np.zeros(STATES), -2 * np.eye(STATES)), measured)
