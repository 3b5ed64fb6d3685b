"""The page of a comparison: every figure is drawn, every number is that of the comparison."""

import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

from odometry.comparison.compare import compare
from odometry.comparison.config import ComparisonConfig
from odometry.identification.start import SolverConfig
from odometry.io.run_folder import write_run_folder
from odometry.recording.run import Run
from odometry.report.comparison.comparison_page import lead, write_comparison_report
from odometry.report.comparison.comparison_tables import parameter_grid

MODELS = ("differential_drive", "icr_symmetric", "icr_slope")
CONFIG = ComparisonConfig(solver=SolverConfig(starts=1), draws=100)


def make(folder, seed, terrain):
    """A run of an ideal robot 0.8 m wide; poses by a loop of straight steps."""
    rng = np.random.default_rng(seed)
    speeds = np.repeat(rng.uniform(-0.5, 1.2, (20, 2)), 30, axis=0)
    t = 0.05 * np.arange(len(speeds))
    poses = [np.zeros(3)]
    for left, right in speeds[:-1]:
        x, y, yaw = poses[-1]
        forward, turn = (left + right) / 2 * 0.05, (right - left) / 0.8 * 0.05
        heading = yaw + turn / 2
        poses.append(
            np.array([x + np.cos(heading) * forward, y + np.sin(heading) * forward, yaw + turn])
        )
    x, y, yaw = (np.array(poses) + rng.normal(0, 0.003, (len(poses), 3))).T
    odometry = {"t": t, "v_left": speeds[:, 0], "v_right": speeds[:, 1]}
    settings = {"robot": {"name": "R <b>", "track_width": 0.5}, "run": {"terrain": terrain}}
    write_run_folder(
        folder, settings, {"odometry": odometry, "pose": {"t": t, "x": x, "y": y, "yaw": yaw}}
    )
    return Run.read(folder)


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    names = ("mud & <ice>", "mud & <ice>", "sand $^")
    runs = [make(folder / f"run_{i}", i, name) for i, name in enumerate(names)]
    return compare(runs, MODELS, config=CONFIG)


class Page(HTMLParser):
    """Tags, and the text of all cells."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.cells = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.cells.append(data)


@pytest.fixture(scope="module")
def written(compared, tmp_path_factory):
    out = tmp_path_factory.mktemp("out")
    return out, write_comparison_report(compared, out)


@pytest.mark.slow
def test_every_figure_is_there(written):
    out, files = written
    names = {file.relative_to(out).as_posix() for file in files}
    grounds = ("R_b_mud_ice", "R_b_sand")
    kinds = ("errors", "speed_plane", "horizons")
    expected = {f"figures/{kind}_{ground}.png" for kind in kinds for ground in grounds}
    assert names == expected | {"figures/rotation_R_b.png", "report.html"}
    assert all(file.read_bytes()[:4] == b"\x89PNG" for file in files[:-1])


def test_the_page_loads_nothing_and_shows_every_figure(written):
    out, files = written
    page = Page((out / "report.html").read_text(encoding="utf-8"))
    pictures = [attributes["src"] for tag, attributes in page.tags if tag == "img"]
    assert len(pictures) == len(files) - 1
    assert all(source.startswith("data:image/png;base64,") for source in pictures)
    assert not {"script", "link", "b"} & {tag for tag, _ in page.tags}


def test_the_numbers_on_the_page_are_those_of_the_comparison(written, compared):
    cells = Page((written[0] / "report.html").read_text(encoding="utf-8")).cells
    for place in compared.places:
        for sentence in compared.sentences_at(place):
            assert sentence in cells
        for summary in compared.summaries_at(place):
            if summary.windows:
                assert f"{summary.means['translation']:.4f}" in cells
                assert f"{summary.means['rotation']:.3f}" in cells
        for difference in compared.differences_at(place):
            assert any(cell.startswith(difference.words()) for cell in cells)
    for fitness in compared.fitness:
        assert f"{fitness.fitness.mean:.3f}" in cells
    assert any("0 windows are tilted" in cell for cell in cells)


def test_parameters_have_the_digits_that_their_deviations_allow(compared):
    pairs = re.findall(r"(-?[\d.]+) ± ([\d.]+)", str(parameter_grid(compared).rows))
    assert len(pairs) >= 4  # of `icr_symmetric` on two terrains
    for value, sigma in pairs:
        assert len(value.partition(".")[2]) == len(sigma.partition(".")[2])
        assert len(sigma.replace(".", "").lstrip("0")) == 2


def test_the_lead_counts_where_the_error_of_a_model_is_smallest(compared):
    assert lead(compared).startswith(
        "The mean translation error is smallest with icr_symmetric in 2 of 2 comparisons"
    )
    place = compared.places[0]
    alone = replace(
        compared,
        split_models=tuple(p for p in compared.split_models if p.split.terrain == place.terrain),
    )
    assert lead(alone) == alone.sentences_at(place)[0]


def test_the_lead_says_where_the_best_model_cannot_be_distinguished(compared):
    place = compared.places[0]
    assert "cannot be distinguished" not in lead(compared)
    widened = tuple(
        replace(each, interval=replace(each.interval, low=-1.0, high=1.0))
        if each.place == place
        else each
        for each in compared.differences
    )
    alike = replace(compared, differences=widened)
    assert "In 1 of them another model cannot be distinguished" in lead(alike)


def test_the_lead_names_no_model_that_was_not_identified(compared, monkeypatch):
    """`icr_symmetric`, the best, held at assumed values on one terrain."""
    summaries_at = type(compared).summaries_at

    def assumed(self, place):
        reasons = ("alpha is open",) if place == compared.places[0] else ()
        return tuple(
            replace(summary, not_identified=reasons if summary.model == "icr_symmetric" else ())
            for summary in summaries_at(self, place)
        )

    monkeypatch.setattr(type(compared), "summaries_at", assumed)
    words = lead(compared)
    assert "differential_drive in 1" in words
    assert "icr_symmetric in 1 of 2 comparisons" in words


def test_the_lead_says_what_contradicts_it(compared):
    """The ideal drive, which loses over windows, made to win on whole runs."""
    place = compared.places[0]
    fitness = tuple(
        replace(each, fitness=replace(each.fitness, x_m2=0.0 if "drive" in each.model else 900.0))
        for each in compared.fitness
    )
    alone = replace(
        compared,
        split_models=tuple(p for p in compared.split_models if p.split.terrain == place.terrain),
        fitness=fitness,
    )
    assert "icr_symmetric (J/N 900) has a larger error than differential_drive (" in lead(alone)
    both = replace(compared, fitness=fitness)
    assert "In 2 of them medians or whole runs give another order" in lead(both)


def test_figures_of_an_earlier_comparison_go_and_other_files_stay(compared, tmp_path):
    folder = tmp_path / "figures"
    folder.mkdir()
    for name in ("errors_old.png", "mine.png"):
        (folder / name).write_bytes(b"")
    only = [p for p in compared.split_models if p.split.terrain != "sand $^"]
    write_comparison_report(replace(compared, split_models=tuple(only)), tmp_path)
    names = {file.name for file in folder.iterdir()}
    assert "mine.png" in names
    assert "errors_old.png" not in names


def test_without_a_window_the_page_says_why(compared, tmp_path):
    config = replace(compared.config, horizons_m=(900.0,))
    reason = {"/runs/other": "other: no pose.csv"}
    bare = replace(
        compared, evaluations=(), differences=(), fitness=(), config=config, left_out=reason
    )
    files = write_comparison_report(bare, tmp_path)
    assert [file.name for file in files] == ["report.html"]
    text = files[0].read_text()
    assert "Left out: other: no pose.csv." in text
