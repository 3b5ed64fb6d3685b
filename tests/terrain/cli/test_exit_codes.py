"""One rule for all verbs: 1 for an output that is refused, 2 for a wrong command line."""

import pytest
from click.testing import CliRunner

from odometry.errors import OdometryError
from odometry.installed import shipped_data
from terrain.cli.main import VERBS, cli

OUTPUTS = {"out", "picture"}
READ = {"RUN", "PATCHES", "VEHICLE", "SET.toml", "drive.bag"}
# What each verb needs beside its output.
NEEDED = {
    "import": ("drive.bag",),
    "check": ("RUN",),
    "label": ("RUN", "--span", "0:5=grass"),
    "camera": ("RUN",),
    "train": ("PATCHES",),
    "run": ("RUN",),
    "batch": ("RUN",),
    "synthesise": ("--vehicle", "VEHICLE"),
    "simulate": ("--vehicle", "VEHICLE"),
    "identify": ("RUN", "--model", "icr"),
    "compare": ("RUN",),
    "gap": ("RUN", "--calibration", "RUN"),
    "identify-modes": ("RUN",),
    "modes": ("RUN", "--models", "VEHICLE"),
    "identify-feel": ("RUN",),
    "feel": ("RUN", "--model", "VEHICLE"),
    "export": ("SET.toml", "--to", "ros"),
    "demo": (),
}
OF_FILE = {"train": ".model", "identify": ".toml", "identify-modes": ".toml"}  # that they write
OF_FILE |= {"identify-feel": ".feel"}
FOLDERS = [verb for verb in NEEDED if verb not in {*OF_FILE, "check"}]


@pytest.fixture
def places(tmp_path, world):
    """A run, patches and a vehicle to read; files and folders of others to write to."""
    world.drive_curves(tmp_path / "RUN")
    (tmp_path / "PATCHES").symlink_to(shipped_data() / "patches")
    (tmp_path / "VEHICLE").write_text("[robot]\ntrack_width = 0.5\n")
    (tmp_path / "SET.toml").write_text("[terrain.a]\ny_left = 1\ny_right = -1\nx_icr = 0\n")
    (tmp_path / "drive.bag").write_bytes(b"#ROSBAG V2.0\n")
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "thesis.tex").write_text("years of work")
    for suffix in ("", ".toml", ".model", ".png"):
        (tmp_path / f"notes{suffix}").write_text("mine")
    return tmp_path


def invoke(places, verb, *arguments):
    words = [str(places / word) if word in READ else str(word) for word in arguments]
    return CliRunner().invoke(cli, [verb, *words])


def is_refused(answer):
    """Before any work; `main` turns the exception into exit code 1."""
    return answer.exit_code == 1 and isinstance(answer.exception, OdometryError)


def before_and_after(places):
    return {path: path.read_bytes() for path in places.rglob("*") if path.is_file()}


def test_no_verb_that_writes_is_left_out():
    writing = {
        verb
        for verb in VERBS
        if OUTPUTS & {option.name for option in cli.get_command(None, verb).params}
    }
    assert writing == set(NEEDED)


@pytest.mark.parametrize("verb", FOLDERS)
@pytest.mark.parametrize("out", ["thesis", "notes", "notes/below"])
def test_a_place_that_is_not_the_verbs_own_is_refused(places, verb, out):
    before = before_and_after(places)
    answer = invoke(places, verb, *NEEDED[verb], "--out", places / out)
    assert is_refused(answer), answer.output
    assert before_and_after(places) == before


@pytest.mark.parametrize("verb", OF_FILE)
@pytest.mark.parametrize("out", ["notes{}", "a_folder{}", "notes/below{}"])
def test_a_file_that_is_not_the_verbs_own_is_refused(places, verb, out):
    name = out.format(OF_FILE[verb])
    if out.startswith("a_folder"):
        (places / name).mkdir()
    before = before_and_after(places)
    answer = invoke(places, verb, *NEEDED[verb], "--out", places / name)
    assert is_refused(answer), answer.output
    assert before_and_after(places) == before


@pytest.mark.parametrize("verb", [verb for verb in NEEDED if {"RUN", "VEHICLE"} & {*NEEDED[verb]}])
def test_an_input_as_the_output_is_refused(places, verb):
    """A file that is read, or a folder of what is read."""
    makers = ("identify", "identify-modes", "identify-feel")
    inside = dict.fromkeys(makers, "RUN/odometry.toml")
    (places / "RUN" / "odometry.toml").write_text("x = 1\n")
    option = "--picture" if verb == "check" else "--out"
    name = "notes.png" if verb == "check" else inside.get(verb, ".")
    before = before_and_after(places)
    answer = invoke(places, verb, *NEEDED[verb], option, places / name)
    assert is_refused(answer), answer.output
    assert before_and_after(places) == before


def test_a_picture_that_is_not_its_own_is_refused(places):
    options = ["RUN", "--model", "icr", "--out", places / "new.toml", "--picture"]
    assert is_refused(invoke(places, "identify", *options, places / "notes.png"))
    assert not (places / "new.toml").exists()


@pytest.mark.parametrize("verb", NEEDED)
def test_a_wrong_command_line_is_a_usage_error(places, verb):
    assert invoke(places, verb, *NEEDED[verb], "--no-such-option").exit_code == 2
    if verb not in {"check", "demo"}:
        assert invoke(places, verb, *NEEDED[verb]).exit_code == 2  # no --out


@pytest.mark.parametrize("verb", ["identify", "identify-modes"])
def test_a_name_of_another_kind_is_a_usage_error(places, verb):
    answer = invoke(places, verb, *NEEDED[verb], "--out", places / "set.txt")
    assert answer.exit_code == 2
    assert "expected a name that ends in .toml" in answer.output
