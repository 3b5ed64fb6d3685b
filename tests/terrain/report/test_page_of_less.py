"""The page of a run: what it is evaluated on, and that it never fails for want of data."""

import dataclasses

import numpy as np
import pytest

from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.estimation.filter_event import FilterEvent
from odometry.evaluation.open_loop_consistency import OpenLoopConsistency
from odometry.installed import shipped_data
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.report.drawing.before_use import TITLE
from odometry.trajectory import Trajectory
from terrain.main_job import run_odometry
from terrain.report.page import write_report
from terrain.report.tables import NOTHING
from tests.terrain.report.page_reader import SHORT, Reader

BOUNDS = np.array([0.6, 7.2])


@pytest.mark.usefixtures("no_photographs")
def test_against_measured_poses_the_estimate_is_judged_by_withheld_ones(across_result, tmp_path):
    result = dataclasses.replace(across_result, config=SHORT)
    write_report(result, tmp_path)
    read = Reader(tmp_path / "report.html")
    _, rows = read.table("trajectory")
    assert [row[0] for row in rows] == ["differential drive", "odometer", "estimate"]
    assert "The filter has used these poses" in read.text
    assert "The estimate is evaluated with 4 poses, one every 2 s" in read.text
    assert "The run has no gyroscope" in read.text
    assert "late by [s]" not in read.text
    assert not (tmp_path / "figures" / "confusion.png").exists()


@pytest.mark.usefixtures("no_photographs")
def test_what_misleads_stands_before_the_first_number(across_result, tmp_path):
    write_report(across_result, tmp_path)
    assert TITLE not in Reader(tmp_path / "report.html").text
    told = Finding("yaw_in_degrees", Level.WARNING, "yaw spans 340", "It is in degrees", "Turn it")
    kept = Finding("gap_in_odometry", Level.NOTE, "a gap of 2 s", "A pause", "Nothing to do")
    report = CheckReport(tmp_path / "yard", (told, kept))
    known = read_parameters(shipped_data() / "runs" / "demo" / "parameters.toml")
    other = dataclasses.replace(across_result, initial_terrain="mud", parameters=known)
    write_report(other, tmp_path, reports=[report])
    said = Reader(tmp_path / "report.html").text
    assert "yard: yaw spans 340. It is in degrees. Turn it." in said
    assert "a gap of 2 s" not in said
    assert (
        said.index(TITLE) < said.index("has no table in the parameter set") < said.index("Errors")
    )


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
    assert (
        "Each half of the run is evaluated with the noise measured on the other half" in read.text
    )
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
    assert rows[0][header.index("position, mean [m per m]")] == NOTHING


def test_a_run_with_nothing_but_odometry_has_a_page(world, tmp_path):
    result = run_odometry(world.drive_curves(tmp_path / "run", pose=False))
    written = write_report(result, tmp_path / "out")
    assert {file.stem for file in written} == {"path", "icrs", "report"}
    text = Reader(tmp_path / "out" / "report.html").text
    assert "there are no errors" in text
    assert "There was no source of terrain" in text


def test_images_that_show_no_region_have_a_page(across_result, tmp_path):
    """No label, no switch: the row of images without a label is all there is to see."""
    watcher = across_result.watcher
    blank = [
        dataclasses.replace(s, label="", confidence=np.nan, region=None, reason="too dark")
        for s in watcher.image_labels
    ]
    stand_in = type(watcher).__new__(type(watcher))
    stand_in.__dict__.update(watcher.__dict__ | {"image_labels": blank, "events": []})
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
    assert {row[header.index("heading, mean [degrees per m]")] for row in rows} == {NOTHING}
    assert float(rows[0][header.index("position, mean [m per m]")]) > 0
    assert "Where the reference has no yaw" in read.text
