"""Strips of terrain, footprints and noise."""

import numpy as np
import pytest

from odometry.simulation.ground import GroundMap, footprint_points, to_world
from odometry.simulation.noise import measured_poses, ornstein_uhlenbeck


def test_strips_between_straight_edges():
    ground = GroundMap(np.array([1.0, 3.0]), ("a", "b", "a"))
    strips = ground.strip_at(np.array([[-9.0, 5.0], [0.99, 0.0], [1.01, -2.0], [3.5, 0.0]]))
    assert strips.tolist() == [0, 0, 1, 2]


def test_waves_move_the_edge_by_their_offset():
    ground = GroundMap(np.array([1.0]), ("a", "b"), 0.06, (0.3, 1.2))
    y = np.linspace(-2, 2, 101)
    edge = 1.0 + ground.edge_offset_m(y)
    assert np.ptp(edge) > 0.1
    assert (ground.strip_at(np.column_stack([edge - 1e-9, y])) == 0).all()
    assert (ground.strip_at(np.column_stack([edge + 1e-9, y])) == 1).all()


def test_shares_of_a_footprint_astride_an_edge():
    ground = GroundMap(np.array([0.0]), ("a", "b"))
    points = footprint_points(0.6, 0.4)
    np.testing.assert_allclose(np.abs(points).max(axis=0), [0.28, 0.16])
    np.testing.assert_allclose(
        ground.strip_shares(to_world(np.array([0.1, 0.0, 0.0]), points)), [1 / 3, 2 / 3], atol=1e-9
    )


def test_to_world_turns_left_for_positive_yaw():
    point = to_world(np.array([1.0, 2.0, np.pi / 2]), np.array([0.5, 0.1]))
    np.testing.assert_allclose(point, [0.9, 2.5])


@pytest.mark.parametrize("edges", [[1.0], [2.0, 1.0], [1.0, 1.0]])
def test_edges_that_do_not_fit(edges):
    with pytest.raises(ValueError, match="3 strips need 2 increasing edges"):
        GroundMap(np.array(edges), ("a", "b", "c"))


def test_ornstein_uhlenbeck_has_its_sigma_and_time_constant():
    rng = np.random.default_rng(3)
    samples = ornstein_uhlenbeck(200_000, 0.1, np.array([0.5, 2.0]), 1.0, rng)
    np.testing.assert_allclose(samples.std(axis=0), [0.5, 2.0], rtol=0.03)
    lag = (samples[10:] * samples[:-10]).mean(axis=0) / samples.var(axis=0)
    np.testing.assert_allclose(lag, np.exp(-1.0), atol=0.03)
    assert abs(np.corrcoef(samples.T)[0, 1]) < 0.03


def test_measured_poses_have_their_sigma_and_wrapped_yaw():
    truth = np.tile([1.0, -2.0, np.pi], (20_000, 1))
    noisy = measured_poses(truth, 0.02, 0.1, np.random.default_rng(4))
    error = noisy - truth
    error[:, 2] = np.arctan2(np.sin(error[:, 2]), np.cos(error[:, 2]))
    np.testing.assert_allclose(error.std(axis=0), [0.02, 0.02, 0.1], rtol=0.03)
    np.testing.assert_allclose(error.mean(axis=0), 0.0, atol=0.003)
    assert (np.abs(noisy[:, 2]) <= np.pi).all()
