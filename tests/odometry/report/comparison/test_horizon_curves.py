import numpy as np

from odometry.report.comparison.comparison_plots import plot_against_horizon
from odometry.report.drawing.figure import LineStyle

STYLES = {"a": LineStyle("#0000FF"), "$b^$": LineStyle("#FF0000", "dashed")}


def test_lines_go_through_the_values_and_every_horizon_is_named(axes):
    horizons = np.array([0.5, 2.0, 10.0])
    curves = {"a": (horizons, np.array([0.1, 0.05, 0.02])), "$b^$": (horizons[:2], np.ones(2))}
    plot_against_horizon(axes, curves, STYLES)
    axes.figure.canvas.draw()
    for name, (x, y) in curves.items():
        (line,) = [line for line in axes.lines if line.get_label() == name]
        np.testing.assert_allclose(line.get_xydata().T, [x, y])
    assert [label.get_text() for label in axes.get_xticklabels()] == ["0.5", "2", "10"]


def test_errors_that_are_none_or_unknown_are_drawn_without_a_warning(axes):
    horizons = np.array([0.5, 2.0])
    curves = {"a": (horizons, np.full(2, np.nan)), "$b^$": (horizons, np.zeros(2))}
    plot_against_horizon(axes, curves, STYLES)
    axes.figure.canvas.draw()
    assert axes.get_yscale() == "linear"
