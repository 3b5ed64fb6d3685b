"""Rigid motions against homogeneous matrices and scipy's matrix exponential."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from odometry.geometry import se2

length = st.floats(-50, 50)
turn = st.one_of(
    st.floats(-7, 7), st.floats(-3e-4, 3e-4), st.sampled_from([0.0, 1e-4, -1e-4, 1e-9, 1e-300])
)
pose = st.tuples(length, length, st.floats(-7, 7)).map(np.array)
displacement = st.tuples(length, length, turn).map(np.array)


def matrix(pose):
    x, y, yaw = pose
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, x], [s, c, y], [0, 0, 1]])


@given(displacement)
def test_exp_is_the_matrix_exponential(step):
    v_x, v_y, omega = step
    generator = np.array([[0, -omega, v_x], [omega, 0, v_y], [0, 0, 0]])
    np.testing.assert_allclose(matrix(se2.exp(step)), expm(generator), rtol=0, atol=1e-11)


@given(displacement)
def test_log_turns_exp_round(step):
    step[2] *= 0.85  # within a whole turn
    atol = 1e-11 / np.abs(np.sinc(step[2] / (2 * np.pi)))
    np.testing.assert_allclose(se2.log(se2.exp(step)), step, rtol=0, atol=atol)


def test_exp_of_a_quarter_turn_to_the_left():
    """A quarter of a circle of radius 2 ends 2 ahead and 2 to the left."""
    np.testing.assert_allclose(
        se2.exp(np.array([np.pi, 0, np.pi / 2])), [2, 2, np.pi / 2], atol=1e-15
    )


@pytest.mark.parametrize(
    "angles",
    [np.logspace(-300, -9, 59), np.logspace(-9, 0, 400), np.linspace(1, 50, 999)],
    ids=["tiny", "small", "turns"],
)
def test_exp_of_small_angles_and_of_turns_is_right_to_rounding(angles):
    """Beside sin(a)/a and 2 sin(a/2)^2 / a of longer numbers; of turns in units of the length."""
    angles = np.concatenate([-angles, angles])
    if np.finfo(np.longdouble).eps > 1e-18:
        pytest.skip("long numbers of this computer are no longer than others")
    steps = np.column_stack([np.ones_like(angles), np.zeros_like(angles), angles])
    longer = angles.astype(np.longdouble)
    expected = np.column_stack([np.sin(longer), 2 * np.sin(longer / 2) ** 2]) / longer[:, None]
    rounding = np.where(np.abs(angles[:, None]) > 1, 1.0, np.abs(expected)) * 1e-15
    assert (np.abs(se2.exp(steps)[:, :2] - expected) <= rounding).all()


def test_exp_keeps_whole_turns():
    assert se2.exp(np.array([0, 0, 7.0]))[2] == 7.0


@given(pose, pose)
def test_compose_is_the_matrix_product(one, other):
    np.testing.assert_allclose(
        matrix(se2.compose(one, other)), matrix(one) @ matrix(other), rtol=0, atol=1e-11
    )


@given(pose, pose)
def test_compose_one_is_compose_to_the_last_bit(one, other):
    assert se2.compose_one(one, other).tobytes() == se2.compose(one, other).tobytes()


@pytest.mark.parametrize("turn", [np.pi, -np.pi])
@pytest.mark.parametrize("yaw", [0.0, -0.0, 2 * np.pi, -2 * np.pi])
def test_half_a_turn_is_the_same_of_one_and_of_many(turn, yaw):
    one, other = np.array([1.0, 2.0, turn]), np.array([3.0, -4.0, yaw])
    assert se2.compose_one(one, other).tobytes() == se2.compose(one, other).tobytes()


@given(pose)
def test_inverse_undoes(one):
    np.testing.assert_allclose(
        matrix(se2.compose(one, se2.inverse(one))), np.eye(3), rtol=0, atol=1e-11
    )


@given(pose, pose)
def test_between_leads_from_one_to_the_other(one, other):
    np.testing.assert_allclose(
        matrix(se2.between(one, other)),
        np.linalg.inv(matrix(one)) @ matrix(other),
        rtol=0,
        atol=1e-10,
    )


@given(pose, st.tuples(length, length))
def test_transform_takes_points_to_the_parent(one, point):
    expected = matrix(one) @ [*point, 1]
    np.testing.assert_allclose(
        se2.transform(one, np.array(point)), expected[:2], rtol=0, atol=1e-11
    )


def test_transform_of_many_points_by_many_poses(rng):
    poses, points = rng.normal(size=(4, 1, 3)), rng.normal(size=(1, 5, 2))
    moved = se2.transform(poses, points)
    assert moved.shape == (4, 5, 2)
    np.testing.assert_allclose(moved[3, 2], se2.transform(poses[3, 0], points[0, 2]), atol=1e-15)


@pytest.mark.parametrize("function", [se2.compose, se2.between])
def test_stacks_of_pairs_are_taken_one_by_one(rng, function):
    ones, others = rng.normal(size=(2, 6, 3))
    each = [function(one, other) for one, other in zip(ones, others, strict=True)]
    np.testing.assert_allclose(function(ones, others), each, rtol=0, atol=1e-15)


def test_stacks_of_displacements_are_taken_one_by_one(rng):
    steps = np.vstack([rng.normal(size=(5, 3)), [1, 2, 0], [1, 2, 1e-7]])
    np.testing.assert_allclose(
        se2.exp(steps), [se2.exp(step) for step in steps], rtol=0, atol=1e-15
    )


@given(displacement)
def test_exp_jacobian_is_the_derivative(step):
    """Central differences; the error is of the order of eps / h for lengths of 50."""
    h = 1e-5
    numeric = np.column_stack(
        [(se2.exp(step + h * e) - se2.exp(step - h * e)) / (2 * h) for e in np.eye(3)]
    )
    np.testing.assert_allclose(se2.exp_jacobian(step), numeric, rtol=0, atol=2e-8)


@pytest.mark.parametrize("angle", [0.0, 5e-324, -2.2e-313, 1e-200, -1e-99, 1e-20])
def test_next_to_no_angle_is_a_straight_line(angle):
    """Down to the smallest numbers, which have few digits."""
    np.testing.assert_allclose(se2.exp(np.array([2.0, -3.0, angle])), [2, -3, angle], rtol=1e-15)
    jacobian = se2.exp_jacobian(np.array([2.0, -3.0, angle]))
    expected = [[1, 0, 1.5], [0, 1, 1.0], [0, 0, 1]]
    np.testing.assert_allclose(jacobian, expected, rtol=0, atol=1e-15)
