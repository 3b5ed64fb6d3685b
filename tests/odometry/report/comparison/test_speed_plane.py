import numpy as np
import pytest

from odometry.report.comparison.speed_plane import (
    BINS,
    common_range,
    plot_speed_plane,
    speed_edges,
    speed_plane,
)


def test_means_by_bin_are_those_of_a_loop(rng):
    speeds, errors = rng.uniform(-1, 2, (300, 2)), rng.uniform(0, 1, 300)
    edges = speed_edges(speeds)
    plane = speed_plane(speeds, errors, edges)
    assert plane.means.shape == (BINS, BINS)
    for row in range(BINS):
        for column in range(BINS):
            left = (speeds[:, 0] >= edges[column]) & (speeds[:, 0] < edges[column + 1])
            right = (speeds[:, 1] >= edges[row]) & (speeds[:, 1] < edges[row + 1])
            here = errors[left & right]
            expected = here.mean() if len(here) else np.nan
            assert plane.means[row, column] == pytest.approx(expected, nan_ok=True)


def test_left_is_across_and_right_is_up(axes):
    """One window at v_left = 2, v_right = -1: the bin at the bottom right."""
    speeds = np.array([[2.0, -1.0], [-1.0, -1.0]])
    plane = speed_plane(speeds, np.array([5.0, 1.0]), speed_edges(speeds))
    assert plane.means[0, -1] == 5.0
    assert plane.means[0, 0] == 1.0
    mesh = plot_speed_plane(axes, plane, (0.5, 10.0))
    assert mesh.get_array()[0, -1] == 5.0
    assert mesh.get_array().mask[-1, 0]
    axes.figure.canvas.draw()


def test_colours_leave_out_extremes_and_zeros(rng):
    edges = np.linspace(0, 1, BINS + 1)
    speeds = rng.uniform(0, 1, (4000, 2))
    plane = speed_plane(speeds, np.where(speeds[:, 0] < 0.1, 0.0, 2.0), edges)
    low, high = common_range([plane])
    assert 0 < low < high
    assert common_range([speed_plane(speeds, np.zeros(4000), edges)]) == (1e-3, 1.0)


def test_a_robot_of_one_speed_has_bins_all_the_same():
    edges = speed_edges(np.full((3, 2), 0.5))
    assert np.all(np.diff(edges) > 0)
