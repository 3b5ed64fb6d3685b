import numpy as np
import pytest
from matplotlib.collections import PolyCollection

from odometry.report.comparison.comparison_plots import plot_violins
from odometry.report.drawing.figure import LineStyle

STYLES = {"a": LineStyle("#0000FF"), "$b^$": LineStyle("#FF0000"), "few": LineStyle("#00FF00")}


def test_boxes_are_quartiles_and_lines_medians(axes, rng):
    values = rng.lognormal(0, 1, 101)
    plot_violins(axes, {"a": values, "none": values[:0], "$b^$": 3 * values}, STYLES, "m per m")
    for patch, factor in zip(axes.patches, (1, 3), strict=True):
        left, right = patch.get_x(), patch.get_x() + patch.get_width()
        low, high = factor * np.percentile(values, [25, 75])
        assert (left, right) == pytest.approx((low, high))
    medians = [line.get_xdata()[0] for line in axes.lines]
    assert medians == pytest.approx([np.median(values), 3 * np.median(values)])
    assert [label.get_text() for label in axes.get_yticklabels()] == ["a", "$b^$"]
    assert axes.get_xlabel() == "m per m"
    axes.figure.canvas.draw()


def test_the_curve_is_widest_where_most_errors_are(axes, rng):
    values = 10 ** rng.normal(-1, 0.1, 500)
    plot_violins(axes, {"a": values}, STYLES, "m")
    (curve,) = [c for c in axes.collections if isinstance(c, PolyCollection)]
    x, y = curve.get_paths()[0].vertices.T
    assert np.log10(x[np.argmax(y)]) == pytest.approx(-1, abs=0.05)
    assert x.min() == pytest.approx(values.min())
    assert x.max() == pytest.approx(values.max())


def test_zeros_few_and_equal_values_can_be_drawn(axes):
    errors = {"a": np.array([0.0, 1, 1, 1, 1, 1]), "few": np.array([0.5, 0.7]), "$b^$": np.ones(9)}
    plot_violins(axes, errors, STYLES, "m")
    axes.figure.canvas.draw()
    assert axes.get_xlim()[0] > 0
    plot_violins(axes, {"a": np.zeros(7)}, STYLES, "m")
    axes.figure.canvas.draw()
