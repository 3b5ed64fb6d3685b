"""Figures as files."""

import subprocess
import sys

import matplotlib as mpl

from odometry.report.figure import save_figure


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
    code = "import sys, odometry.report.figure; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
