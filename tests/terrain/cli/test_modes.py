"""`modes`: from run folders and a set of modes to answers, tables and a page."""

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import odometry
from odometry.errors import ParameterError, RunFolderError
from odometry.io.run_folder import write_run_folder
from odometry.modes.models.mode_set_file import write_mode_set
from terrain.cli.verbs.modes import modes
from tests.odometry.arrivals import by_chance
from tests.odometry.modes.mode_examples import (
    positions_that_determine_no_yaw,
    run_of,
    traction_set,
    velocity_set,
)

HALVES = np.repeat(["ice", "tar"], 300)
SEEN = "t,label,confidence,distance_ahead\n1,ice,0.9,0.5\n6,tar,0.9,0.5\n"


@pytest.fixture
def make(tmp_path):
    """A run folder, half on ice and half on tar as its truth says."""

    def write(name, *, gyro=True, poses=True, lost=False, late=False, folder=tmp_path):
        run = run_of(np.where(HALVES == "ice", 1.0, 2.0), size=len(HALVES))
        odometry = dict(run.odometry.columns)
        if late:
            odometry["t"] = by_chance(odometry["t"], 0.03)
        if not gyro:
            del odometry["gyro_z"]
        still = np.zeros(len(HALVES))
        truth = {"t": odometry["t"], "x": still, "y": still, "yaw": still, "terrain": HALVES}
        tables = {"odometry": odometry, "truth": truth}
        tables |= {"pose": run.pose.columns} if poses else {}
        tables |= {"pose": positions_that_determine_no_yaw(run)} if lost else {}
        write_run_folder(folder / name, {"robot": {"track_width": 1.0, "length": 0.8}}, tables)
        return str(folder / name)

    return write


@pytest.fixture
def models(tmp_path):
    write_mode_set(tmp_path / "set.toml", velocity_set())
    return str(tmp_path / "set.toml")


@pytest.fixture
def seen(tmp_path):
    """A file of what vision saw."""

    def write(content=SEEN):
        (tmp_path / "terrain.csv").write_text(content)
        return str(tmp_path / "terrain.csv")

    return write


@pytest.fixture
def with_sight(make, models, seen, tmp_path):
    """What the verb answers with these image labels, and where it would write."""

    def run(content):
        out = tmp_path / "out"
        arguments = ("--models", models, "--seen", seen(content), "--out", out)
        return invoke(make("drive"), *arguments), out

    return run


def invoke(*arguments):
    return CliRunner().invoke(modes, list(map(str, arguments)))


def files_of(out):
    return {file.relative_to(out).as_posix() for file in out.rglob("*") if file.is_file()}


def test_rows_that_came_late_by_chance_are_followed_at_even_stamps(make, models, tmp_path):
    out = tmp_path / "out"
    answer = invoke(make("drive", late=True), "--models", models, "--out", out)
    assert answer.exit_code == 0, answer.output
    assert "they were taken at even stamps" in answer.output


def test_one_run_is_answered_in_words_and_files(make, models, tmp_path):
    out = tmp_path / "out"
    answer = invoke(make("drive"), "--models", models, "--out", out)
    assert answer.exit_code == 0, answer.output
    content = json.loads((out / "result.json").read_text())
    ice, tar = content["motion"]["detections"]
    right = f"right {100 * ice['right']:.0f} % of the time"
    words = f"ice: detected after {ice['after_s']:.1f} s; {right}"
    assert answer.stdout.startswith("Answer: tar at the end, since ")
    assert words in answer.stdout
    assert tar["after_s"] < 2.0
    wrote = answer.stdout.split(f"Wrote to {out}: ")[1].splitlines()[0].split(", ")
    assert set(wrote) == files_of(out)
    assert answer.stdout.rstrip().endswith(f"Next: open {out / 'report.html'}")


def test_shares_of_a_run_without_labels_are_printed_once(make, models, tmp_path):
    run = make("plain")
    (Path(run) / "truth.csv").unlink()
    answer = invoke(run, "--models", models, "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    assert re.findall(r"ice \d+ %", answer.stdout) == ["ice 50 %"]


def test_how_sure_one_must_be_is_an_option(make, models, tmp_path):
    run, shares = make("drive"), []
    for sure in (0.6, 0.999):
        invoke(run, "--models", models, "--sure", sure, "--out", tmp_path / "out")
        content = json.loads((tmp_path / "out" / "result.json").read_text())
        assert content["settings"]["sure"] == sure
        shares.append(content["motion"]["shares_of_time"]["undetermined"])
    assert shares[0] < shares[1]
    assert invoke(run, "--models", models, "--sure", 0.5, "--out", tmp_path).exit_code == 2


def test_what_was_seen_makes_a_second_track(with_sight):
    answer, out = with_sight(SEEN)
    assert answer.exit_code == 0, answer.output
    assert "With the camera: ice: detected after" in answer.stdout
    content = json.loads((out / "result.json").read_text())
    assert content["sight"]["told"] == 2
    assert "Camera and motion disagree nowhere for 2 s or longer, in the " in answer.stdout
    assert content["both_named_s"] > 2
    assert content["none_of_these_while_seen_s"] < 2
    assert (out / "modes_with_sight.csv").exists()


def test_feel_makes_a_second_track(tmp_path):
    shipped, out = odometry.shipped_data(), tmp_path / "out"
    models, feel = shipped / "modes" / "demo.toml", shipped / "feel" / "demo.feel"
    given = ("--models", models, "--feel", feel, "--out", out)
    answer = invoke(shipped / "runs" / "demo", *given)
    assert answer.exit_code == 0, answer.output
    assert "With feel: " in answer.stdout
    assert json.loads((out / "result.json").read_text())["feel"]["shares_of_time"]
    with (out / "modes_with_feel.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    of_feel = [float(rows[-1][f"feel_{name}"]) for name in ("grass", "gravel")]
    assert sum(of_feel) == pytest.approx(1.0)
    assert "feel_grass" not in (out / "modes.csv").read_text().splitlines()[0]


def test_what_no_pose_can_check_is_said(make, models, tmp_path):
    with_poses = invoke(make("with"), "--models", models, "--out", tmp_path / "one")
    without = invoke(make("without", poses=False), "--models", models, "--out", tmp_path / "two")
    assert "Not checked: the scale of the gyroscope" not in with_poses.stdout
    assert "Not checked: the scale of the gyroscope, without measured headings" in without.stdout
    assert "Not checked: the distance, without measured positions" in without.stdout
    point = "Not checked: about which point the robot turns, without measured yaw: a load"
    assert point in without.stdout
    assert point not in with_poses.stdout
    assert len(json.loads((tmp_path / "two" / "result.json").read_text())["not_checked"]) == 4


def test_positions_that_determine_no_yaw_leave_the_answers_to_the_gyroscope(make, models, tmp_path):
    contents = []
    for name, tables in (("alone", {"poses": False}), ("drive", {"lost": True})):
        answer = invoke(make(name, **tables), "--models", models, "--out", tmp_path / "out")
        assert answer.exit_code == 0, answer.output
        contents.append(json.loads((tmp_path / "out" / "result.json").read_text()))
    assert "velocity modes need no yaw" in answer.stderr
    without, lost = (one["motion"]["shares_of_time"] for one in contents)
    assert lost == without
    assert {"ice", "tar"} <= set(lost)
    assert any("the scale of the gyroscope" in said for said in contents[1]["not_checked"])


def test_a_sight_that_lies_is_reported(with_sight):
    answer, out = with_sight(SEEN.replace("6,tar", "6,ice"))
    assert answer.exit_code == 0, answer.output
    assert "it is ice by the camera and tar by the motion." in answer.stdout
    content = json.loads((out / "result.json").read_text())
    assert {(one["seen"], one["felt"]) for one in content["disagreements"]} == {("ice", "tar")}


def test_several_runs_get_a_folder_each_and_a_failed_one_a_row(make, models, tmp_path):
    out = tmp_path / "out"
    good, blind = make("drive"), make("blind", gyro=False)
    other = make("drive", folder=tmp_path / "elsewhere")
    answer = invoke(good, blind, other, tmp_path / "absent", "--models", models, "--out", out)
    assert answer.exit_code == 1
    assert "blind: failed: " in answer.stdout
    assert "no yaw rate; expected gyro_z" in answer.stdout
    assert answer.stdout.count("\n  how sure: a mode is named where its probability is 90 %") == 2
    with (out / "runs.csv").open(newline="") as stream:
        rows = {row["run"]: row for row in csv.DictReader(stream)}
    assert list(rows) == ["drive", "blind", "drive_2", "absent"]
    assert "no yaw rate" in rows["blind"]["failed"]
    assert "no such folder" in rows["absent"]["failed"]
    assert rows["drive"]["told"] == rows["drive_2"]["told"] == "2"
    for name in ("drive", "drive_2"):
        assert files_of(out / name) >= {"modes.csv", "result.json", "report.html"}
        (check,) = json.loads((out / name / "result.json").read_text())["check"]  # its own alone
        assert check["run"] == "drive"
    assert not (out / "blind").exists()
    assert answer.stdout.rstrip().endswith(f"Next: open {out / 'drive' / 'report.html'}")


def test_the_same_run_gives_the_same_bytes(make, models, tmp_path):
    run = make("drive")
    for name in ("a", "b"):
        assert invoke(run, "--models", models, "--out", tmp_path / name).exit_code == 0
    assert files_of(tmp_path / "a") == files_of(tmp_path / "b")
    for name in files_of(tmp_path / "a"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_traction_modes_need_poses(make, tmp_path):
    of_half_the_width = traction_set()
    modes = replace(of_half_the_width.modes, track_width=1.0)
    write_mode_set(tmp_path / "set.toml", replace(of_half_the_width, modes=modes))
    arguments = ("--models", tmp_path / "set.toml", "--out", tmp_path / "out")
    answer = invoke(make("drive"), *arguments)
    assert answer.exit_code == 0, answer.output
    assert "The run names ice, tar, which is no mode" in answer.stdout
    assert (tmp_path / "out" / "figures" / "path.png").exists()
    answer = invoke(make("lost", poses=False), *arguments)
    with pytest.raises(RunFolderError, match=r"lost: no pose\.csv; expected measured poses"):
        raise answer.exception


@pytest.mark.parametrize(
    ("content", "error", "message"),
    [
        (SEEN.replace("tar", "mud"), ParameterError, "'mud' .* is no mode; expected one of ice, t"),
        (SEEN.replace("0.9", "1.9"), ParameterError, "confidence 1.9"),
        ("t,label\n0,ice\n", RunFolderError, "'confidence' is missing"),
    ],
)
def test_a_sight_that_cannot_be_used_is_reported(with_sight, content, error, message):
    answer, out = with_sight(content)
    with pytest.raises(error, match=message):
        raise answer.exception
    assert not out.exists()


@pytest.mark.parametrize("content", [SEEN.replace("0.5\n", "99\n"), SEEN.replace("0.9", "")])
def test_a_sight_without_a_label_leaves_the_motion(with_sight, content):
    content = re.sub("(?m),(ice|tar),", ",unknown,", content) if ",," in content else content
    answer, out = with_sight(content)
    assert answer.exit_code == 0, answer.output
    assert "vision named no terrain" in answer.stderr
    assert "by motion alone" in answer.stderr
    assert (out / "modes.csv").exists()
    assert not (out / "modes_with_sight.csv").exists()
    assert "Camera and motion" not in answer.stdout


def test_an_unknown_key_of_the_set_is_reported_before_anything_is_written(make, models, tmp_path):
    text = (tmp_path / "set.toml").read_text()
    (tmp_path / "set.toml").write_text(text.replace("dwell_s", "dwell", 1))
    answer = invoke(make("drive"), "--models", models, "--out", tmp_path / "out")
    with pytest.raises(ParameterError, match=r"set\.toml: \[mode\.ice\]: unknown key 'dwell'"):
        raise answer.exception
    assert not (tmp_path / "out").exists()


def test_usage_errors(make, models, seen, tmp_path):
    run, out = make("drive"), tmp_path / "out"
    two = invoke(run, make("other"), "--models", models, "--seen", seen(), "--out", out)
    assert (two.exit_code, "--seen is of one run; there are 2" in two.stderr) == (2, True)
