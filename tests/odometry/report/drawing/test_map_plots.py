"""Paths over terrain."""

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex

from odometry.evaluation.stretches import Stretch
from odometry.report.drawing.figure import LineStyle
from odometry.report.drawing.map_plots import plot_ground, plot_paths
from odometry.trajectory import Trajectory

STYLES = {"a": LineStyle("#0000FF"), "$b^$": LineStyle("#FF0000", "dashed")}
S = np.linspace(0.0, 10.0, 101)
ARC = Trajectory(S, np.column_stack([4 * np.sin(S / 4), 4 - 4 * np.cos(S / 4), S / 4]))
LINE = Trajectory(S, np.column_stack([S, 0 * S, 0 * S]))


def test_paths_are_the_trajectories_at_equal_scale(axes):
    plot_paths(axes, {"a": ARC, "$b^$": LINE}, STYLES)
    drawn = {line.get_label(): line.get_xydata() for line in axes.lines}
    assert drawn["a"] == pytest.approx(ARC.poses[:, :2])
    assert drawn["$b^$"] == pytest.approx(LINE.poses[:, :2])
    axes.figure.canvas.draw()
    corners = axes.transData.transform([[0, 0], [1, 0], [0, 1]])
    across, up = corners[1, 0] - corners[0, 0], corners[2, 1] - corners[0, 1]
    assert across == pytest.approx(up)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x [m]", "y [m]")
    assert {"a", "$b^$", "start"} <= {text.get_text() for text in axes.texts}


def test_ground_lies_along_the_path_where_it_was(axes):
    plot_paths(axes, {"$b^$": LINE}, STYLES)
    stretches = (Stretch("ice", 0, 4), Stretch("snow", 4, 7), Stretch("ice", 7, 10))
    plot_ground(axes, LINE, stretches, {"ice": "#112233", "snow": "#445566"})
    bands = [c for c in axes.collections if isinstance(c, LineCollection)]
    ends = [(c.get_segments()[0][0, 0], c.get_segments()[0][-1, 0]) for c in bands]
    assert ends == [(0, 4), (4, 7), (7, 10)]
    assert [to_hex(c.get_color()[0]) for c in bands] == ["#112233", "#445566", "#112233"]
    names = [text.get_text() for text in axes.texts if text.get_text() in {"ice", "snow"}]
    assert sorted(names) == ["ice", "snow"]  # once each


def test_a_name_stands_on_the_emptier_side(axes):
    below = Trajectory(S, LINE.poses - [0, 0.6, 0])
    plot_paths(axes, {"a": LINE, "$b^$": below}, STYLES)
    plot_ground(axes, LINE, (Stretch("ice", 0, 10),), {"ice": "#112233"})
    plot_ground(axes, below, (Stretch("snow", 0, 10),), {"snow": "#112233"})
    sides = {t.get_text(): t.get_position()[1] for t in axes.texts}
    assert sides["ice"] > 0 > sides["snow"]


def test_a_stretch_outside_of_the_path_is_not_drawn(axes):
    plot_paths(axes, {"a": LINE}, STYLES)
    plot_ground(axes, LINE, (Stretch("ice", 20, 30),), {"ice": "#112233"})
    assert not axes.collections


def test_no_terrain_is_drawn_over_an_outage(axes):
    outage = (S > 2) & (S < 6)
    path = Trajectory(S[~outage], LINE.poses[~outage])
    plot_paths(axes, {"a": path}, STYLES)
    plot_ground(axes, path, (Stretch("ice", 0, 10),), {"ice": "#112233"})
    axes.figure.canvas.draw()
    pixels = np.asarray(axes.figure.canvas.buffer_rgba())[:, :, :3]
    for x, drawn in ((1.3, True), (4.3, False), (8.3, True)):
        column, row = axes.transData.transform((x, 0.0))
        aside = pixels[int(pixels.shape[0] - row) + 4, int(column)]
        assert (to_hex(aside / 255) == "#112233") == drawn
    assert np.isfinite(axes.texts[-1].xy).all()
