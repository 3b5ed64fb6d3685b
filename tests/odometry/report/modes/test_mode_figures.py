"""Figures of modes: what is drawn where; few modes as lines, many as rows."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from odometry.modes.follow.camera_prior import SeenTerrain
from odometry.modes.follow.followed import Followed, followed
from odometry.modes.follow.track import ModesConfig
from odometry.report.drawing.figure import LINE_STYLES, mode_colours
from odometry.report.modes import mode_figures, mode_panels, modes_page
from odometry.report.modes.mode_figures import modes_picture, path_picture
from odometry.report.modes.mode_panels import (
    draw_probabilities,
    draw_state,
    draw_strips,
    drawn_rows,
    mark_mode_changes,
)
from odometry.report.modes.modes_page import MOST, innovations_picture, write_modes_report
from tests.odometry.modes.mode_examples import run_of, track, traction_set, velocity_set

MANY = tuple(f"_$wheel^${i}" for i in range(16))
COLOURS = mode_colours(("a", "b", "c"))


def test_sixteen_modes_have_sixteen_colours_and_lines_keep_theirs():
    colours = mode_colours(MANY)
    assert len(set(colours.values())) == 16
    assert [colours[name] for name in MANY[:10]] == [style.colour for style in LINE_STYLES]


def test_a_strip_is_a_stretch_in_the_colour_of_its_mode(axes):
    labels = np.array(["unknown", "a", "a", "b", "undetermined"], dtype=object)
    draw_strips(axes, np.arange(5.0), {"true": labels}, COLOURS)
    first, second, open_ = axes.patches
    assert (first.get_x(), first.get_width()) == (1.0, 2.0)
    assert first.get_facecolor()[:3] == pytest.approx(to_rgb(COLOURS["a"]))
    assert (second.get_x(), second.get_width()) == (3.0, 1.0)
    assert second.get_facecolor()[:3] == pytest.approx(to_rgb(COLOURS["b"]))
    assert open_.get_hatch()
    assert [tick.get_text() for tick in axes.get_yticklabels()] == ["true"]


def test_few_modes_are_lines(axes):
    known = track(["a", "", "b"], ["a"] * 3)
    draw_probabilities(axes, known, 0.9, COLOURS)
    lines = axes.lines[:3]
    for line, column, name in zip(lines, known.probabilities.T, "abc", strict=True):
        assert line.get_ydata() == pytest.approx(column)
        assert line.get_color() == COLOURS[name]
    assert axes.lines[3].get_ydata()[0] == 0.9


def test_many_modes_are_rows_and_the_true_one_is_framed(axes):
    known = track([MANY[3], MANY[3], ""], [MANY[3], MANY[3], "unknown"], names=MANY)
    draw_probabilities(axes, known, 0.9, mode_colours(MANY))
    (mesh,) = axes.collections
    np.testing.assert_array_equal(np.reshape(mesh.get_array(), (16, 3)), known.probabilities.T)
    (frame,) = [patch for patch in axes.patches if not patch.get_fill()]
    assert (frame.get_x(), frame.get_width(), frame.get_y()) == (0.0, 1.0, 2.5)
    assert [tick.get_text() for tick in axes.get_yticklabels()] == list(MANY)
    axes.figure.canvas.draw()


def test_changes_are_dashed_lines(axes):
    labels = np.array(["a", "a", "b", "c"], dtype=object)
    mark_mode_changes([axes], np.arange(4.0), labels)
    assert [line.get_xdata()[0] for line in axes.lines] == [2.0, 3.0]


def test_the_first_broad_band_does_not_set_the_limits(axes):
    mean, sigma = np.array([0.0, 1.0, 2.0]), np.array([50.0, 0.1, 0.1])
    draw_state(axes, np.arange(3.0), (mean, sigma), np.array([np.nan, 1.1, 2.5]))
    assert axes.get_ylim() == pytest.approx((-0.25, 2.75))
    (dots, line) = axes.lines
    assert dots.get_ydata().tolist() == [1.1, 2.5]
    assert line.get_ydata().tolist() == mean.tolist()


def test_what_was_never_measured_has_no_dots(axes):
    mean = np.zeros(3)
    draw_state(axes, np.arange(3.0), (mean, mean + 1), np.full(3, np.nan), wheels=mean + 0.1)
    assert len(axes.lines[0].get_ydata()) == 0
    assert axes.get_ylim() == pytest.approx((-0.02, 0.12))
    axes.figure.canvas.draw()


def test_long_runs_are_drawn_in_part_with_both_ends(monkeypatch):
    monkeypatch.setattr(mode_panels, "MOST_DRAWN", 10)
    rows = drawn_rows(1000)
    assert len(rows) == 10
    assert rows[[0, -1]].tolist() == [0, 999]
    assert drawn_rows(3).tolist() == [0, 1, 2]


@pytest.fixture(scope="module")
def grounds():
    """Ice, then tar, with a camera that labels wrongly."""
    turns, labels = np.repeat([1.0, 2.0], 200), ["ice"] * 200 + ["tar"] * 200
    sight = (SeenTerrain(0.0, "tar", 0.8),)
    return followed(run_of(turns, labels=labels), velocity_set(), seen=sight)


@pytest.fixture(scope="module")
def wheels():
    run = run_of(0.5, track_width=0.5, labels=["none"] * 400)
    return followed(run, traction_set())


def test_a_page_of_velocity_modes(grounds, tmp_path):
    written = write_modes_report(grounds, tmp_path)
    names = sorted(file.relative_to(tmp_path).as_posix() for file in written)
    assert names == ["figures/innovations.png", "figures/modes.png", "report.html"]
    page = (tmp_path / "report.html").read_text()
    short = [page.index(f"<li>{title}: ") for title in ("Answer", "How sure", "What to do")]
    assert short == sorted(short)
    assert short[-1] < page.index("<img")
    assert "Where the answer is none of these" not in page
    assert "With the camera: " in page
    assert "By motion alone." in page
    assert "By motion and camera." in page


def test_where_no_mode_fits_the_page_says_so(tmp_path):
    labels = ["ice"] * 400
    leaving = followed(run_of(np.repeat([1.0, 4.0], 200), labels=labels), velocity_set())
    write_modes_report(leaving, tmp_path)
    page = (tmp_path / "report.html").read_text()
    (one,) = leaving.misfits
    row = f'<th scope="row">yaw rate</th><td>{one.from_s:.1f}</td><td>{one.to_s:.1f}</td>'
    assert row in page


def test_innovations_are_drawn_with_their_bounds(grounds, drawn, tmp_path):
    """Of what was measured: the yaw rate, not the speed."""
    innovations_picture(grounds, tmp_path)
    (axes,) = drawn["innovations.png"].axes
    (line,) = axes.lines
    shown = np.clip(grounds.motion.fit.best[:, 1], -MOST, MOST)
    np.testing.assert_array_equal(line.get_ydata(), shown)
    band = axes.patches[0].get_extents().transformed(axes.transData.inverted())
    assert (band.y0, band.y1) == pytest.approx((-2.0, 2.0))


def test_a_page_of_traction_modes_has_a_path_that_goes_again(grounds, wheels, tmp_path):
    written = write_modes_report(wheels, tmp_path)
    path = tmp_path / "figures" / "path.png"
    assert path in written
    assert path_picture(grounds, tmp_path) is None
    write_modes_report(grounds, tmp_path)
    assert not path.exists()


def test_the_same_modes_give_the_same_bytes(wheels, tmp_path):
    first = [file.read_bytes() for file in write_modes_report(wheels, tmp_path / "a")]
    assert first == [file.read_bytes() for file in write_modes_report(wheels, tmp_path / "b")]


@pytest.mark.parametrize("count", [2, 16])
def test_any_names_can_be_drawn_without_labels_or_measured_poses(count, tmp_path):
    """Names like formulas, nothing true, no pose but the first."""
    names = MANY[:count]
    mode_set = traction_set(tuple(np.linspace(0.3, 0.9, count)), names)
    known = track([MANY[1], "", ""], ["unknown"] * 3, names=names)
    blank = np.column_stack([np.arange(3.0), np.zeros((3, 3))])
    known = replace(known, means=blank, sigmas=blank)
    run = run_of(0.5, size=3)
    signals = mode_set.modes.signals(run)
    many = Followed(run, mode_set, ModesConfig(), signals, known)
    for picture in (modes_picture(many, tmp_path), path_picture(many, tmp_path)):
        assert picture.file.read_bytes().startswith(b"\x89PNG")


@pytest.fixture
def drawn(monkeypatch):
    """Figures that were drawn, by the names of their files."""
    figures = {}

    def keep(file, size_in, draw):
        figure = Figure(figsize=size_in)
        FigureCanvasAgg(figure)
        draw(figure)
        figures[file.name] = figure
        return file

    for module in (mode_figures, modes_page):
        monkeypatch.setattr(module, "save_figure", keep)
    return figures


def test_the_legend_names_few_modes_and_what_is_open(grounds, drawn, tmp_path):
    mode_figures.modes_picture(grounds, tmp_path)
    figure = drawn["modes.png"]
    (legend,) = figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert words == ["ice", "tar", "none of these", "undetermined"]
    strips, motion, _, speed, rate = figure.axes
    names = [tick.get_text() for tick in strips.get_yticklabels()]
    assert names == ["true", "camera", "answer", "with camera"]
    assert motion.get_title(loc="left") == "motion alone"
    assert (speed.get_ylabel(), rate.get_ylabel()) == ("V [m/s]", "omega [rad/s]")
    assert motion.get_xlim() == (0.0, grounds.motion.stamps_s[-1])


def test_the_path_is_in_the_colour_of_the_answer(wheels, drawn, tmp_path):
    mode_figures.path_picture(wheels, tmp_path)
    (axes,) = drawn["path.png"].axes
    (path,) = axes.collections
    answers = wheels.answers(wheels.motion)[1:]
    colour = to_rgb(mode_colours(wheels.mode_set.names)["none"])
    of_none = [tuple(one[:3]) == pytest.approx(colour) for one in path.get_colors()]
    assert of_none == (answers == "none").tolist()
    assert any(of_none)
