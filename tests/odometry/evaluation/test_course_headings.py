"""Headings from positions alone, and errors per metre measured from them, in closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.evaluation.relative import EvaluationConfig, course_headings, relative_errors
from odometry.trajectory import Trajectory

TRAVEL_M = np.arange(0, 30.05, 0.1)
CONFIG = EvaluationConfig(horizon_m=5.0, stride_m=0.5)


def curve(curvature, scale=1.0):
    """An arc from the origin along x; one metre a second, so that stamps are metres."""
    yaw = curvature * TRAVEL_M
    place = scale * TRAVEL_M * np.sinc(yaw / (2 * np.pi)) * np.exp(0.5j * yaw)  # the chord
    return Trajectory(TRAVEL_M, np.column_stack([place.real, place.imag, yaw]))


def without_yaw(trajectory):
    return Trajectory(trajectory.stamps_s, trajectory.poses * [1.0, 1.0, np.nan])


def errors(trajectory, reference):
    return relative_errors(trajectory, reference, TRAVEL_M, TRAVEL_M, CONFIG)


@given(st.floats(-3, 3), st.floats(-50, 50), st.floats(-0.3, 0.3))
def test_a_turned_and_moved_copy_gives_its_heading(turn, aside, curvature):
    truth = curve(curvature)
    ours = truth.moved(np.array([aside, -aside, turn]))
    rows = np.array([50, 120, 250])
    found = course_headings(ours.poses, truth.poses, TRAVEL_M, rows, 5.0)
    np.testing.assert_allclose(np.exp(1j * found), np.exp(1j * truth.poses[rows, 2]), atol=1e-9)


def test_a_drift_of_heading_is_not_hidden_by_the_alignment():
    """On a straight line, e s^2 / 2 aside after s metres, with the yaw or without it."""
    truth, ours = curve(0.0), curve(0.004)
    with_yaw = errors(ours, truth)
    found = errors(ours, without_yaw(truth))
    assert found.start_s[[0, -1]].tolist() == pytest.approx([5, 25])
    np.testing.assert_allclose(found.translation_per_m, 0.004 * 25 / 2 / 5, rtol=2e-3)
    np.testing.assert_allclose(with_yaw.translation_per_m, 0.004 * 25 / 2 / 5, rtol=1e-3)
    assert np.isnan(found.rotation_per_m).all()


@given(st.floats(0.7, 1.3), st.floats(-0.05, 0.05))
def test_a_scale_error_is_found_as_with_the_yaw(scale, curvature):
    truth, ours = curve(curvature), curve(curvature, scale)
    with_yaw, found = errors(ours, truth), errors(ours, without_yaw(truth))
    kept = np.isin(with_yaw.start_s, found.start_s)
    np.testing.assert_allclose(found.translation_per_m, with_yaw.translation_per_m[kept], atol=1e-9)


def test_noise_of_positions_adds_no_more_than_itself(rng):
    """1 cm each way at both ends of 5 m: about 1.25 sqrt(2) cm, and little more."""
    truth = curve(0.05)
    noisy = without_yaw(truth).poses + rng.normal(0, 0.01, (len(TRAVEL_M), 3))
    found = errors(truth, Trajectory(TRAVEL_M, noisy))
    assert 0.8 < found.translation_per_m.mean() * 5 / (0.01 * np.sqrt(np.pi)) < 1.2


def test_a_robot_that_turns_on_the_spot_determines_no_course():
    spin = Trajectory(TRAVEL_M, np.column_stack([0 * TRAVEL_M, 0 * TRAVEL_M, TRAVEL_M]))
    assert len(errors(spin, without_yaw(spin)).start_s) == 0


def test_where_some_rows_have_yaw_it_is_taken():
    """The first three metres: their windows start too early to have a course before them."""
    truth, ours = curve(0.02), curve(0.03, 1.1)
    partly = truth.poses.copy()
    partly[30:, 2] = np.nan
    whole = errors(ours, truth)
    found = errors(ours, Trajectory(TRAVEL_M, partly))
    assert found.start_s.min() == 0.0
    early = found.start_s < 3
    assert early.sum() == 6
    np.testing.assert_allclose(
        found.translation_per_m[early], whole.translation_per_m[:6], rtol=1e-12
    )
    assert np.isnan(found.rotation_per_m).all()  # no window ends where the yaw is known
