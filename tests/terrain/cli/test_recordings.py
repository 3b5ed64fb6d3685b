"""`--from` and `--to` reach every verb that reads runs, and cut all of them."""

import json
import shutil
from importlib import import_module
from pathlib import Path

import click
import numpy as np
import pytest
from click.testing import CliRunner

from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.errors import RunFolderError
from odometry.io.run_folder import write_run_folder
from odometry.outputs.provenance import Made
from odometry.recording.run_span import Span
from terrain.cli.outputs import comment
from terrain.cli.recordings import CHECKS, read_runs
from terrain.cli.verbs.run import run
from tests.odometry.arrivals import with_arrival
from tests.odometry.checks.drives import winding

VERBS = ("run", "batch", "identify", "compare", "gap", "identify_modes", "modes")


@pytest.mark.parametrize("name", VERBS)
def test_every_verb_that_reads_runs_has_both_options(name):
    verb = getattr(import_module(f"terrain.cli.verbs.{name}"), name)
    options = {word for parameter in verb.params for word in parameter.opts}
    assert {"--from", "--to"} <= options


@pytest.mark.parametrize("name", VERBS)
def test_no_verb_reads_a_run_by_itself(name):
    text = Path(import_module(f"terrain.cli.verbs.{name}").__file__).read_text()
    assert "Run.read" not in text


def test_all_runs_are_cut(curvy_run):
    parts = read_runs([curvy_run, curvy_run], Span(2.0, 6.0))
    assert [(p.odometry.stamps_s[0], p.odometry.stamps_s[-1]) for p in parts] == [(2.0, 6.0)] * 2


def test_rows_that_came_late_by_chance_are_read_at_even_stamps(tmp_path, capsys):
    driven = winding(600)
    late = with_arrival(driven).odometry.columns
    write_run_folder(tmp_path, {"robot": {"track_width": 0.6}}, {"odometry": late})
    (even,) = read_runs([tmp_path], Span())
    off_s = np.std(even.odometry.stamps_s - driven.odometry.stamps_s)
    assert off_s < 0.3 * np.std(late["t"] - driven.odometry.stamps_s)
    assert "rows of odometry.csv have stamps of arrival" in capsys.readouterr().err


@pytest.mark.usefixtures("no_report")
def test_a_run_of_a_part_says_which(curvy_run, tmp_path):
    arguments = [str(curvy_run), "--out", str(tmp_path / "out"), "--from", "2", "--to", "6"]
    answer = CliRunner().invoke(run, arguments)
    assert answer.exit_code == 0, answer.output
    content = json.loads((tmp_path / "out" / "result.json").read_text())
    assert content["duration_s"] == pytest.approx(4.0)
    assert content["made"]["command"].endswith("--from 2.0 --to 6.0")


def test_nothing_left_is_an_error(curvy_run, tmp_path):
    arguments = [str(curvy_run), "--out", str(tmp_path / "out"), "--from", "20"]
    answer = CliRunner().invoke(run, arguments)
    assert isinstance(answer.exception, RunFolderError)
    assert "the run lasts 12.000 s" in str(answer.exception)


def test_an_end_before_the_start_is_a_wrong_command_line(curvy_run, tmp_path):
    arguments = [str(curvy_run), "--out", str(tmp_path / "out"), "--from", "9", "--to", "3"]
    answer = CliRunner().invoke(run, arguments)
    assert answer.exit_code == 2
    assert "--from 9 --to 3: expected an end after the start" in answer.stderr


@pytest.mark.usefixtures("no_report")
def test_what_the_check_warns_of_is_said_and_kept(curvy_run, tmp_path):
    """One absurd sample: the run goes on, and what was learned is not recommended."""
    folder = tmp_path / "spiked"
    shutil.copytree(curvy_run, folder)
    lines = (folder / "odometry.csv").read_text().splitlines()
    cells = lines[60].split(",")
    cells[lines[0].split(",").index("v_left")] = "50"
    lines[60] = ",".join(cells)
    (folder / "odometry.csv").write_text("\n".join(lines) + "\n")
    answer = CliRunner().invoke(run, [str(folder), "--out", str(tmp_path / "out")])
    assert answer.exit_code == 0, answer.output
    assert f"Warning: {folder}: " in answer.stderr
    assert "up to 50 m/s (row 61)" in answer.stderr
    assert "learned.toml is not recommended" in answer.stdout
    (report,) = json.loads((tmp_path / "out" / "result.json").read_text())["check"]
    assert (report["misleads"], report["findings"][0]["name"]) == (True, "absurd_speed")


def test_a_refused_run_stops_every_verb(curvy_run, tmp_path):
    folder = tmp_path / "milliseconds"
    shutil.copytree(curvy_run, folder)
    for file in folder.glob("*.csv"):
        head, *rows = file.read_text().splitlines()
        cells = [row.split(",", 1) for row in rows]
        text = [head, *(f"{1e9 * float(stamp):.0f},{rest}" for stamp, rest in cells)]
        file.write_text("\n".join(text) + "\n")
    answer = CliRunner().invoke(run, [str(folder), "--out", str(tmp_path / "out")])
    assert isinstance(answer.exception, RunFolderError)
    assert "nanoseconds" in str(answer.exception)
    assert not (tmp_path / "out" / "result.json").exists()


def test_a_set_says_what_the_check_warned_of():
    finding = Finding("slip", Level.WARNING, "seen", "cause", "remedy")
    note = Finding("epoch_stamps", Level.NOTE, "seen", "cause", "remedy")
    made = Made("identify", "identify a --model icr", {}, (), {})
    with click.Context(click.Command("identify")) as context:
        context.meta[CHECKS] = [CheckReport(Path("a"), (finding, note))]
        lines = comment(made).splitlines()
    assert lines[-1] == "# check of a: warning: seen. cause. remedy."
    assert "\n".join(lines[:-1]) + "\n" == made.to_comment()
