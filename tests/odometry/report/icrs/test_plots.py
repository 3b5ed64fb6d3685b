"""What is drawn is what was given."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from odometry.evaluation.stretches import Stretch
from odometry.report.drawing.figure import LineStyle
from odometry.report.icrs.plots import (
    mark_changes,
    plot_error_distribution,
    plot_icr,
    plot_position_errors,
)

STYLES = {
    "a": LineStyle("#0000FF"),
    "$b^$": LineStyle("#FF0000", "dashed"),
    "truth": LineStyle("#000000"),
}
T = np.array([0.0, 1.0, 2.0, 3.0])


def line(axes, label):
    (found,) = [line for line in axes.lines if line.get_label() == label]
    return found.get_xydata().T


def test_icr_lines_and_bands_are_the_estimate(axes):
    values, sigmas = np.array([0.3, 0.4, 0.5, 0.4]), np.array([5.0, 0.02, 0.01, 0.01])
    truth = (T[:3], np.array([0.3, 0.45, 0.5]))
    estimates = {"a": (T, values, sigmas), "$b^$": (T, values + 0.1, sigmas)}
    plot_icr(axes, "y_left", estimates, truth, STYLES)
    assert line(axes, "a") == pytest.approx(np.array([T, values]))
    assert line(axes, "$b^$") == pytest.approx(np.array([T, values + 0.1]))
    assert line(axes, "truth") == pytest.approx(np.array(truth))
    bands = [c for c in axes.collections if isinstance(c, PolyCollection)]
    corners = {tuple(np.round(v, 9)) for v in bands[0].get_paths()[0].vertices}
    for t, value, sigma in zip(T, values, sigmas, strict=True):
        assert (t, round(value + 2 * sigma, 9)) in corners
        assert (t, round(value - 2 * sigma, 9)) in corners
    assert axes.get_ylabel() == "y_left [m]"
    low, high = axes.get_ylim()
    assert low < 0.3
    assert 0.6 < high < 1.0  # the band of 5 m does not squeeze the values


def test_a_constant_icr_can_be_drawn(axes):
    plot_icr(axes, "x_icr", {"a": (T, np.zeros(4), np.zeros(4))}, None, STYLES)
    low, high = axes.get_ylim()
    assert low < 0 < high


def test_changes_are_marked_where_another_terrain_begins(axes):
    stretches = (Stretch("ice", 0, 4), Stretch("snow $^", 4, 7), Stretch("ice", 7, 9))
    axes.set_xlim(0, 9)
    mark_changes(axes, stretches)
    assert [line.get_xdata()[0] for line in axes.lines] == [4, 7]
    assert not axes.texts
    mark_changes(axes, stretches, names=True)
    assert [text.get_text() for text in axes.texts] == ["ice", "snow $^", "ice"]
    axes.figure.canvas.draw()


def test_a_name_without_room_does_not_lie_over_the_next_one(axes):
    axes.set_xlim(0, 90)
    mark_changes(axes, (Stretch("ice", 0, 1), Stretch("snow", 1, 90)), names=True)
    assert [text.get_text() for text in axes.texts] == ["snow"]


def test_position_errors_are_drawn_from_zero_up(axes):
    plot_position_errors(axes, {"a": (T, T**2), "$b^$": (T, T / 2)}, STYLES)
    assert line(axes, "a") == pytest.approx(np.array([T, T**2]))
    assert axes.get_ylim()[0] == 0
    assert axes.get_xlabel() == "time [s]"
    assert axes.get_ylabel() == "position error [m]"
    axes.figure.canvas.draw()


def test_boxes_show_quartiles_and_mean(axes):
    values = np.arange(101.0) ** 2
    plot_error_distribution(axes, {"a": values, "none": values[:0], "$b^$": [1.0]}, STYLES, "cm")
    medians = [line.get_xdata()[0] for line in axes.lines if line.get_linewidth() == 2.0]
    assert medians == [50.0**2, 1.0]
    means = [line.get_xdata()[0] for line in axes.lines if line.get_marker() == "D"]
    assert means == [pytest.approx(values.mean()), 1.0]
    (box, _) = axes.patches
    assert set(box.get_path().vertices[:-1, 0]) == {25.0**2, 75.0**2}
    whiskers = {x for line in axes.lines for x in line.get_xdata()}
    assert {5.0**2, 95.0**2} <= whiskers
    assert [label.get_text() for label in axes.get_yticklabels()] == ["a", "$b^$"]
    axes.figure.canvas.draw()


def test_boxes_that_differ_much_have_a_logarithmic_axis(axes):
    few, many = np.linspace(0.0, 2.0, 21), np.linspace(5.0, 60.0, 21)
    plot_error_distribution(axes, {"a": few, "$b^$": many}, STYLES, "cm")
    assert axes.get_xscale() == "log"
    assert axes.get_xlabel() == "cm\n(logarithmic)"
    assert 0 < axes.get_xlim()[0] <= np.quantile(few, 0.05)
    axes.figure.canvas.draw()
    assert {"1", "10"} <= {label.get_text() for label in axes.get_xticklabels()}


@pytest.mark.parametrize(("low", "arrows"), [(0.05, 0), (1e-4, 1), (0.0, 1)])
def test_a_whisker_ends_on_the_axis_or_in_an_arrow(axes, low, arrows):
    few, many = np.append(np.full(3, low), np.linspace(0.5, 2.0, 18)), np.linspace(5.0, 60.0, 21)
    plot_error_distribution(axes, {"a": few, "$b^$": many}, STYLES, "cm")
    found = [line for line in axes.lines if line.get_marker() == "<"]
    assert len(found) == arrows
    assert (axes.get_xlim()[0] < low) == (arrows == 0)
    assert [tuple(line.get_ydata()) for line in found] == [(0,)] * arrows
    axes.figure.canvas.draw()


def test_labels_of_many_decades_do_not_overlap():
    figure = Figure(figsize=(2.2, 2.0))
    axes = figure.add_axes((0.1, 0.3, 0.8, 0.6))
    few, many = np.linspace(0.002, 0.2, 21), np.linspace(5.0, 90.0, 21)
    plot_error_distribution(axes, {"a": few, "$b^$": many}, STYLES, "°")
    figure.canvas.draw()
    left, right = axes.get_window_extent().intervalx
    boxes = [label.get_window_extent() for label in axes.get_xticklabels() if label.get_text()]
    shown = sorted((b.x0, b.x1) for b in boxes if left <= (b.x0 + b.x1) / 2 <= right)
    assert len(shown) >= 2
    assert all(one[1] < other[0] for one, other in pairwise(shown))


def test_boxes_that_are_alike_begin_at_zero(axes):
    plot_error_distribution(axes, {"a": [1.0, 2.0], "$b^$": [2.0, 9.0]}, STYLES, "cm")
    assert axes.get_xscale() == "linear"
    assert axes.get_xlim()[0] == 0
