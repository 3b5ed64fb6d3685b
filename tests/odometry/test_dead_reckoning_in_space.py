"""Dead reckoning over tilted ground against exact motion in SE(3)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from odometry.dead_reckoning import dead_reckon, dead_reckon_in_space
from odometry.geometry import se3

tilt = st.floats(-0.5, 0.5)
twist = st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 3))
steps = st.lists(st.tuples(st.floats(0.01, 2), twist), min_size=1, max_size=6)


def attitude(roll, pitch, yaw):
    return Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()


def move_exactly(durations_s, twists, start):
    """Poses (N, 4, 4) of a body that keeps to its own plane, by matrix exponentials."""
    poses = [start]
    for duration_s, (v_x, v_y, omega) in zip(durations_s, twists, strict=True):
        rates = np.zeros((4, 4))
        rates[:2, 3], rates[1, 0], rates[0, 1] = (v_x, v_y), omega, -omega
        poses.append(poses[-1] @ expm(duration_s * rates))
    return np.array(poses)


def drive_on_a_plane(durations_s, twists, roll, pitch, *, yaw=0.4, position=(3.0, -1.0, 2.0)):
    """Exact poses, and ours from the twists and the roll and pitch of the exact ones."""
    exact = move_exactly(durations_s, twists, se3.pose(position, attitude(roll, pitch, yaw)))
    rolls, pitches = Rotation.from_matrix(exact[:, :3, :3]).as_euler("ZYX")[:, :0:-1].T
    stamps_s = np.append(0.0, np.cumsum(durations_s))
    held = np.vstack([twists, [9, 9, 9]])
    ours = dead_reckon_in_space(stamps_s, held, rolls, pitches, np.array([*position, yaw]))
    return exact, ours


@given(steps, tilt, tilt)
def test_on_a_plane_it_is_the_exact_motion_in_space(steps, roll, pitch):
    """Position, heading and, with the measured roll and pitch, the whole attitude."""
    durations_s, twists = (np.array(column) for column in zip(*steps, strict=True))
    exact, ours = drive_on_a_plane(durations_s, twists, roll, pitch)
    np.testing.assert_allclose(ours.poses, exact, rtol=0, atol=1e-12)


@given(steps, tilt, tilt, st.integers(2, 5))
def test_splitting_steps_on_a_plane_changes_nothing(steps, roll, pitch, parts):
    durations_s, twists = (np.array(column) for column in zip(*steps, strict=True))
    _, whole = drive_on_a_plane(durations_s, twists, roll, pitch)
    split_s, split_twists = np.repeat(durations_s / parts, parts), np.repeat(twists, parts, axis=0)
    _, split = drive_on_a_plane(split_s, split_twists, roll, pitch)
    np.testing.assert_allclose(split.poses[::parts], whole.poses, rtol=0, atol=1e-12)


def test_a_circle_on_a_slope_closes():
    """Radius 2, once around; half way it is a diameter away in the plane of the slope."""
    count = 38
    twists = np.tile([1.0, 0.0, -0.5], (count, 1))
    _, ours = drive_on_a_plane(np.full(count, 4 * np.pi / count), twists, 0.2, -0.3)
    np.testing.assert_allclose(ours.positions_m[-1], ours.positions_m[0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(ours.roll_pitch_yaw[-1], ours.roll_pitch_yaw[0], atol=1e-12)
    across = ours.positions_m[count // 2] - ours.positions_m[0]
    assert np.linalg.norm(across) == pytest.approx(4, rel=1e-12)
    assert abs(across[2]) > 0.5


def test_straight_up_a_slope():
    """Pitch -0.2 has the nose up: ten metres of track rise by 10 sin 0.2."""
    stamps_s, tilts = np.array([0.0, 10]), np.full(2, -0.2)
    start = np.array([0, 0, 1, np.pi / 2])
    ours = dead_reckon_in_space(stamps_s, np.tile([1.0, 0, 0], (2, 1)), None, tilts, start)
    expected = [0, 10 * np.cos(0.2), 1 + 10 * np.sin(0.2)]
    np.testing.assert_allclose(ours.positions_m[1], expected, rtol=0, atol=1e-14)
    np.testing.assert_allclose(ours.roll_pitch_yaw[1], [0, -0.2, np.pi / 2], rtol=0, atol=1e-14)


@pytest.mark.parametrize("missing", [None, np.full(30, np.nan), np.zeros(30)])
def test_level_or_unknown_terrain_is_the_plane(missing, rng):
    stamps_s, twists = np.cumsum(rng.uniform(0.01, 1, 30)), rng.normal(size=(30, 3))
    plane = dead_reckon(stamps_s, twists, np.array([1.0, 2, 3]))
    ours = dead_reckon_in_space(stamps_s, twists, missing, missing, np.array([1.0, 2, 7, 3]))
    np.testing.assert_allclose(ours.plane.poses, plane.poses, rtol=0, atol=1e-12)
    np.testing.assert_allclose(ours.positions_m[:, 2], 7, rtol=0, atol=0)


def test_empty_cells_are_interpolated_in_time(rng):
    stamps_s, twists = np.array([0.0, 1, 3, 4, 6]), rng.normal(size=(5, 3))
    roll, gapped = np.array([0.1, 0.1, 0.3, 0.4, 0.4]), np.array([np.nan, 0.1, np.nan, 0.4, np.nan])
    start = np.zeros(4)
    filled = dead_reckon_in_space(stamps_s, twists, roll, None, start)
    ours = dead_reckon_in_space(stamps_s, twists, gapped, None, start)
    np.testing.assert_allclose(ours.poses, filled.poses, rtol=0, atol=1e-14)


@given(tilt, tilt, st.floats(-3, 3), twist)
def test_rates_are_martinez_2024_eq_12(phi, alpha, psi, twist):
    """For a short step, with the paper's axes (Y forward, X right) turned into ours.

    The paper's heading psi belongs to another axis than our yaw; it is read from our poses.
    """
    turned = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])  # the paper's x is minus our y
    theirs = Rotation.from_euler("ZYX", [psi, alpha, phi]).as_matrix()
    yaw, pitch, roll = Rotation.from_matrix(theirs @ turned).as_euler("ZYX")
    v_x, v_y, omega = twist  # along the paper's axes
    duration_s = 1e-6
    step = np.array([duration_s]), np.array([[v_y, -v_x, omega]])
    _, ours = drive_on_a_plane(*step, roll, pitch, yaw=yaw, position=(0, 0, 0))
    moved = Rotation.from_matrix(ours.poses[:, :3, :3] @ turned.T).as_euler("ZYX")[:, 0]
    (s_phi, s_alpha, s_psi), (c_phi, c_alpha, c_psi) = (
        function([phi, alpha, psi]) for function in (np.sin, np.cos)
    )
    rates = [
        [c_psi * c_alpha, c_psi * s_phi * s_alpha - c_phi * s_psi, 0],
        [s_psi * c_alpha, c_psi * c_phi + s_phi * s_psi * s_alpha, 0],
        [-s_alpha, s_phi * c_alpha, 0],
        [0, 0, c_phi / c_alpha],
    ] @ np.array([v_x, v_y, omega])  # eq. 12
    np.testing.assert_allclose(ours.positions_m[1] / duration_s, rates[:3], rtol=0, atol=1e-5)
    assert (moved[1] - moved[0]) / duration_s == pytest.approx(rates[3], abs=1e-5)
