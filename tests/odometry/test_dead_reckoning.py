import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.dead_reckoning import dead_reckon


def test_a_circle_closes():
    """Speed 1 around a radius of 2 for its whole length, to the right."""
    stamps_s = np.linspace(0, 4 * np.pi, 38)
    twists = np.tile([1.0, 0.0, -0.5], (38, 1))
    trajectory = dead_reckon(stamps_s, twists, np.array([3.0, -1.0, 0.7]))
    np.testing.assert_allclose(trajectory.poses[-1, :2], [3, -1], atol=1e-12)
    centre = np.array([3, -1]) + 2 * np.array([np.sin(0.7), -np.cos(0.7)])
    radii = np.linalg.norm(trajectory.poses[:, :2] - centre, axis=1)
    np.testing.assert_allclose(radii, 2, atol=1e-12)


def test_a_sideways_slide():
    trajectory = dead_reckon(
        np.array([0.0, 2.0]), np.array([[0, 0.5, 0], [9, 9, 9.0]]), np.zeros(3)
    )
    np.testing.assert_allclose(trajectory.poses, [[0, 0, 0], [0, 1, 0]], atol=1e-15)


def test_yaw_stays_on_the_circle():
    trajectory = dead_reckon(np.arange(9.0), np.tile([0, 0, 1.0], (9, 1)), np.zeros(3))
    assert np.all(np.abs(trajectory.poses[:, 2]) <= np.pi)


twist = st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 3))


@given(st.lists(st.tuples(st.floats(0.01, 2), twist), min_size=1, max_size=6), st.integers(2, 7))
def test_splitting_steps_changes_nothing(steps, parts):
    durations = np.array([duration for duration, _ in steps])
    twists = np.array([twist for _, twist in steps])
    start = np.array([1.0, 2.0, 3.0])
    coarse_s = np.concatenate([[0], np.cumsum(durations)])
    whole = dead_reckon(coarse_s, np.vstack([twists, twists[-1:]]), start)
    fine_s = np.concatenate([[0], np.cumsum(np.repeat(durations / parts, parts))])
    split_twists = np.repeat(twists, parts, axis=0)
    split = dead_reckon(fine_s, np.vstack([split_twists, split_twists[-1:]]), start)
    np.testing.assert_allclose(split.poses[::parts, :2], whole.poses[:, :2], atol=1e-10)


@given(st.lists(twist, min_size=2, max_size=6))
def test_against_midpoint_integration_in_fine_steps(twists):
    """Midpoint steps of 1/400 s: an error of v omega^2 dt^2 / 24 a second, below 1e-5 here."""
    trajectory = dead_reckon(np.arange(len(twists), dtype=float), np.array(twists), np.zeros(3))
    x = y = yaw = 0.0
    for v_x, v_y, omega in twists[:-1]:
        for _ in range(400):
            middle = yaw + omega / 800
            x += (v_x * np.cos(middle) - v_y * np.sin(middle)) / 400
            y += (v_x * np.sin(middle) + v_y * np.cos(middle)) / 400
            yaw += omega / 400
    np.testing.assert_allclose(trajectory.poses[-1, :2], [x, y], atol=1e-4)
