"""Largest slope and the way up, against the normal of a plane."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.geometry.se3 import rotation_from_roll_pitch_yaw
from odometry.geometry.tilt import paper_attitude, steepest_slope

angle = st.floats(-0.3, 0.3)


def attitude_on(slope_rad, gamma_rad):
    """Roll and pitch, by heights of the body axes, of a robot gamma to the left of uphill."""
    up = np.array([np.cos(gamma_rad), -np.sin(gamma_rad)]) * np.sin(slope_rad)  # in body axes
    pitch = -np.arcsin(up[0])
    return np.arcsin(up[1] / np.cos(pitch)), pitch


@given(st.floats(0.01, 0.3), st.floats(-3, 3))
def test_a_robot_on_a_slope(slope_rad, gamma_rad):
    beta, gamma = steepest_slope(*attitude_on(slope_rad, gamma_rad))
    assert beta == pytest.approx(slope_rad, rel=slope_rad**2)
    assert gamma == pytest.approx(gamma_rad, abs=slope_rad**2)


@pytest.mark.parametrize(
    ("roll", "pitch", "gamma"),
    [(0, -0.1, 0.0), (-0.1, 0, np.pi / 2), (0.1, 0, -np.pi / 2), (0, 0.1, np.pi)],
    ids=["uphill", "uphill is right", "uphill is left", "downhill"],
)
def test_which_way_is_up(roll, pitch, gamma):
    found = steepest_slope(np.array(roll), np.array(pitch))
    np.testing.assert_allclose(np.abs(found), [0.1, abs(gamma)], atol=1e-15)
    assert np.sin(found[1]) == pytest.approx(np.sin(gamma), abs=1e-15)


def test_on_level_ground_no_way_is_up():
    beta, gamma = steepest_slope(np.zeros(2), np.array([0.0, 0.1]))
    assert beta[0] == 0
    assert np.isnan(gamma[0])
    assert np.isfinite(gamma[1])


@given(angle, angle)
def test_the_papers_angles_give_the_same_heights(roll, pitch):
    """Ry(alpha) Rx(phi) about the paper's axes: heights of forward (Y) and right (X)."""
    alpha, phi = paper_attitude(np.array(roll), np.array(pitch))
    rotation = rotation_from_roll_pitch_yaw(np.array([roll, pitch, 0.0]))
    forward, left = rotation[2, 0], rotation[2, 1]
    assert np.cos(alpha) * np.sin(phi) == pytest.approx(forward, abs=1e-12)
    assert -np.sin(alpha) == pytest.approx(-left, abs=1e-12)
