"""`identify`: from run folders to a parameter set."""

import re
import shutil

import click
import numpy as np
import pytest

from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.parameters import read_parameters
from terrain.cli.options import window_options
from tests.terrain.cli.identify_calls import SHORT
from tests.terrain.written_runs import drive_curves

TRUTH = {"y_left": 0.26, "y_right": -0.24, "x_icr": 0.03, "alpha_left": 1.0, "alpha_right": 1.0}


def test_the_parameters_are_shown_and_written(command, curvy_run):
    code, output, _ = command(curvy_run, *SHORT)
    assert code == 0
    table = read_parameters(command.out).terrains["ground"]
    assert table.values == pytest.approx(TRUTH, abs=1e-3)
    assert table.covariance_order == tuple(TRUTH)
    assert "curvy" in table.source
    assert f"Wrote {command.out}" in output
    assert "\nNext, on a run that is not among these: terrain-odometry compare " in output


def test_windows_that_were_left_out_are_counted(command, curvy_run, tmp_path):
    """Two seconds without poses."""
    shutil.copytree(curvy_run, tmp_path / "gap")
    file = tmp_path / "gap" / "pose.csv"
    header, *lines = file.read_text().splitlines()
    kept = [line for line in lines if not 10 < float(line.split(",")[0]) < 12]
    file.write_text("\n".join([header, *kept]) + "\n")
    code, _, messages = command(tmp_path / "gap", *SHORT)
    assert code == 0
    assert re.search(r"^Note: \d+ windows? left out: gap of pose.csv \(\d+\)$", messages, re.M)


def test_values_intervals_and_errors_are_shown(command, curvy_run, tmp_path):
    """With 5 mm of noise, so that there is something to show."""
    noisy = shutil.copytree(curvy_run, tmp_path / "noisy")
    header, *lines = (noisy / "pose.csv").read_text().splitlines()
    rows = np.array([line.split(",") for line in lines], dtype=float)
    rows[:, 1:3] += 0.005 * np.random.default_rng(1).standard_normal((len(rows), 2))
    text = "\n".join([header, *(",".join(map(str, row)) for row in rows.tolist())]) + "\n"
    (noisy / "pose.csv").write_text(text)
    sigmas = ("--position-sigma", "0.005", "--yaw-sigma", "0.001")
    code, output, _ = command(noisy, *SHORT, *sigmas, model="icr_symmetric")
    assert code == 0
    shown = {line.split()[0]: line.split() for line in output.splitlines() if line.strip()}
    table = read_parameters(command.out).terrains["ground"]
    for name, value in table.values.items():
        sigma = table.covariance_of((name,))[0, 0] ** 0.5
        assert sigma > 0.003
        told, stated, share, sign, low, high, *_ = shown[name][1:]
        expected = [value, value - 1.96 * sigma, value + 1.96 * sigma]
        assert list(map(float, (told, low, high))) == pytest.approx(expected, rel=0.005)
        assert 0.8 * sigma < float(stated) < sigma
        assert sign == "%"
        assert float(share) == pytest.approx(100 * float(stated) / value, abs=0.06)
    assert shown["b_hat"][-2:] == ["0.45", "m"]
    assert shown["held"][:4] == ["held", "out,", "by", "halves"]
    assert float(shown["held"][4]) < float(shown["ideal"][3])


def test_a_run_too_short_for_a_held_out_error_says_so(command, curvy_run):
    one = ("--fix", "alpha=1", "--horizon", "6", "--starts", "1")  # of one window
    code, output, _ = command(curvy_run, *one, model="icr_symmetric")
    assert code == 0
    assert "No held-out error" in output
    assert "held out, by" not in output


def test_fixed_parameters_are_held(command, curvy_run):
    code, output, _ = command(
        curvy_run, *SHORT, "--fix", "alpha_left=1", "--fix", "alpha_right=1.0"
    )
    assert code == 0
    table = read_parameters(command.out).terrains["ground"]
    assert table.covariance_order == ("y_left", "y_right", "x_icr")
    assert table.values["alpha_left"] == 1.0
    assert sum(line.split()[-1] == "given" for line in output.splitlines() if line.strip()) == 2


def test_known_parameters_can_be_freed(command, curvy_run):
    options = ("--fix", "m=1", "--free", "track_width")
    assert command(curvy_run, *SHORT, *options, model="traction_mode")[0] == 0
    values = read_parameters(command.out).terrains["ground"].values
    assert values["track_width"] == pytest.approx(0.5, abs=0.01)
    command(curvy_run, *SHORT, model="traction_mode")
    values = read_parameters(command.out).terrains["ground"].values
    assert values == pytest.approx({"k": 1.0, "m": 0.6, "track_width": 0.3}, abs=0.02)


def test_the_terrain_can_be_named(command, curvy_run):
    code, output, _ = command(curvy_run, *SHORT, "--terrain", "wet grass")
    assert code == 0
    assert output.count("RUN --terrain 'wet grass' --") == 2  # to compare on, and to run
    assert list(read_parameters(command.out).terrains) == ["wet grass"]


def test_the_windows_are_those_that_were_requested(command, curvy_run):
    """6.2 m of wheel travel in 12 s."""
    numbers = []
    for options in (
        ("--horizon", "1"),
        ("--horizon-s", "1"),
        ("--horizon", "1", "--stride", "0.5"),
    ):
        _, output, _ = command(curvy_run, *options, "--starts", "1")
        numbers.append(int(output.split("windows of")[0].split()[-1]))
    assert numbers[0] in (5, 6)
    assert numbers[1] in (10, 11, 12)
    assert 2 * numbers[0] - 2 <= numbers[2] <= 2 * numbers[0] + 1


@pytest.mark.parametrize(("options", "stated_m"), [([], None), (["--horizon", "2"], 2.0)])
def test_a_stated_horizon_is_kept_where_windows_are_few(options, stated_m):
    seen = []
    click.command()(window_options(lambda **given: seen.append(given["windows"]))).main(
        options, standalone_mode=False
    )
    assert seen[0].horizon_m == stated_m


def test_the_same_call_writes_the_same_bytes(command, curvy_run):
    contents = []
    for _ in range(2):
        command(curvy_run, *SHORT, "--seed", "3", "--loss", "linear")
        contents.append(command.out.read_bytes())
    assert contents[0] == contents[1]


def test_windows_that_are_shorter_than_asked_are_explained(command, curvy_run, tmp_path):
    """Poses that were chained over half a second each."""
    chained = shutil.copytree(curvy_run, tmp_path / "chained")
    header, *lines = (chained / "pose.csv").read_text().splitlines()
    rows = [f"{line},{int(2 * float(line.split(',')[0]))}" for line in lines]
    (chained / "pose.csv").write_text("\n".join([f"{header},window", *rows]) + "\n")
    code, _, messages = command(chained, "--starts", "1")
    assert code == 0
    assert "windows are shorter than the 2 m of the horizon (0." in messages
    assert "`window` of pose.csv changes that often" in messages


def test_positions_without_yaw_are_enough(command, tmp_path):
    """The yaw column emptied: it says what was done instead, and what positions leave open."""
    bare = drive_curves(tmp_path / "gnss", stamps_s=np.arange(0.0, 40.0, 0.05))
    header, *lines = (bare / "pose.csv").read_text().splitlines()
    place = header.split(",").index("yaw")
    rows = [line.split(",") for line in lines]
    for row in rows:
        row[place] = ""
    (bare / "pose.csv").write_text("\n".join([header, *map(",".join, rows)]) + "\n")
    code, output, messages = command(bare, "--starts", "1")
    assert code == 0, messages
    assert read_parameters(command.out).terrains["ground"].values == pytest.approx(TRUTH, abs=5e-3)
    assert "stretches of gnss" in read_parameters(command.out).terrains["ground"].source
    assert "the noise found of positions is less" in output
    assert "Note: positions without yaw: " in messages
    assert "Note: [sensors] pose is not stated" in messages


def with_fast_left_encoder(run, folder):
    """A copy of a run whose left encoder counts 1.3 times as much."""
    copy = shutil.copytree(run, folder)
    header, *lines = (copy / "odometry.csv").read_text().splitlines()
    place = header.split(",").index("v_left")
    rows = [line.split(",") for line in lines]
    for row in rows:
        row[place] = str(1.3 * float(row[place]))
    (copy / "odometry.csv").write_text("\n".join([header, *map(",".join, rows)]) + "\n")
    return copy


def test_a_set_of_a_faulty_recording_is_not_recommended(command, curvy_run, tmp_path):
    late = with_fast_left_encoder(curvy_run, tmp_path / "late")
    code, output, messages = command(late, *SHORT)
    assert code == 0, messages
    *_, words, last = output.splitlines()
    assert words.startswith("These parameters are not recommended: check warns of treads_unequal")
    assert last.endswith(f"and identify again: terrain-odometry check {late}")
    assert "Next, on a run" not in output
    (table,) = read_parameters(command.out).terrains.values()
    assert table.source.endswith("; check warns of treads_unequal")
    assert "# check of late: warning: " in command.out.read_text()


def test_true_slip_is_identified_as_it_is(command, curvy_run, monkeypatch):
    slip = Finding("slip", Level.WARNING, "seen", "cause", "remedy")
    monkeypatch.setattr(
        "terrain.checks.recording.check_recording", lambda run: CheckReport(run.folder, (slip,))
    )
    _, output, _ = command(curvy_run, *SHORT)
    assert "not recommended" not in output
    assert "Next, on a run" in output


def test_runs_that_do_not_fit_one_model_are_said_first(command, curvy_run, tmp_path):
    other = with_fast_left_encoder(curvy_run, tmp_path / "other")
    code, output, messages = command(curvy_run, other, *SHORT)
    assert code == 0, messages
    assert "Warning: [ground] the runs do not fit one model: curvy against other." in messages
    assert "These parameters are not recommended: averages of parts that differ (ground; " in output
    assert "Next, on a run" not in output
    (table,) = read_parameters(command.out).terrains.values()
    assert "; an average of parts that differ" in table.source
