"""The page of a run: what it says."""

import base64
import struct

import pytest

from terrain.main_job import run_odometry
from terrain.report.lines import ReportLines
from terrain.report.page import write_report
from tests.terrain.report.page_reader import Reader

FIGURES = {"path", "position_errors", "error_per_metre", "labels", "confusion", "regions"}
FIGURES |= {"whole_image", "icrs"}


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


@pytest.mark.slow
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
    place = header.index("position, mean [m per m]")
    turned = header.index("heading, mean [degrees per m]")
    for row in rows:
        said = scores[row[0]].to_table()  # the numbers and units of result.json
        assert row[place] == f"{said['translation_m_per_m']['mean']:.4f}"
        assert row[turned] == f"{said['rotation_deg_per_m']['mean']:.4f}"
    assert float(rows[1][place]) == pytest.approx(0.02, abs=0.003)
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
    assert "Over stretches of 1 m the error of the odometer is" in text
    assert "than an ideal differential drive" in text
    assert "than without <vision>" in text


def test_settings_are_listed(full):
    _, rows = Reader(full[0] / "report.html").table("setting")
    settings = dict(rows)
    assert settings["evaluation.horizon_m"] == "1.0"
    assert settings["terrain at the start"] == "gravel"
    assert len(settings) > 15
