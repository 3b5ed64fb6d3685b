"""The command itself: help without slow imports, errors as one line."""

import importlib.metadata
import re
import signal
import subprocess
import sys

import pytest
from click.testing import CliRunner

from terrain.cli.main import cli, main

VERBS = ("import", "check", "camera", "label", "train", "classify", "run", "batch", "evaluate")
VERBS += ("synthesise", "simulate", "identify", "compare", "gap")
VERBS += ("identify-modes", "modes", "identify-feel", "feel", "export", "demo")
SLOW = ("numpy", "scipy", "sklearn", "skimage", "cv2", "matplotlib", "filterpy", "pandas")


def command(*arguments, cwd=None):
    """The command in a process of its own; the last line says what it imported."""
    program = (
        "import atexit, sys\n"
        f"slow = {SLOW!r}\n"
        "atexit.register(lambda: print('imported', *[m for m in slow if m in sys.modules]))\n"
        "from terrain.cli.main import main\n"
        "main()\n"
    )
    return subprocess.run(
        [sys.executable, "-c", program, *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        cwd=cwd,
    )


@pytest.mark.parametrize("verb", VERBS)
def test_help_shows_an_example_and_imports_nothing_slow(verb):
    answer = command(verb, "--help")
    assert answer.returncode == 0, answer.stderr
    text, _, imported = answer.stdout.rstrip().rpartition("\n")
    assert f"  terrain-odometry {verb} " in text.split("Example:")[1]
    assert imported == "imported"


def test_the_groups_help_lists_every_verb_and_imports_nothing_slow():
    answer = command("--help")
    assert answer.returncode == 0
    assert "Example:" in answer.stdout
    assert all(f"\n  {verb} " in answer.stdout for verb in VERBS)
    assert answer.stdout.rstrip().endswith("imported")


def test_version():
    answer = command("--version")
    assert answer.returncode == 0
    assert importlib.metadata.version("terrain-odometry") in answer.stdout


@pytest.fixture
def here(monkeypatch, capsys):
    """The command in this process: its exit code and what it wrote to stderr."""
    signals = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}

    def command_here(*arguments):
        monkeypatch.setattr(sys, "argv", ["terrain-odometry", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        return ended.value.code, capsys.readouterr().err

    yield command_here
    for number, handler in signals.items():
        signal.signal(number, handler)


def test_a_known_error_is_one_line_and_exit_code_1(here, tmp_path):
    code, said = here("run", tmp_path / "absent", "--out", tmp_path / "out")
    assert code == 1
    assert said.count("\n") == 1
    assert said.startswith("Error: ")
    assert "absent: there is no such folder" in said
    assert not (tmp_path / "out").exists()


def test_a_file_that_is_not_as_the_format_says_is_named_with_its_remedy(here, tmp_path):
    """As `check` names it: a pose.csv of a receiver that knows no heading."""
    (tmp_path / "run.toml").write_text("[robot]\ntrack_width = 0.5\n")
    (tmp_path / "odometry.csv").write_text("t,v_left,v_right\n0,0.5,0.5\n1,0.5,0.5\n")
    (tmp_path / "pose.csv").write_text("t,x,y\n0,0,0\n1,0.5,0\n")
    code, said = here("run", tmp_path, "--out", tmp_path / "out")
    assert code == 1
    assert "the header has t, x, y. The heading was not measured" in said
    assert said.rstrip().endswith("positions alone are used then")


def test_a_folder_that_cannot_be_made_is_one_line_and_exit_code_1(here, tmp_path, curvy_run):
    (tmp_path / "file").write_text("")
    code, said = here("run", curvy_run, "--out", tmp_path / "file" / "out")
    assert code == 1
    assert said.count("\n") == 1
    assert said.startswith("Error: ")


def test_an_unknown_verb_is_a_usage_error():
    answer = command("fly")
    assert answer.returncode == 2
    assert "No such command 'fly'" in answer.stderr


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("chek", "Did you mean 'check'?"),
        ("Identify", "Did you mean 'identify'?"),
        ("identify_modes", "Did you mean 'identify-modes'?"),
        ("ident", "Did you mean 'identify' or 'identify-modes' or 'identify-feel'?"),
        ("synthesize", "Did you mean 'synthesise'?"),
        ("fly", f"Verbs: {', '.join(VERBS)}"),
    ],
)
def test_the_nearest_verbs_are_named(word, meant):
    answer = CliRunner().invoke(cli, [word])
    assert answer.exit_code == 2
    assert answer.stderr.splitlines()[-1] == f"Error: No such command {word!r}. {meant}"


@pytest.mark.parametrize("verb", VERBS)
def test_help_says_terrain_but_of_the_plane_that_a_camera_sees(verb):
    text = " ".join(CliRunner().invoke(cli, [verb, "--help"]).output.split())
    for plane in ("[default: ground]",):
        text = text.replace(plane, "")
    assert not re.search(r"\bgrounds?\b", text, re.IGNORECASE)
