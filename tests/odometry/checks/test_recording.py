import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.checks.findings.catalogue import CATALOGUE
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from odometry.tables.table import Table
from tests.odometry.checks.faulty import FAULTS, gyroscope, put, treads

RECORDING = "warthog_grass_20240729_1404"
ROOT = Path(__file__).parents[3]
SIDES = ("tread_left_reversed", "tread_right_reversed")  # made from the name of the side
CLEAN = (
    *("warthog_grass_20240729_1404", "warthog_grass_20240729_1446", "warthog_grass_20240808_1556"),
    *("husky_tile_20231212_1616_s00", "marmotte_boreal_20240125_1215_s00"),
    *("marmotte_boreal_20240125_1215_s02", "marmotte_boreal_20240125_1215_s04"),
)


@pytest.fixture(scope="module")
def recording(shared_data):
    read = {}

    def of(name):
        if name not in read:
            read[name] = Run.read(shared_data / "motion" / name)
        return read[name]

    return of


@pytest.mark.parametrize("name", CLEAN)
def test_a_clean_recording_has_no_warning(recording, name):
    report = check_recording(recording(name))
    assert not report.misleads, [finding.line for finding in report.findings]


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_named_first(recording, fault):
    report = check_recording(FAULTS[fault](recording(RECORDING)))
    assert report.misleads
    assert report.findings[0].name == fault, [finding.line for finding in report.findings]


def test_every_finding_has_a_row_in_the_catalogue():
    """Names are the literals that stand alone on a line where a Finding is made."""
    assert set(FAULTS) <= set(CATALOGUE)
    files = [file for file in (ROOT / "odometry/checks").rglob("*.py") if file.stem != "catalogue"]
    code = "\n".join(file.read_text(encoding="utf-8") for file in files)
    assert [name for name in CATALOGUE if f'"{name}"' not in code and name not in SIDES] == []
    made = re.findall(r'(?:Finding|_finding|_refused|_imu)\(\s*"([a-z_]+)"', code)
    assert set(made) - set(CATALOGUE) == set()
    assert len(made) > 50


def test_a_gyroscope_bias_is_a_note(recording):
    run = gyroscope(recording("husky_tile_20231212_1616_s00"), lambda rate: rate + 0.03)
    report = check_recording(run)
    (bias,) = (finding for finding in report.findings if finding.name == "gyroscope_bias")
    assert (bias.level, report.misleads) == (Level.NOTE, False)
    assert "+0.014" in bias.seen  # -0.0157 rad/s are in the recording


def test_no_bias_is_named_by_a_rest_in_which_the_poses_turn(recording):
    """Treads with a dead band read zero while the robot turns slowly."""
    run = recording("husky_tile_20231212_1616_s00")
    table = run.odometry
    least_m_s = 0.15 * np.quantile(np.abs(table.stack("v_left", "v_right")), 0.9)
    dead = {n: np.where(np.abs(table[n]) > least_m_s, table[n], 0) for n in ("v_left", "v_right")}
    report = check_recording(put(run, "odometry", **dead))
    assert "gyroscope_bias" not in {finding.name for finding in report.findings}
    assert "read zero while the robot turns" in report.findings[0].seen


def test_a_tread_that_stands_beside_a_stuck_one_is_not_accused(recording):
    run = recording("warthog_grass_20240729_1404")
    left = run.odometry["v_left"].copy()
    left[700:1000] = left[700]
    found = check_recording(put(run, "odometry", v_left=left)).findings
    assert [finding.seen[:6] for finding in found if finding.name == "stuck_encoder"] == ["v_left"]


def test_a_delay_is_measured_with_its_uncertainty(recording):
    run = recording("husky_tile_20231212_1616_s00")
    before, after = (
        check_recording(put(run, "pose", t=run.pose["t"] + shift)) for shift in (0.3, 0.5)
    )
    found = [report.findings[0].seen for report in (before, after)]
    lags = [float(words.split(" is ")[1].split(" +- ")[0]) for words in found]
    assert lags[1] - lags[0] == pytest.approx(0.2, abs=0.01)


def test_without_poses_what_cannot_be_checked_is_listed(recording):
    run = replace(recording(RECORDING), pose=None)
    report = check_recording(treads(run, lambda left, right: (right, left)))
    assert report.findings[0].name == "treads_or_gyroscope_reversed"
    assert "cannot be distinguished" in report.findings[0].cause
    assert "mounted upside down" in report.findings[0].remedy
    assert any("no measured poses" in reason for reason in report.skipped)


def test_a_log_of_changes_is_clean(recording):
    run = recording(RECORDING)
    speeds = run.odometry.stack("v_left", "v_right")
    kept = np.append(True, (np.diff(speeds, axis=0) != 0).any(axis=1))
    columns = {name: column[kept] for name, column in run.odometry.columns.items()}
    table = replace(run.odometry, columns=columns, lines=run.odometry.lines[kept])
    assert kept.mean() < 0.9
    assert not check_recording(replace(run, odometry=table)).misleads


def test_a_row_that_is_written_twice_is_a_note(recording, tmp_path):
    folder = recording(RECORDING).folder
    for file in ("run.toml", "odometry.csv", "pose.csv"):
        (tmp_path / file).write_text((folder / file).read_text())
    lines = (tmp_path / "odometry.csv").read_text().splitlines()
    lines.insert(101, lines[100])
    (tmp_path / "odometry.csv").write_text("\n".join(lines) + "\n")
    report = check_recording(tmp_path)
    (repeated,) = report.findings
    assert (repeated.name, repeated.level) == ("repeated_rows", Level.NOTE)
    assert "repeats the stamp and the values of the row before in 1 row" in repeated.seen
    assert "row 102" in repeated.seen


@pytest.mark.parametrize(
    ("file", "text", "words"),
    [
        ("odometry.csv", "t;v_left;v_right\n0;1;1\n1;1;1\n", "semicolons"),
        ("odometry.csv", "0.1,1.5,1.5\n0.2,1.5,1.5\n", "header"),
        ("odometry.csv", "time,left,right\n0,1,1\n1,1,1\n", "other names"),
        ("odometry.csv", "t,v_left,v_right\n0,1,1\n2,1,1\n1,1,1\n", "order of time"),
        ("odometry.csv", "t,v_left,v_right\n0,1,1\n1,,1\n", "empty"),
        ("odometry.csv", "t,v_left,v_right\n2024-01-01T10:00:00,1,1\n", "dates"),
        ("run.toml", "[robot]\ntrack_width = -1\n", "negative"),
    ],
)
def test_a_folder_that_cannot_be_read_is_refused_with_its_cause(make_run, file, text, words):
    folder = make_run()
    (folder / file).write_text(text)
    (finding,) = check_recording(folder).findings
    assert finding.level is Level.REFUSED
    assert words in finding.cause


def test_a_short_recording_is_not_judged(make_run):
    report = check_recording(make_run())
    assert report.findings == ()
    assert report.skipped


@pytest.mark.parametrize(
    ("sensors", "words"),
    [
        ({}, "run.toml has no [sensors] imu: a sensor mounted upside down needs"),
        ({"sensors": {"imu": [0.0, 0.0, 0.1]}}, "check [sensors] imu of run.toml first"),
    ],
)
def test_a_gyroscope_that_turns_against_the_treads_asks_for_its_attitude(recording, sensors, words):
    run = replace(recording(RECORDING), pose=None)
    rates = run.yaw_rate
    columns = {"t": rates.stamps_s, "gyro_x": 0 * rates.stamps_s, "gyro_y": 0 * rates.stamps_s}
    columns["gyro_z"] = rates.yaw_rate_rad_s
    imu = Table(run.folder / "imu.csv", columns, np.arange(len(rates.stamps_s)) + 2)
    run = replace(run, imu=imu, settings=dict(run.settings) | sensors)
    found = check_recording(treads(run, lambda left, right: (right, left))).findings[0]
    assert found.name == "treads_or_gyroscope_reversed"
    assert words in found.remedy


def test_stamps_of_few_digits_are_refused_with_their_cause(make_run):
    rows = [
        f"{np.float32(1.7e9 + 0.05 * row):.3f},0.5,{0.5 + 0.001 * row:.3f}" for row in range(600)
    ]
    report = check_recording(make_run(odometry="\n".join(["t,v_left,v_right", *rows, ""])))
    (found,) = report.findings
    assert (found.name, found.level) == ("stamps_lost_digits", Level.REFUSED)
    assert "599 of 600 rows" in found.seen
