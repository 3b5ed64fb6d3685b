"""Figures as files."""

import subprocess
import sys
from functools import partial

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.image import imread

from odometry.report.drawing.figure import line_styles, save_figure
from odometry.report.drawing.labels import label_points


def draw(figure):
    figure.add_subplot().plot([0, 1], label="a")


def chunks(png):
    """Names of the chunks of a PNG file."""
    place, names = 8, []
    while place < len(png):
        names.append(png[place + 4 : place + 8])
        place += 12 + int.from_bytes(png[place : place + 4])
    return names


def test_the_same_figure_gives_the_same_bytes_without_date_or_program(tmp_path):
    files = [save_figure(tmp_path / f"{i}.png", (3.0, 2.0), draw) for i in range(2)]
    first, second = (file.read_bytes() for file in files)
    assert first == second
    assert not {b"tEXt", b"iTXt", b"zTXt", b"tIME"} & set(chunks(first))


def test_settings_of_the_user_neither_reach_the_figure_nor_change(tmp_path):
    plain = save_figure(tmp_path / "plain.png", (3.0, 2.0), draw).read_bytes()
    with mpl.rc_context({"lines.linewidth": 9.0, "axes.facecolor": "pink"}):
        before = dict(mpl.rcParams)
        mine = save_figure(tmp_path / "mine.png", (3.0, 2.0), draw).read_bytes()
        assert dict(mpl.rcParams) == before
    assert mine == plain


def test_pyplot_is_not_needed():
    """It would choose a window system and keep every figure."""
    code = (
        "import sys, odometry.report.drawing.figure; sys.exit('matplotlib.pyplot' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_text_beyond_an_edge_makes_the_picture_larger(tmp_path):
    def draw(figure, x=0.5):
        figure.text(x, 0.5, "a long name of a terrain")

    whole, beyond = (
        imread(save_figure(tmp_path / f"{x}.png", (4.0, 1.0), partial(draw, x=x), 100))
        for x in (0.3, 0.9)
    )
    assert whole.shape[:2] == (100, 400)
    assert beyond.shape[0] == 100
    assert beyond.shape[1] > 450
    assert (beyond[:, -1] == 1.0).all()
    assert (beyond[:, 0] == 1.0).all()
    assert np.isclose((whole < 0.9).sum(), (beyond < 0.9).sum(), rtol=0.05)


@pytest.mark.parametrize("x", [-7.0, 900.0])
def test_a_line_beyond_the_axes_has_no_label(tmp_path, x):
    def draw(figure):
        axes = figure.add_axes((0.1, 0.2, 0.6, 0.7))
        axes.set_xlim(0.0, 1.0)
        label_points(axes, {"a": (1.0, 0.5), "b": (x, 0.5)}, line_styles("ab"))

    assert imread(save_figure(tmp_path / "a.png", (4.0, 1.0), draw, 100)).shape[1] == 400
