"""Whose a run folder is on a command line."""

import click
import pytest
from click.testing import CliRunner

from terrain.cli.run_folders import RunFolder, RunsFirst


@pytest.fixture
def given(tmp_path, monkeypatch):
    """What a command gets that has runs of its own, and an option that takes runs."""
    monkeypatch.chdir(tmp_path)
    for name in ("a", "b", "c"):
        (tmp_path / name).mkdir()

    @click.command(cls=RunsFirst)
    @click.argument("runs", metavar="RUN...", nargs=-1, required=True, type=RunFolder())
    @click.option("--known", multiple=True, type=RunFolder())
    @click.option("--out")
    @click.option("--fast", is_flag=True)
    def command(runs, known, **_):
        click.echo([[str(run) for run in of] for of in (runs, known)])

    return lambda line: CliRunner().invoke(command, line.split())


@pytest.mark.parametrize(
    "line",
    [
        "a --known b",
        "--known b a",
        "--known=b a",
        "a --fast --known b --out d",
        "--fast --known b a",
    ],
)
def test_one_run_of_each_in_any_order(given, line):
    assert given(line).output == "[['a'], ['b']]\n"


@pytest.mark.parametrize(
    ("line", "after"),
    [
        ("a --known b c", "c"),
        ("a --known=b c --out d", "c"),
        ("--known a b c", "b c"),
        ("--known a b --out d c", "b"),
    ],
)
def test_a_run_that_may_be_of_either_is_an_error(given, line, after):
    answer = given(line)
    assert answer.exit_code == 2
    assert (
        f"Error: {after} after a run of --known: write --known before each of its runs, and RUN... "
        "before all options" in answer.output
    )


@pytest.mark.parametrize("line", ["a --known b --", "--known b -- a", "a --known=b --"])
def test_what_stands_after_two_dashes_belongs_to_no_option(given, line):
    assert given(line).output == "[['a'], ['b']]\n"


def test_two_runs_after_two_dashes_are_no_error(given):
    assert given("--known c -- a b").output == "[['a', 'b'], ['c']]\n"


def test_help_is_given_and_a_wrong_option_named_whatever_else_is_wrong(given):
    answer = given("a --known b c --help")
    assert answer.exit_code == 0
    assert "Usage:" in answer.output
    wrong = given("a --known b --knwn c").output
    assert "No such option" in wrong
    assert "--knwn" in wrong


def test_completion_asks_for_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    command = RunsFirst("verb", params=[click.Option(["--known"], type=RunFolder(), multiple=True)])
    assert command.make_context("verb", ["--known", "b", "c", "d"], resilient_parsing=True)


def test_options_that_take_no_runs_are_as_ever(given):
    assert given("--fast a --out d b --known c").output == "[['a', 'b'], ['c']]\n"
