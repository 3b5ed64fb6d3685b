"""`check`: a line a finding, an exit code, JSON, pictures."""

import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from odometry.checks.findings.finding import CheckReport, Finding, Level
from terrain.cli.verbs.check import check, next_step


@pytest.fixture
def faulty(curvy_run, tmp_path):
    """A winding drive with one absurd sample."""
    folder = tmp_path / "faulty"
    shutil.copytree(curvy_run, folder)
    file = folder / "odometry.csv"
    lines = file.read_text().split()
    t, _, right = lines[100].split(",")
    lines[100] = f"{t},50,{right}"
    file.write_text("\n".join(lines) + "\n")
    return folder


def invoke(*arguments):
    return CliRunner().invoke(check, list(map(str, arguments)))


def test_a_clean_run(curvy_run):
    answer = invoke(curvy_run)
    first, *_, last = answer.stdout.splitlines()
    assert answer.exit_code == 0
    assert first == f"{curvy_run}: no findings"
    assert last == f"Next: terrain-odometry identify {curvy_run} --model icr --out my_robot.toml"


def test_findings_by_run_and_an_unreadable_folder_between(curvy_run, faulty, tmp_path):
    answer = invoke(faulty, tmp_path / "nowhere", curvy_run)
    assert answer.exit_code == 1
    lines = answer.stdout.splitlines()
    place = lines.index(f"{faulty}:")
    assert lines[place + 1].startswith("  warning: v_left jumps out and back in 1 sample,")
    assert lines[place + 1].count(". ") >= 2  # seen. cause. remedy.
    place = lines.index(f"{tmp_path / 'nowhere'}:")
    assert lines[place + 1].startswith("  refused: ")
    assert f"{curvy_run}: no findings" in lines
    assert lines[-1].startswith("Next: ")
    assert f"{faulty}, {tmp_path / 'nowhere'}" in lines[-1]


def test_a_picture_is_proposed_only_of_what_can_be_read(faulty, tmp_path):
    nowhere = tmp_path / "nowhere"
    last = invoke(faulty, nowhere).stdout.splitlines()[-1]
    assert f"check {faulty} --picture pictures; correct or leave out {faulty}, {nowhere}" in last
    last = invoke(nowhere).stdout.splitlines()[-1]
    assert last == f"Next: correct or leave out {nowhere}, and check again"


def found(folder, *names):
    """A report with warnings of these names."""
    findings = (Finding(name, Level.WARNING, "seen", "cause", "remedy") for name in names)
    return CheckReport(Path(folder), tuple(findings))


def test_a_run_without_poses_goes_to_run(world, tmp_path):
    blind = world.drive_curves(tmp_path / "blind", pose=False)
    last = invoke(blind).output.splitlines()[-1]
    assert last == f"Next: terrain-odometry run {blind} --out results"


@pytest.mark.parametrize("name", ["one_motion", "treads_still"])
def test_a_drive_of_one_motion_is_not_to_be_identified(tmp_path, name):
    straight, good = tmp_path / "straight", tmp_path / "good"
    for folder in (straight, good):
        folder.mkdir()
        (folder / "pose.csv").touch()
    note = Finding(name, Level.NOTE, "seen", "cause", "remedy")
    reports = {straight: CheckReport(straight, (note,))}
    last = next_step(reports, {})
    assert last.endswith(f"identify refuses {straight}")
    assert "turns to both sides" in last
    both = next_step({**reports, good: CheckReport(good, ())}, {})
    assert both.startswith(f"Next: terrain-odometry identify {straight} {good} ")


def test_true_slip_is_not_to_be_mended():
    reports = {
        Path("ice"): found("ice", "slip", "slip_in_turns"),
        Path("both"): found("both", "slip", "tread_unit"),
        Path("good"): found("good"),
    }
    last = next_step(reports, {})
    assert "correct or leave out both, and check again" in last
    assert "use ice as recorded if the robot truly slipped" in last
    alone = next_step({Path("ice"): reports[Path("ice")]}, {})
    assert "leave out" not in alone
    assert "nothing can be mended" in alone


def test_a_file_is_no_run_folder(faulty):
    assert "this is a file; expected a run folder" in invoke(faulty / "pose.csv").stdout


def test_json_is_one_array_and_nothing_else(curvy_run, faulty, tmp_path):
    answer = invoke(curvy_run, faulty, tmp_path / "nowhere", "--json")
    clean, odd, refused = json.loads(answer.stdout)
    assert answer.exit_code == 1
    assert (clean["run"], clean["misleads"], clean["findings"]) == (curvy_run.name, False, [])
    assert odd["findings"][0]["name"] == "absurd_speed"
    assert odd["findings"][0]["spans_s"]
    assert refused["findings"][0]["level"] == "refused"


def test_pictures_go_into_a_folder_or_a_file(curvy_run, faulty, tmp_path):
    answer = invoke(curvy_run, faulty, tmp_path / "nowhere", "--picture", tmp_path / "pictures")
    assert sorted(file.name for file in (tmp_path / "pictures").iterdir()) == [
        f"{curvy_run.name}.png",
        "faulty.png",
    ]
    assert "no picture" in answer.stderr
    assert f"look at {tmp_path / 'pictures'};" in answer.stdout.splitlines()[-1]
    invoke(curvy_run, "--picture", tmp_path / "one.png")
    assert (tmp_path / "one.png").exists()


def test_a_picture_replaces_its_own_kind_alone(curvy_run, tmp_path):
    """A foreign picture is refused before any work, in a folder of pictures too."""
    mine = tmp_path / "mine.png"
    mine.write_bytes(b"\x89PNG a photograph")
    shutil.copy(mine, tmp_path / f"{curvy_run.name}.png")
    for place in (mine, tmp_path):
        answer = invoke(curvy_run, "--picture", place)
        assert answer.exit_code == 1
        assert "`check` did not make it" in str(answer.exception)
        assert answer.stdout == ""
    assert mine.read_bytes() == b"\x89PNG a photograph"
    for _ in range(2):
        assert invoke(curvy_run, "--picture", tmp_path / "one.png").exit_code == 0


def test_one_file_for_several_runs_is_a_wrong_command_line(curvy_run, faulty, tmp_path):
    answer = invoke(curvy_run, faulty, "--picture", tmp_path / "one.png")
    assert answer.exit_code == 2
    assert "one file" in answer.stderr
    assert not (tmp_path / "one.png").exists()


def test_runs_of_one_name_get_pictures_of_their_own(curvy_run, tmp_path):
    other = tmp_path / "elsewhere" / curvy_run.name
    shutil.copytree(curvy_run, other)
    invoke(curvy_run, other, "--picture", tmp_path / "pictures")
    assert len(list((tmp_path / "pictures").iterdir())) == 2


def test_the_model_is_read(across_run, model_file, tmp_path):
    folder = tmp_path / "across"
    shutil.copytree(across_run, folder)
    (folder / "pose.csv").unlink()
    assert invoke(folder, "--model", model_file).exit_code == 0
    broken = tmp_path / "broken.model"
    broken.write_bytes(b"no model")
    answer = invoke(across_run, "--model", broken)
    assert answer.exit_code == 1
    assert "broken.model" in str(answer.exception)


def test_a_note_does_not_fail(curvy_run, tmp_path, world):
    folder = tmp_path / "noted"
    shutil.copytree(curvy_run, folder)
    world.write_toml(folder / "run.toml", robot=world.robot, camera=world.camera)
    answer = invoke(folder)
    assert "  note: run.toml has [camera]" in answer.stdout
    assert answer.exit_code == 0
