"""The figure of probabilities."""

import cv2
import numpy as np
import pytest
from matplotlib.figure import Figure

from terrain.classification.neighbours.calibration import reliability, reliability_by_chance
from terrain.classification.neighbours.validation import CrossValidation
from terrain.report.reliability_figure import plot_reliability, write_reliability_figure

VOTES = np.array([[0.95, 0.05]] * 40 + [[0.35, 0.65]] * 20)
CODES = np.repeat([0, 1, 1, 0], [30, 10, 10, 10])


def test_points_are_shares_and_bars_are_chance():
    axes = Figure().add_axes((0, 0, 1, 1))
    chance = reliability_by_chance(VOTES, np.arange(60))
    plot_reliability(axes, reliability(CODES, VOTES), chance)
    (points,) = [line for line in axes.lines if line.get_marker() == "o"]
    assert points.get_xydata() == pytest.approx(np.array([[0.65, 0.5], [0.95, 0.75]]))
    bars = [(bar.get_y(), bar.get_y() + bar.get_height()) for bar in axes.patches]
    expected = [(chance.lowest[i], chance.highest[i]) for i in (6, 9)]
    assert np.array(bars) == pytest.approx(np.array(expected))
    assert bars[0][0] < 0.65 < bars[0][1]


def test_the_same_input_gives_the_same_file(tmp_path):
    found = CrossValidation(1, np.arange(60), CODES, VOTES, np.zeros(60))
    first, second = (
        write_reliability_figure(tmp_path / name, found, np.arange(60))
        for name in ("a.png", "b.png")
    )
    assert first.read_bytes() == second.read_bytes()
    assert cv2.imread(str(first)).std() > 10
