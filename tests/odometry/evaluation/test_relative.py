"""Relative and position errors against closed forms and what must not change them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import ConfigError
from odometry.evaluation.relative import EvaluationConfig, position_errors, relative_errors
from odometry.geometry import se2
from odometry.trajectory import Trajectory

STAMPS_S = np.arange(0, 32.1, 0.125)
FIVE_METRES = EvaluationConfig(horizon_m=5.0, stride_m=0.5)


def on_a_circle(speed, omega, stamps_s=STAMPS_S):
    """Closed form of a drive from the origin along x, on the complex plane."""
    yaw = omega * stamps_s
    place = speed * (stamps_s if omega == 0 else (np.exp(1j * yaw) - 1) / (1j * omega))
    return Trajectory(
        stamps_s, np.column_stack([place.real, place.imag, np.angle(np.exp(1j * yaw))])
    )


def errors_of(trajectory, reference, speed, config=FIVE_METRES):
    return relative_errors(trajectory, reference, STAMPS_S, speed * STAMPS_S, config)


def test_a_perfect_trajectory_has_no_error():
    circle = on_a_circle(1.0, 0.3)
    errors = errors_of(circle, circle, 1.0)
    assert len(errors.start_s) == 55
    np.testing.assert_allclose(errors.translation_per_m, 0, atol=1e-14)
    np.testing.assert_allclose(errors.rotation_per_m, 0, atol=1e-14)


@pytest.mark.parametrize("scale", [0.9, 1.25])
def test_a_scale_error_on_a_straight_line(scale):
    """|1 - scale| metres a metre, no turn, whatever the window."""
    errors = errors_of(on_a_circle(scale, 0), on_a_circle(1.0, 0), 1.0)
    np.testing.assert_allclose(errors.translation_per_m, abs(1 - scale), rtol=1e-12)
    np.testing.assert_allclose(errors.rotation_per_m, 0, atol=1e-15)


@pytest.mark.parametrize("scale", [0.9, 1.25])
def test_a_scale_error_on_a_circle(scale):
    """The chord of the true arc, times |1 - scale|: 2 R sin(h / 2 R) over h metres."""
    errors = errors_of(on_a_circle(scale * 0.5, 0.2), on_a_circle(0.5, 0.2), 0.5)
    chord = 2 * 2.5 * np.sin(5 / 5)
    np.testing.assert_allclose(errors.translation_per_m, abs(1 - scale) * chord / 5, rtol=1e-12)
    np.testing.assert_allclose(errors.rotation_per_m, 0, atol=1e-14)


@pytest.mark.parametrize("drift", [0.02, -0.05])
def test_a_heading_drift_on_a_circle(drift):
    """Both arcs in closed form over the 10 s that five metres take at half a metre a second."""
    speed, omega = 0.5, 0.2
    errors = errors_of(on_a_circle(speed, omega + drift), on_a_circle(speed, omega), speed)

    def arc_end(turn_rate):
        return speed * (np.exp(10j * turn_rate) - 1) / (1j * turn_rate)

    expected = abs(arc_end(omega + drift) - arc_end(omega)) / 5
    np.testing.assert_allclose(errors.translation_per_m, expected, rtol=1e-11)
    np.testing.assert_allclose(errors.rotation_per_m, abs(drift) * 10 / 5, rtol=1e-11)


def test_errors_are_per_metre_of_wheel_travel_not_of_path():
    """Wheels that travel twice the path halve the number, and the window is half the path."""
    errors = errors_of(on_a_circle(0.9, 0), on_a_circle(1.0, 0), speed=2.0)
    np.testing.assert_allclose(errors.translation_per_m, 0.05, rtol=1e-12)


def test_a_spin_on_the_spot_counts():
    """No path, but wheel travel: 1 m/s of treads, a turn of 2 rad/s estimated as 1.8."""
    stamps_s = np.arange(0, 20.1, 0.125)

    def spin(omega):
        yaw = np.angle(np.exp(1j * omega * stamps_s))
        return Trajectory(stamps_s, np.column_stack([0 * yaw, 0 * yaw, yaw]))

    errors = relative_errors(spin(1.8), spin(2.0), stamps_s, stamps_s, FIVE_METRES)
    np.testing.assert_allclose(errors.rotation_per_m, 0.2, rtol=1e-11)
    np.testing.assert_allclose(errors.translation_per_m, 0, atol=1e-15)


pose = st.tuples(st.floats(-100, 100), st.floats(-100, 100), st.floats(-3, 3)).map(np.array)


@given(pose, pose)
def test_relative_errors_do_not_feel_a_rigid_motion_of_either(one, other):
    trajectory, reference = on_a_circle(0.45, 0.25), on_a_circle(0.5, 0.2)
    plain = errors_of(trajectory, reference, 0.5)
    moved = errors_of(trajectory.moved(one), reference.moved(other), 0.5)
    np.testing.assert_allclose(moved.translation_per_m, plain.translation_per_m, atol=1e-12)
    np.testing.assert_allclose(moved.rotation_per_m, plain.rotation_per_m, atol=1e-12)


@given(pose)
def test_position_errors_do_not_feel_a_rigid_motion_of_both(one):
    trajectory, reference = on_a_circle(0.45, 0.25), on_a_circle(0.5, 0.2)
    _, plain = position_errors(trajectory, reference)
    _, moved = position_errors(trajectory.moved(one), reference.moved(one))
    np.testing.assert_allclose(moved, plain, atol=1e-11)


def test_position_errors_in_closed_form():
    stamps_s, distances = position_errors(on_a_circle(0.9, 0), on_a_circle(1.0, 0))
    np.testing.assert_allclose(distances, 0.1 * STAMPS_S, atol=1e-13)
    np.testing.assert_array_equal(stamps_s, STAMPS_S)


def test_position_errors_are_not_aligned():
    """A trajectory that starts elsewhere stays elsewhere."""
    line = on_a_circle(1.0, 0)
    _, distances = position_errors(line.moved(np.array([3.0, 4.0, 0.0])), line)
    np.testing.assert_allclose(distances, 5, rtol=1e-12)


def test_only_the_common_time_is_compared_at_the_references_stamps():
    reference = on_a_circle(1.0, 0)
    part = on_a_circle(1.0, 0, np.arange(10.05, 20, 0.1))
    stamps_s, distances = position_errors(part, reference)
    assert stamps_s[0] == 10.125
    assert stamps_s[-1] == 19.875
    np.testing.assert_allclose(distances, 0, atol=1e-12)
    errors = relative_errors(part, reference, STAMPS_S, STAMPS_S, FIVE_METRES)
    assert errors.start_s.min() >= 10.125
    assert errors.start_s.max() <= 14.875
    np.testing.assert_allclose(errors.translation_per_m, 0, atol=1e-12)


def test_nothing_in_common_gives_no_error():
    early, late = (
        on_a_circle(1.0, 0, np.array([0.0, 1.0])),
        on_a_circle(1.0, 0, np.array([2.0, 9.0])),
    )
    assert len(relative_errors(early, late, STAMPS_S, STAMPS_S, FIVE_METRES).start_s) == 0
    assert len(position_errors(early, late)[1]) == 0


def test_relative_errors_by_composition(rng):
    """Random walks, window by window with homogeneous matrices."""
    stamps_s = np.arange(40.0)
    walks = []
    for _ in range(2):
        poses = [np.zeros(3)]
        for step in rng.normal([0.5, 0, 0], [0.1, 0.1, 0.3], (39, 3)):
            poses.append(se2.compose(poses[-1], step))
        walks.append(Trajectory(stamps_s, np.array(poses)))

    def matrix(pose):
        c, s = np.cos(pose[2]), np.sin(pose[2])
        return np.array([[c, -s, pose[0]], [s, c, pose[1]], [0, 0, 1]])

    config = EvaluationConfig(horizon_m=3.0, stride_m=1.0)
    errors = relative_errors(*walks, stamps_s, stamps_s / 2, config)
    for k, start in enumerate(range(0, 34, 2)):
        ends = [
            np.linalg.inv(matrix(walk.poses[start])) @ matrix(walk.poses[start + 6])
            for walk in walks
        ]
        assert errors.start_s[k] == start
        distance = np.linalg.norm(ends[0][:2, 2] - ends[1][:2, 2])
        turn = ends[1][:2, :2].T @ ends[0][:2, :2]
        assert errors.translation_per_m[k] == pytest.approx(distance / 3, abs=1e-12)
        assert errors.rotation_per_m[k] == pytest.approx(
            abs(np.arctan2(turn[1, 0], turn[0, 0])) / 3, abs=1e-12
        )


def test_turns_count_in_full():
    """5 m of wheel travel in 5 s: 3.5 rad/s estimated as 2 are 7.5 rad off, not 7.5 - 2 pi."""
    errors = errors_of(on_a_circle(1.0, 2.0), on_a_circle(1.0, 3.5), 1.0)
    np.testing.assert_allclose(errors.rotation_per_m, 7.5 / 5, rtol=1e-11)


@pytest.mark.parametrize("settings", [{"horizon_m": 0.0}, {"stride_m": -1.0}])
def test_settings_without_meaning_are_refused(settings):
    with pytest.raises(ConfigError, match=next(iter(settings))):
        EvaluationConfig(**settings)
