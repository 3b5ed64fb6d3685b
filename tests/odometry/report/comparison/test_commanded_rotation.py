from itertools import pairwise

import numpy as np

from odometry.report.comparison.comparison_plots import (
    CommandedRotation,
    commanded_rotation,
    difference_edges,
    plot_commanded_rotation,
)
from odometry.report.drawing.figure import LineStyle

STYLE = LineStyle("#0000FF")


def test_quartiles_by_difference_are_those_of_a_loop(rng):
    differences = rng.uniform(-1, 1, 400)
    turns = 30 * differences + rng.normal(0, 2, 400)
    edges = difference_edges(differences)
    found = commanded_rotation(differences, turns, edges)
    expected = [
        np.percentile(turns[(differences >= low) & (differences < high)], [25, 50, 75])
        for low, high in pairwise(edges)
    ]
    np.testing.assert_allclose(found.quartiles_deg_per_m, expected)
    np.testing.assert_allclose(found.quartiles_deg_per_m[:, 1], 30 * found.differences_m_s, atol=3)


def test_bins_of_few_windows_are_left_out(axes):
    differences = np.array([0.0] * 4 + [1.0] * 3)
    found = commanded_rotation(differences, np.arange(7.0), difference_edges(differences))
    assert found.differences_m_s.tolist() == [0.0]
    assert found.quartiles_deg_per_m[0, 1] == 1.5
    none = commanded_rotation(differences[:2], np.zeros(2), difference_edges(differences))
    assert none.quartiles_deg_per_m.shape == (0, 3)
    plot_commanded_rotation(axes, found, [none, found], STYLE)
    grey, line = [line for line in axes.lines if len(line.get_xdata()) == 1]
    np.testing.assert_array_equal(line.get_xydata(), [[0.0, 1.5]])
    assert (grey.get_color(), line.get_color()) == ("#BBBBBB", STYLE.colour)
    axes.figure.canvas.draw()


def test_the_band_goes_from_quartile_to_quartile(axes):
    quartiles = np.array([[1.0, 2, 4], [2, 3, 7]])
    plot_commanded_rotation(axes, CommandedRotation(np.array([0.0, 1.0]), quartiles), [], STYLE)
    (band,) = axes.collections
    corners = {tuple(corner) for corner in band.get_paths()[0].vertices}
    assert {(0, 1), (0, 4), (1, 2), (1, 7)} <= corners
