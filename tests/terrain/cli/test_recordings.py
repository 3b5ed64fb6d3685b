"""`--from` and `--to` reach every verb that reads runs, and cut all of them."""

import json
from importlib import import_module
from pathlib import Path

import pytest
from click.testing import CliRunner

from odometry.errors import RunFolderError
from odometry.run_span import Span
from terrain.cli.recordings import read_runs
from terrain.cli.run import run

VERBS = ("run", "identify", "compare", "gap", "identify_modes", "modes")


@pytest.mark.parametrize("name", VERBS)
def test_every_verb_that_reads_runs_has_both_options(name):
    verb = getattr(import_module(f"terrain.cli.{name}"), name)
    options = {word for parameter in verb.params for word in parameter.opts}
    assert {"--from", "--to"} <= options


@pytest.mark.parametrize("name", VERBS)
def test_no_verb_reads_a_run_by_itself(name):
    text = Path(import_module(f"terrain.cli.{name}").__file__).read_text()
    assert "Run.read" not in text


def test_all_runs_are_cut(curvy_run):
    parts = read_runs([curvy_run, curvy_run], Span(2.0, 6.0))
    assert [(p.odometry.stamps_s[0], p.odometry.stamps_s[-1]) for p in parts] == [(2.0, 6.0)] * 2


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
