"""ICRs from a twist: round trips, printed numbers, symmetries, and noise against samples."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.icrs.points import icr_covariances, icr_indices, icrs_of_twist, turn_is_known
from odometry.models.icr import icr_twist

side = st.floats(0.1, 2)
speed = st.floats(-2, 2)
alpha = st.floats(0.3, 1.2)
TWIST = np.array([0.55, -0.04, 0.8])
SPEEDS = np.array([0.2, 1.0])


@given(
    st.tuples(side, side.map(lambda y: -y), st.floats(-1, 1)).map(np.array),
    st.tuples(speed, speed).map(np.array),
    st.tuples(alpha, alpha).map(np.array),
)
def test_the_icrs_of_a_model_come_back(icrs, speeds, alphas):
    twist = icr_twist(icrs, alphas * speeds)
    if abs(twist[2]) > 1e-3:
        np.testing.assert_allclose(icrs_of_twist(twist, speeds, alphas), icrs, atol=1e-11)


def test_a_turn_by_hand():
    """About a point 0.5 m to the left, 0.1 m ahead, at 2 rad/s; the left tread slips by a fifth."""
    twist = np.array([1.0, -0.2, 2.0])
    np.testing.assert_allclose(
        icrs_of_twist(twist, np.array([0.5, 2.2]), (0.8, 1.0)), [0.3, -0.6, 0.1], atol=1e-15
    )


def test_the_printed_indices_of_auriga():
    """Martinez 2017 eq. 20 to 22 in the paper's frame, with its zeta_0, epsilon_0 and eta_0."""
    zeta, epsilon, eta, track_width_m = 0.048, 0.106, 2.62, 0.42
    v_l, v_r = -0.3, 0.7
    omega = (v_r - v_l) / (track_width_m * eta)  # eq. 20
    lateral, longitudinal = omega * zeta, (v_l + v_r) / 2 - omega * epsilon  # eq. 21 and 22
    icrs = icrs_of_twist(np.array([longitudinal, -lateral, omega]), np.array([v_l, v_r]))
    np.testing.assert_allclose(icr_indices(icrs, track_width_m), [zeta, epsilon, eta], rtol=1e-12)


def test_the_indices_of_the_printed_mean_icrs():
    """Martinez 2017, end of section II: (x_ICRl, x_ICRr, y_ICR) = (-0.458, 0.630, 0.0482) m."""
    indices = icr_indices(np.array([0.458, -0.630, 0.0482]), 0.42)
    np.testing.assert_allclose(indices, [0.0482, 0.086, 1.088 / 0.42], rtol=1e-12)


def test_a_mirrored_turn_has_mirrored_icrs():
    y_left, y_right, x_icr = icrs_of_twist(TWIST, SPEEDS)
    np.testing.assert_allclose(
        icrs_of_twist(TWIST * [1, -1, -1], SPEEDS[::-1]), [-y_right, -y_left, x_icr]
    )


def test_units():
    """Another unit of length scales all ICRs by the same factor, another unit of time does not."""
    icrs = icrs_of_twist(TWIST, SPEEDS)
    np.testing.assert_allclose(icrs_of_twist(TWIST * [1e3, 1e3, 1], SPEEDS * 1e3), icrs * 1e3)
    np.testing.assert_allclose(icrs_of_twist(TWIST / 60, SPEEDS / 60), icrs)


@pytest.mark.parametrize("omega", [0.0, -0.0, 1e-320])
def test_without_a_turn_nothing_is_said(omega):
    twists = np.array([[0.5, 0.0, omega], TWIST])
    icrs = icrs_of_twist(twists, np.array([[0.4, 0.4], SPEEDS]))
    assert np.isnan(icrs[0]).all()
    assert np.isfinite(icrs[1]).all()
    covariances = icr_covariances(twists, np.tile(SPEEDS, (2, 1)), np.eye(3), np.ones(2))
    assert np.isnan(covariances[0]).any()
    assert np.isfinite(covariances[1]).all()


def test_covariances_are_those_of_samples():
    rng = np.random.default_rng(4)
    root = 1e-3 * rng.normal(size=(3, 3))
    of_twist, of_speeds, alphas = root @ root.T, np.array([4e-6, 1e-6]), (0.8, 0.9)
    twists = TWIST + rng.normal(size=(200_000, 3)) @ root.T
    speeds = SPEEDS + rng.normal(size=(200_000, 2)) * np.sqrt(of_speeds)
    sampled = np.cov(icrs_of_twist(twists, speeds, alphas).T)
    stated = icr_covariances(TWIST, SPEEDS, of_twist, of_speeds, alphas)
    np.testing.assert_allclose(stated, sampled, rtol=0.02, atol=0.01 * stated.max())


def test_a_turn_is_certain_by_the_probability_of_its_side():
    """One side in a hundred is wrong at most where a robot goes straight ahead in truth."""
    noise = np.random.default_rng(5).normal(scale=0.03, size=100_000)
    told = turn_is_known(noise, np.full(100_000, 0.03), 0.99)
    assert told.mean() == pytest.approx(2 * 0.01, abs=0.002)
    assert turn_is_known(np.array([-0.2]), np.array([0.03]), 0.99).all()
