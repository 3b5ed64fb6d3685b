"""`gap`: from run folders to an answer, files and a page, or a refusal that says why."""

import json
import shutil
import sys

import pytest

from odometry.effects.catalogue import added_effects
from odometry.parameters import read_parameters
from terrain.cli.main import main
from tests.blind.cases import make_case

ICRS = "y_left = 0.45\ny_right = -0.42\nx_icr = 0.02\n"


def invoke(monkeypatch, capsys, *arguments):
    """Run the verb as a user would: its exit code, output and messages."""
    monkeypatch.setattr(sys, "argv", ["terrain-odometry", "gap", *map(str, arguments)])
    with pytest.raises(SystemExit) as caught:
        main()
    return caught.value.code, *capsys.readouterr()


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    """Poses whose stamps are late; a third of the runs, to be quick."""
    case = make_case("time_offset", 0, tmp_path_factory.mktemp("case"))
    for folder in (case.measured, case.holdout):
        for file in folder.glob("*.csv"):
            header, *rows = file.read_text().splitlines(keepends=True)
            times_s = [float(row.split(",", 1)[0]) for row in rows]
            kept = [row for row, t in zip(rows, times_s, strict=True) if t < times_s[0] + 50.0]
            file.write_text("".join([header, *kept]))
    return case


@pytest.fixture
def command(monkeypatch, capsys, tmp_path, case):
    """The verb on the case; options replace those of the same name."""

    def run(**options):
        given = {"calibration": case.calibration, "holdout": case.holdout, "out": tmp_path / "out"}
        measured = options.pop("measured", case.measured)
        given |= options
        texts = [text for name, value in given.items() for text in (f"--{name}", value)]
        return invoke(monkeypatch, capsys, measured, *texts)

    return run


@pytest.fixture
def copy_of(tmp_path):
    """A copy of a run folder with fewer rows of poses."""

    def make(folder, *, poses=None):
        copy = shutil.copytree(folder, tmp_path / "copy")
        lines = (copy / "pose.csv").read_text().splitlines(keepends=True)
        if poses is None:
            (copy / "pose.csv").unlink()
        else:
            (copy / "pose.csv").write_text("".join(lines[: poses + 1]))
        return copy

    return make


def assert_refused(answer, tmp_path, *words, code=1):
    """One message of one line, and nothing written."""
    assert answer[0] == code, answer
    assert "Traceback" not in answer[2]
    message = answer[2].splitlines()[-1]
    assert message.startswith("Error: ")
    for word in words:
        assert word in message
    assert not (tmp_path / "out" / "gap.json").exists()


@pytest.mark.slow
def test_the_answer_is_printed_and_written(command, case, tmp_path):
    code, output, messages = command()
    assert code == 0, messages
    out = tmp_path / "out"
    content = json.loads((out / "gap.json").read_text())
    assert output.startswith("Verdict: time_offset\n")
    assert content["verdict"] == "time_offset"
    (effect,) = content["effects"]
    (row,) = [line.split() for line in output.splitlines() if line.startswith("  time_offset ")]
    assert row[1:] == [
        effect["form"],
        f"{effect['gap_before']:.3g}",
        f"{effect['gap_after']:.3g}",
        f"{effect['evidence']:.0f}",
    ]
    true_s = case.truth["time_offset"]["delay_s"]
    found = effect["parameters"]["offset"]
    assert found["low"] < true_s < found["high"]
    assert "pose stamps that are late or early (time_offset)" in output
    assert (out / "report.html").is_file()
    written = {file.relative_to(out).as_posix() for file in out.rglob("*") if file.is_file()}
    assert {"gap.json", "model.toml", "report.html"} <= written
    assert any(name.startswith("figures/gap_") for name in written)
    (line,) = [line for line in output.splitlines() if line.startswith("Wrote to ")]
    assert {name.strip() for name in line.split(": ", 1)[1].split(",")} == written
    last = output.splitlines()[-1]
    assert last.startswith("Next: open ")
    assert str(out / "report.html") in last
    assert f"terrain-odometry compare RUN --model {out / 'model.toml'} --model icr" in last
    (table,) = read_parameters(out / "model.toml").terrains.values()
    (added,) = added_effects(table.effects, "model.toml")
    assert added.by_name["offset"] == pytest.approx(true_s, abs=0.02)


@pytest.mark.slow
def test_what_check_warns_of_stands_beside_the_answer(command, case, tmp_path):
    lost = shutil.copytree(case.measured, tmp_path / "lost")
    header, *rows = (lost / "odometry.csv").read_text().splitlines(keepends=True)
    place = header.strip().split(",").index("v_left")
    for number in range(len(rows) // 3, len(rows) // 2):
        cells = rows[number].split(",")
        cells[place] = "0"
        rows[number] = ",".join(cells)
    (lost / "odometry.csv").write_text("".join([header, *rows]))
    code, output, messages = command(measured=lost)
    assert code == 0, messages
    assert "Check warns: one tread lost (stuck_encoder, lost)" in output
    content = json.loads((tmp_path / "out" / "gap.json").read_text())
    warned = {
        (report["run"], finding["name"])
        for report in content["check"]
        for finding in report["findings"]
        if finding["level"] == "warning"
    }
    assert {(one["run"], one["name"]) for one in content["faults"]} == warned
    assert ("lost", "stuck_encoder") in warned


@pytest.mark.slow
def test_a_given_set_is_taken_as_it_is_and_without_holdout_stretches_are_held_back(
    monkeypatch, capsys, case, tmp_path
):
    base = case.truth["base"]
    file = tmp_path / "set.toml"
    lines = [f"{name} = {value!r}" for name, value in base.items()]
    file.write_text("\n".join(["[terrain.yard]", *lines, "[terrain.ice]", ICRS]))
    out = tmp_path / "out"
    options = ["--calibration", case.calibration, "--model", file, "--terrain", "yard"]
    code, output, messages = invoke(
        monkeypatch, capsys, case.measured, *options, "--horizon-s", 1.5, "--out", out
    )
    assert code == 0, messages
    content = json.loads((out / "gap.json").read_text())
    assert content["verdict"] == "time_offset"
    assert content["holdout"]["unit"] == "m, RMS position error over 1.5 s windows"
    assert content["holdout"]["before"] != content["gap"]["before"]
    (table,) = read_parameters(out / "model.toml").terrains.values()
    assert table.values == pytest.approx(base, abs=0)
    assert output.startswith("Verdict: time_offset\n")


def test_a_measured_run_without_poses_is_refused(command, copy_of, case, tmp_path):
    blind = copy_of(case.measured)
    assert_refused(command(measured=blind), tmp_path, str(blind), "pose.csv")


def test_too_short_a_calibration_is_refused(command, copy_of, case, tmp_path):
    short = copy_of(case.calibration, poses=200)
    assert_refused(command(calibration=short), tmp_path, "9 windows of 2 s", "expected 20 or more")


def test_a_run_that_is_absent_is_refused(command, tmp_path):
    assert_refused(
        command(measured=tmp_path / "absent"), tmp_path, "absent: there is no such folder"
    )


def test_a_run_given_twice_is_refused(command, case, tmp_path):
    assert_refused(command(holdout=case.measured), tmp_path, "given twice")


@pytest.mark.parametrize("which", ["calibration", "measured", "holdout"])
def test_results_are_not_written_into_a_run_folder(command, case, which):
    folder = getattr(case, which)
    before = sorted(folder.iterdir())
    code, _, messages = command(out=folder)
    assert code == 1
    assert "choose another folder" in messages
    assert sorted(folder.iterdir()) == before


def test_an_unknown_model_is_refused_with_those_there_are(command, tmp_path):
    assert_refused(command(model="unicycle"), tmp_path, "unicycle", "icr_symmetric", code=2)


def test_of_a_set_with_several_terrains_one_must_be_said(command, tmp_path):
    file = tmp_path / "set.toml"
    file.write_text(f"[terrain.grass]\n{ICRS}[terrain.sand]\n{ICRS}")
    assert_refused(command(model=file), tmp_path, "set.toml", "grass, sand", "--terrain")


def test_a_horizon_of_nothing_is_refused(command, tmp_path):
    assert_refused(command(**{"horizon-s": 0}), tmp_path, "horizon_s = 0.0")


def test_calibration_runs_must_be_given(monkeypatch, capsys, case, tmp_path):
    code, _, messages = invoke(monkeypatch, capsys, case.measured, "--out", tmp_path / "out")
    assert code == 2
    assert "--calibration" in messages
