"""The page of a run: what it says, and that it never fails for want of data."""

import base64
import dataclasses
import struct
from html.parser import HTMLParser

import numpy as np
import pytest

from odometry.estimation.filter_event import FilterEvent
from odometry.evaluation.open_loop_consistency import OpenLoopConsistency
from odometry.evaluation.relative import EvaluationConfig
from odometry.evaluation.score import reference_of
from odometry.run import Run
from odometry.table import Table
from odometry.trajectory import Trajectory
from terrain.config import Config
from terrain.report import page
from terrain.report.lines import ReportLines
from terrain.report.page import write_report
from terrain.report.tables import NOTHING
from terrain.run_odometry import run_odometry

FIGURES = {"path", "position_errors", "error_per_metre", "labels", "confusion", "regions"}
FIGURES |= {"whole_image", "icrs"}
BOUNDS = np.array([0.6, 7.2])
SHORT = Config(evaluation=EvaluationConfig(horizon_m=1.0, stride_m=0.25))


class Reader(HTMLParser):
    """Texts, tables as rows of cells, and images of a page."""

    def __init__(self, file):
        super().__init__()
        self.tags, self.texts, self.tables, self.images = [], [], [], []
        self.feed(file.read_text(encoding="utf-8"))
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in {"td", "th"}:
            self.tables[-1][-1].append("")
        elif tag == "img":
            self.images.append(dict(attrs))

    def handle_data(self, data):
        self.texts.append(data)
        if self.tags and self.tags[-1] in {"td", "th"}:
            self.tables[-1][-1][-1] += data.rstrip("\n")

    @property
    def text(self):
        return " ".join(self.texts)

    def table(self, column):
        """Header and rows of the table that has such a column."""
        (found,) = [table for table in self.tables if column in table[0]]
        return found[0], found[1:]


def with_truth(result, world):
    """The same result with a truth: what the tests laid out, aside by 0.1 m and 2 % askew."""
    t = result.run.odometry.stamps_s
    x = world.speed_m_s * t
    on_boards = (x >= world.edges_m[0]) & (x < world.edges_m[1])
    columns = {"t": t, "x": x, "y": 0.1 + 0.02 * x, "yaw": 0 * t}
    columns["terrain"] = np.where(on_boards, "boards", "gravel").astype(object)
    columns |= {"y_left": 0 * t + 0.2, "y_right": 0 * t - 0.2, "x_icr": 0 * t}
    truth = Table(result.run.folder / "truth.csv", columns, np.arange(len(t)) + 2)
    run = dataclasses.replace(result.run, truth=truth)
    name, reference = reference_of(run)
    return dataclasses.replace(
        result, run=run, config=SHORT, reference_name=name, reference=reference
    )


@pytest.fixture(scope="module")
def seen(across_result, world):
    """With vision and truth."""
    return with_truth(across_result, world)


@pytest.fixture(scope="module")
def blind(across_run, world):
    """The same run with one terrain throughout."""
    return with_truth(run_odometry(across_run, vision=False, terrain="gravel"), world)


@pytest.fixture(scope="module")
def full(seen, blind, tmp_path_factory):
    """Folder of the fullest report, and what was said to be in it."""
    out = tmp_path_factory.mktemp("full")
    return out, write_report(seen, out, {"without <vision>": blind})


@pytest.fixture
def no_photographs(monkeypatch):
    """For tests of what the page says: its slowest two pictures are left out."""
    for name in ("regions_picture", "whole_image_picture"):
        monkeypatch.setattr(page, name, lambda *_: None)


def test_every_figure_and_the_page_are_written(full):
    out, written = full
    assert set(written) == {
        *(out / "figures" / f"{name}.png" for name in FIGURES),
        out / "report.html",
    }
    assert written[-1] == out / "report.html"
    assert sorted(file for file in out.rglob("*") if file.is_file()) == sorted(written)


def test_the_page_holds_the_figures_themselves(full):
    out, written = full
    images = Reader(out / "report.html").images
    held = [base64.b64decode(image["src"].partition(",")[2]) for image in images]
    assert held == [file.read_bytes() for file in written[:-1]]
    assert all(len(image["alt"]) > 20 for image in images)
    for data in held:
        width, height = struct.unpack(">II", data[16:24])
        assert 300 < width < 1200
        assert 150 < height < 1500


def test_the_page_loads_and_runs_nothing(full):
    out, _ = full
    text = (out / "report.html").read_text()
    assert not {"script", "link", "iframe", "object"} & set(Reader(out / "report.html").tags)
    assert "without &lt;vision&gt;" in text
    assert "<vision>" not in text
    assert "://" not in text


def test_the_same_result_gives_the_same_bytes(seen, blind, full, tmp_path):
    out, written = full
    again = write_report(seen, tmp_path, {"without <vision>": blind})
    for first, second in zip(written, again, strict=True):
        assert first.relative_to(out) == second.relative_to(tmp_path)
        assert first.read_bytes() == second.read_bytes()


def test_errors_are_those_of_the_scores(seen, blind, full):
    header, rows = Reader(full[0] / "report.html").table("trajectory")
    lines = ReportLines(seen, {"without <vision>": blind})
    scores = lines.scores()
    assert [row[0] for row in rows] == list(scores)
    assert list(scores) == [
        "differential drive",
        "odometer",
        "estimate",
        "odometer, without <vision>",
    ]
    place = header.index("position, mean [cm/m]")
    for row in rows:
        expected = 100 * scores[row[0]].mean_translation_per_m
        assert float(row[place]) == pytest.approx(expected, abs=0.006)
    assert float(rows[1][place]) == pytest.approx(2.0, abs=0.3)
    aside_m = float(seen.run.truth["y"].mean())
    assert float(rows[1][header.index("off course, mean [m]")]) == pytest.approx(aside_m, abs=0.01)


def test_switches_are_judged_against_the_edges(seen, full, world):
    header, rows = Reader(full[0] / "report.html").table("in force [s]")
    assert header[-3:] == ["truly from [s]", "late by [s]", "late by [m]"]
    assert [row[0] for row in rows] == ["boards", "gravel"]
    for row, edge_m, event in zip(rows, world.edges_m, seen.watcher.events, strict=True):
        cells = dict(zip(header, row, strict=True))
        assert float(cells["in force [s]"]) == pytest.approx(event.stamp_s, abs=0.006)
        true_s = float(cells["truly from [s]"])
        assert true_s == pytest.approx(edge_m / world.speed_m_s, abs=0.11)
        late_s = float(cells["late by [s]"])
        assert late_s == pytest.approx(event.stamp_s - true_s, abs=0.011)
        assert float(cells["late by [m]"]) == pytest.approx(late_s * world.speed_m_s, abs=0.011)


def test_icrs_that_were_learned_are_listed(curvy_run, tmp_path):
    result = run_odometry(curvy_run)
    write_report(result, tmp_path)
    header, ((name, what, *icrs),) = Reader(tmp_path / "report.html").table("y_left [m]")
    assert header[-3:] == ["y_left [m]", "y_right [m]", "x_icr [m]"]
    assert what == "learned"
    values = result.learned.terrains[name].values
    for icr, text in zip(("y_left", "y_right", "x_icr"), icrs, strict=True):
        assert float(text.split(" ± ")[0]) == pytest.approx(values[icr], abs=0.0006)


def test_icrs_of_straight_drives_stand_beside_what_is_true(full):
    _, icrs = Reader(full[0] / "report.html").table("y_left [m]")
    straight = [row for row in icrs if row[1] != "truth, mean"]
    assert [row[0] for row in straight] == ["boards", "gravel"]
    assert {row[1] for row in straight} == {"too few turns or poses to learn"}
    assert [row[2:] for row in icrs if row[1] == "truth, mean"] == [
        ["0.200", "-0.200", "0.000"]
    ] * 2


def test_the_first_sentence_compares(full):
    text = Reader(full[0] / "report.html").text
    assert "Over stretches of 1 m the odometer errs by" in text
    assert "than an ideal differential drive" in text
    assert "than without <vision>" in text


def test_settings_are_listed(full):
    _, rows = Reader(full[0] / "report.html").table("setting")
    settings = dict(rows)
    assert settings["evaluation.horizon_m"] == "1.0"
    assert settings["terrain at the start"] == "gravel"
    assert len(settings) > 15


@pytest.mark.usefixtures("no_photographs")
def test_against_measured_poses_the_estimate_is_judged_by_withheld_ones(across_result, tmp_path):
    result = dataclasses.replace(across_result, config=SHORT)
    write_report(result, tmp_path)
    read = Reader(tmp_path / "report.html")
    _, rows = read.table("trajectory")
    assert [row[0] for row in rows] == ["differential drive", "odometer", "estimate"]
    assert "The filter has seen these poses" in read.text
    assert "The estimate is judged by 4 poses, one every 2 s" in read.text
    assert "The run has no gyroscope" in read.text
    assert "late by [s]" not in read.text
    assert not (tmp_path / "figures" / "confusion.png").exists()


@pytest.mark.usefixtures("no_photographs")
def test_what_the_filter_noticed_is_listed(across_result, tmp_path):
    event = FilterEvent("reinitialised", 3.0, 4.5, "it started anew")
    first, *rest = across_result.replay.estimates
    replay = dataclasses.replace(
        across_result.replay, estimates=(dataclasses.replace(first, events=(event,)), *rest)
    )
    write_report(dataclasses.replace(across_result, replay=replay), tmp_path)
    _, rows = Reader(tmp_path / "report.html").table("what was noticed")
    assert rows == [["reinitialised", "3.00", "4.50", "it started anew"]]


@pytest.mark.usefixtures("no_photographs")
def test_the_uncertainty_of_the_odometer_is_listed(across_result, tmp_path):
    of = dataclasses.replace(
        across_result.uncertainty,
        sigmas={5.0: np.array([0.1, 0.2, np.radians(3)]), 20.0: np.ones(3)},
        checks=(OpenLoopConsistency(5.0, 40, 10, 9.0, np.array([1.7, 4.7])),),
    )
    own = dataclasses.replace(of, own_checks=(OpenLoopConsistency(20.0, 9, 3, 2.0, BOUNDS),))
    write_report(dataclasses.replace(across_result, uncertainty=of), tmp_path)
    read = Reader(tmp_path / "report.html")
    _, rows = read.table("NEES")
    assert rows[0] == ["5", "0.100", "0.200", "3.00", "9.0", "1.7 to 4.7", "too small"]
    why = "not checked: too few poses 20 m apart in a half of the run"
    assert rows[1][4:] == [NOTHING, NOTHING, why]
    assert "Multiply the covariance by 3.0 before you rely on it" in read.text
    assert "Each half of the run is judged by the noise measured on the other half" in read.text
    write_report(dataclasses.replace(across_result, uncertainty=own), tmp_path)
    _, rows = Reader(tmp_path / "report.html").table("NEES")
    assert rows[0][4:] == [NOTHING, "9.0", "1.7 to 4.7", "too small"]
    assert rows[1][4:] == ["2.0", NOTHING, "0.6 to 7.2", "consistent by own poses"]


@pytest.mark.usefixtures("no_photographs")
def test_a_run_shorter_than_the_horizon_says_so(across_result, tmp_path):
    written = write_report(across_result, tmp_path)
    read = Reader(tmp_path / "report.html")
    assert "The run is shorter than the 5 m of wheel travel" in read.text
    assert tmp_path / "figures" / "error_per_metre.png" not in written
    assert tmp_path / "figures" / "position_errors.png" in written
    header, rows = read.table("trajectory")
    assert rows[0][header.index("position, mean [cm/m]")] == NOTHING


def test_a_run_with_nothing_but_odometry_has_a_page(world, tmp_path):
    result = run_odometry(world.drive_curves(tmp_path / "run", pose=False))
    written = write_report(result, tmp_path / "out")
    assert {file.stem for file in written} == {"path", "icrs", "report"}
    text = Reader(tmp_path / "out" / "report.html").text
    assert "nothing is judged" in text
    assert "Nothing told the terrain" in text


def test_images_that_show_no_region_have_a_page(across_result, tmp_path):
    """No label, no switch: the row of images without a label is all there is to see."""
    watcher = across_result.watcher
    blank = [
        dataclasses.replace(s, label="", confidence=np.nan, region=None, reason="too dark")
        for s in watcher.sightings
    ]
    stand_in = type(watcher).__new__(type(watcher))
    stand_in.__dict__.update(watcher.__dict__ | {"sightings": blank, "events": []})
    written = write_report(dataclasses.replace(across_result, watcher=stand_in), tmp_path)
    assert {file.stem for file in written} == {
        "path",
        "position_errors",
        "labels",
        "icrs",
        "report",
    }
    assert "The terrain never changed from gravel" in Reader(tmp_path / "report.html").text


@pytest.mark.parametrize("name", ["<script>alert(1)<script>", "$x^{$", "a & b"])
def test_names_are_names_whatever_they_look_like(world, tmp_path, name):
    folder = world.drive_curves(tmp_path / name)
    result = run_odometry(Run.read(folder), terrain=name)
    write_report(result, tmp_path / "out")
    read = Reader(tmp_path / "out" / "report.html")
    assert "script" not in read.tags
    assert f"{name}: terrain-aware odometry" in read.texts
    _, rows = read.table("y_left [m]")
    assert rows[0][0] == name


@pytest.mark.usefixtures("no_photographs")
def test_a_reference_of_another_time_has_a_page(seen, tmp_path):
    late = Trajectory(seen.reference.stamps_s + 1000, seen.reference.poses)
    written = write_report(dataclasses.replace(seen, reference=late), tmp_path)
    assert tmp_path / "figures" / "position_errors.png" not in written


@pytest.mark.usefixtures("no_photographs")
def test_a_comparison_that_shares_no_time_is_not_judged(seen, curvy_run, tmp_path):
    late = run_odometry(curvy_run)
    moved = dataclasses.replace(
        late,
        replay=dataclasses.replace(
            late.replay,
            estimates=tuple(
                dataclasses.replace(e, stamp_s=e.stamp_s + 1000) for e in late.replay.estimates
            ),
        ),
    )
    write_report(seen, tmp_path, {"another day": moved})
    _, rows = Reader(tmp_path / "report.html").table("trajectory")
    assert rows[-1][0] == "odometer, another day"
    assert set(rows[-1][1:-1]) == {NOTHING}


def test_positions_without_yaw_have_no_box_of_heading_errors(world, tmp_path):
    """The figure is of positions alone, and a note says how they are aligned."""
    folder = world.drive_curves(tmp_path / "run")
    header, *rows = (folder / "pose.csv").read_text().split()
    lines = [header, *(row[: row.rindex(",") + 1] for row in rows)]
    (folder / "pose.csv").write_text("\n".join(lines) + "\n")
    result = dataclasses.replace(run_odometry(folder), config=SHORT)
    written = write_report(result, tmp_path / "out")
    assert tmp_path / "out" / "figures" / "error_per_metre.png" in written
    read = Reader(tmp_path / "out" / "report.html")
    header, rows = read.table("trajectory")
    assert {row[header.index("heading, mean [°/m]")] for row in rows} == {NOTHING}
    assert float(rows[0][header.index("position, mean [cm/m]")]) > 0
    assert "Where the reference has no yaw" in read.text
