"""Covariances along a path against errors put in step by step, and in closed form."""

import numpy as np
import pytest

from odometry.evaluation.open_loop_errors import AMOUNTS, COMPONENTS, SOURCES, OpenLoopPath
from odometry.geometry import se2

STEP = 1e-6


@pytest.fixture
def steps(rng):
    """Motions of a robot that winds about, and the signed travel of its treads at each."""
    moved = np.column_stack(
        [rng.uniform(0.1, 0.4, 14), rng.normal(0, 0.02, 14), rng.normal(0, 0.4, 14)]
    )
    moved[5:8, 0] *= -1.0  # it reverses
    return moved, moved[:, 0] * 1.1


def chain(steps, start=(0.5, -1.0, 0.7)):
    poses = [np.array(start)]
    for step in steps:
        poses.append(se2.compose(poses[-1], step))
    return np.array(poses)


def path_of(steps, signed):
    return OpenLoopPath(
        chain(steps), np.append(0, np.cumsum(np.abs(signed))), np.append(0, np.cumsum(signed))
    )


def with_error(step, error):
    """A step with an error in the middle of it, in the robot's frame there."""
    half = np.array([step[0] / 2, step[1] / 2, step[2] / 2])
    forward = np.array([*half[:2], half[2]])
    rest = se2.between(forward, step)
    return se2.compose(se2.compose(forward, error), rest)


def by_hand(steps, signed, first, last):
    """Derivatives of the motion from first to last by an error at each step, one at a time."""
    found = np.zeros((len(SOURCES), 3, 3))
    chosen, signed = steps[first:last], signed[first:last]
    plain = chain(chosen, (0, 0, 0))[-1]
    for component in range(3):
        slopes = []
        for k in range(len(chosen)):
            error = np.zeros(3)
            error[component] = STEP
            bent = chosen.copy()
            bent[k] = with_error(chosen[k], error)
            slopes.append((chain(bent, (0, 0, 0))[-1] - plain) / STEP)
        slopes = np.reshape(slopes, (-1, 3))
        for place, by in enumerate((signed, chosen[:, 2])):
            weights = np.abs(by)
            found[2 * component + place] = (slopes * weights[:, None]).T @ slopes
            whole = by @ slopes
            found[6 + 2 * component + place] = np.outer(whole, whole)
    return found


@pytest.mark.parametrize(("first", "last"), [(0, 14), (3, 11), (6, 7), (4, 4)])
def test_every_source_is_what_errors_put_in_by_hand_make(steps, first, last):
    moved, signed = steps
    found = path_of(moved, signed).unit_covariances(np.array([first]), np.array([last]))[0]
    expected = by_hand(moved, signed, first, last)
    np.testing.assert_allclose(found, expected, atol=2e-4)


def test_errors_of_steps_move_the_poses_after_them(steps, rng):
    """Small errors in the middle of every step, against the path chained anew with them."""
    moved, signed = steps
    errors = rng.normal(0, STEP, moved.shape)
    bent = np.array([with_error(*pair) for pair in zip(moved, errors, strict=True)])
    path = path_of(moved, signed)
    difference = chain(bent) - path.poses
    difference[:, 2] = np.angle(np.exp(1j * difference[:, 2]))
    (found,) = path.moved_by(lambda some: errors[some, :, None])
    np.testing.assert_allclose(found[..., 0], difference, atol=2e-3 * STEP)


def test_the_names_are_in_the_order_of_the_numbers():
    assert len(SOURCES) == 12
    assert SOURCES[:2] == ("random_x_per_m", "random_x_per_rad")
    assert SOURCES[-1] == "constant_yaw_per_rad"
    assert (len(COMPONENTS), len(AMOUNTS)) == (3, 2)


def test_a_straight_line_in_closed_form():
    """Random yaw 1 a metre: L of yaw, L^3 / 3 aside, L^2 / 2 both; constant: L^2, L^4 / 4."""
    metres = np.linspace(0, 10, 2001)
    line = OpenLoopPath(np.column_stack([metres, 0 * metres, 0 * metres]), metres, metres)
    units = line.unit_covariances(np.array([0]), np.array([2000]))[0]
    by = dict(zip(SOURCES, units, strict=True))
    np.testing.assert_allclose(
        by["random_yaw_per_m"], [[0, 0, 0], [0, 1000 / 3, 50], [0, 50, 10]], atol=1e-3
    )
    np.testing.assert_allclose(
        by["constant_yaw_per_m"], [[0, 0, 0], [0, 2500, 500], [0, 500, 100]], atol=1e-6
    )
    np.testing.assert_allclose(by["random_x_per_m"], np.diag([10.0, 0, 0]), atol=1e-9)
    np.testing.assert_allclose(by["constant_x_per_m"], np.diag([100.0, 0, 0]), atol=1e-9)
    assert not by["random_yaw_per_rad"].any()


def test_covariances_do_not_feel_where_the_path_lies(steps):
    moved, signed = steps
    one = path_of(moved, signed)
    far = OpenLoopPath(
        se2.compose(np.array([400.0, -300.0, 2.0]), one.poses), one.travel_m, one.signed_m
    )
    pairs = np.array([0, 2]), np.array([9, 14])
    np.testing.assert_allclose(
        far.unit_covariances(*pairs), one.unit_covariances(*pairs), atol=1e-8
    )


def test_the_covariance_of_the_start_is_carried_along(steps):
    """By finite differences of the whole path by its first pose."""
    moved, signed = steps
    path = path_of(moved, signed)
    start = np.array([[0.04, 0.01, 0.0], [0.01, 0.09, 0.02], [0.0, 0.02, 0.01]])
    found = np.concatenate(list(path.carried(start, np.zeros(12))))
    first, last = path.poses[0], path.poses[-1]
    slopes = [(chain(moved, first + STEP * unit)[-1] - last) / STEP for unit in np.eye(3)]
    by_start = np.array(slopes).T
    np.testing.assert_allclose(found[0], start, atol=1e-12)
    np.testing.assert_allclose(found[-1], by_start @ start @ by_start.T, atol=1e-5)


def test_errors_on_the_way_are_turned_into_the_frame_of_the_path():
    """Along y of the world, an error along x of the robot is one of y."""
    metres = np.linspace(0, 5, 51)
    line = OpenLoopPath(
        np.column_stack([0 * metres, metres, 0 * metres + np.pi / 2]), metres, metres
    )
    variances = np.array([name == "random_x_per_m" for name in SOURCES], float)
    (found,) = line.carried(np.zeros((3, 3)), variances)
    np.testing.assert_allclose(found[-1], np.diag([0, 5.0, 0]), atol=1e-12)
