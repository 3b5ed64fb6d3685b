"""`identify-modes`: from run folders to a set of modes, or a refusal that says why."""

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.errors import OdometryError
from odometry.io.run_folder import write_run_folder
from odometry.modes.models.mode_pairs import Pair
from odometry.modes.models.mode_set_file import read_mode_set
from terrain.cli.verbs.identify_modes import _print_alike, identify_modes
from tests.odometry.modes.mode_drives import asked_twists
from tests.odometry.modes.mode_examples import positions_that_determine_no_yaw, run_of

TURNS = {"ice": 1.0, "tar": 1.4}


@pytest.fixture
def make(tmp_path):
    """A run folder of 30 s that turns by so much on a ground, with what is wanted of it."""

    def write(name, turn, ground, *, gyro=True, poses=True, lost=False):
        run = run_of(turn, size=1500, track_width=0.5, rng=np.random.default_rng(len(name)))
        odometry = dict(run.odometry.columns)
        if not gyro:
            del odometry["gyro_z"]
        tables = {"odometry": odometry} | ({"pose": run.pose.columns} if poses else {})
        if lost:
            tables["pose"] = positions_that_determine_no_yaw(run)
        settings = {"robot": {"track_width": 0.5}} | (
            {"run": {"terrain": ground}} if ground else {}
        )
        write_run_folder(tmp_path / name, settings, tables)
        return str(tmp_path / name)

    return write


@pytest.fixture
def grounds(make):
    return [make(ground, turn, ground) for ground, turn in TURNS.items()]


@pytest.fixture
def out(tmp_path):
    return tmp_path / "set.toml"


def invoke(*arguments):
    return CliRunner().invoke(identify_modes, list(map(str, arguments)))


def cells(answer, mode):
    (line,) = [line for line in answer.stdout.splitlines() if line.startswith(f"  {mode} ")]
    return list(map(float, line.split()[1:]))


def test_velocity_modes_are_shown_and_written(grounds, out):
    answer = invoke(*grounds, "--out", out, "--dwell", 7)
    assert answer.exit_code == 0, answer.output
    found = read_mode_set(out)
    assert found.names == ("ice", "tar")
    assert found.dwell_s.tolist() == [7.0, 7.0]
    assert "ice, tar" in found.source
    for name, turn in TURNS.items():
        per_metre, track_m, *_ = cells(answer, name)
        assert per_metre == pytest.approx(turn / 0.5, rel=0.05)
        assert track_m == pytest.approx(1 / per_metre, abs=2e-3)
    assert "ice and tar are the most similar: driven as in these runs they take" in answer.stdout
    assert f"Wrote {out}\nNext: terrain-odometry modes RUN --models {out} --out" in answer.stdout


def test_a_gyroscope_is_enough_for_velocity_modes(make, out):
    """Where positions determine no yaw, treads and yaw rates are those of the same drives."""
    lost = [make(ground, turn, ground, lost=True) for ground, turn in TURNS.items()]
    answer = invoke(*lost, "--out", out)
    assert answer.exit_code == 0, answer.output
    assert "velocity modes need no yaw" in answer.stderr
    for name, turn in TURNS.items():
        assert cells(answer, name)[0] == pytest.approx(turn / 0.5, rel=0.05)


def test_traction_modes_need_a_yaw(make, out):
    answer = invoke(make("ice", 1.0, "ice", lost=True), "--kind", "traction", "--out", out)
    with pytest.raises(OdometryError, match="do not determine it"):
        raise answer.exception


def test_modes_that_answer_alike_are_named(make, out):
    alike = [make("ice", 1.0, "ice"), make("snow", 1.0, "snow")]
    answer = invoke(*alike, "--out", out)
    assert answer.exit_code == 0, answer.output
    assert "ice and snow differ little: driven as in these runs they take" in answer.stdout


def test_drives_that_contradict_their_names_are_noted(make, out):
    turns = {"ice": 1.0, "tar1": 1.3, "tar22": 1.0, "ice333": 1.3}  # noise goes with the length
    answer = invoke(*(make(name, turn, name[:3]) for name, turn in turns.items()), "--out", out)
    assert answer.exit_code == 0, answer.output
    assert "Note: ice, named ice, turns the robot by" in answer.stderr
    assert "nearer to tar22 of tar" in answer.stderr


@pytest.fixture
def mud(tmp_path):
    """A run on mud of these treads and yaw rates."""

    def write(left, right, yaw_rates):
        stamps_s = 0.05 * np.arange(len(left))
        columns = {"t": stamps_s, "v_left": left, "v_right": right, "gyro_z": yaw_rates}
        settings = {"robot": {"track_width": 0.5}, "run": {"terrain": "mud"}}
        write_run_folder(tmp_path / "mud", settings, {"odometry": columns})
        return tmp_path / "mud"

    return write


def test_of_treads_that_hardly_turn_the_robot_no_turns_are_shown(make, mud, out):
    """Its gain would be any number."""
    rng = np.random.default_rng(3)
    turn = np.repeat(rng.uniform(-0.3, 0.3, 30), 20)
    run = mud(0.5 - turn / 2, 0.5 + turn / 2, rng.normal(0, 0.3, 600))
    answer = invoke(run, *(make(name, turn, name) for name, turn in TURNS.items()), "--out", out)
    assert answer.exit_code == 0, answer.output
    (row,) = (line.split() for line in answer.stdout.splitlines() if line.split()[0] == "mud")
    assert row[1:5] == ["-"] * 4
    assert "ice and tar are the most similar" in answer.stdout
    assert "by how much its treads turn the robot is not known" in answer.stderr


def test_a_drive_that_turns_alike_all_the_time_is_refused(make, mud, out):
    right = 0.5 + np.random.default_rng(3).normal(0, 0.002, 600)
    others = (make(name, turn, name) for name, turn in TURNS.items())
    yaw_rates = 0.3 * right + np.random.default_rng(4).normal(0, 0.01, 600)
    answer = invoke(mud(0.6 * right, right, yaw_rates), *others, "--out", out)
    assert answer.exit_code == 1
    assert "mud: its runs go straight on, or turn alike all the time" in str(answer.exception)
    assert not out.exists()


def test_one_mode_is_not_enough(grounds, out):
    answer = invoke(grounds[0], "--out", out)
    assert answer.exit_code == 0, answer.output
    assert "two or more" in answer.stderr


def test_shared_modes_have_one_model(grounds, out):
    answer = invoke(*grounds, "--shared", "--out", out)
    assert answer.exit_code == 0, answer.output
    found = read_mode_set(out)
    np.testing.assert_array_equal(*found.modes.A)
    np.testing.assert_array_equal(*found.modes.B)
    assert "shared" in found.source
    assert cells(answer, "ice")[:4] == cells(answer, "tar")[:4]


@pytest.mark.parametrize("paper", [True, False])
def test_traction_modes_are_shown_and_written(grounds, out, paper):
    answer = invoke(*grounds, "--kind", "traction", *["--paper"] * paper, "--out", out)
    assert answer.exit_code == 0, answer.output
    found = read_mode_set(out)
    assert found.modes.kind == "traction"
    for row, (name, turn) in enumerate(TURNS.items()):
        k, *shares, lag_s = cells(answer, name)[:6]
        assert k == pytest.approx(found.modes.k[row, 0], abs=6e-4)
        assert shares[:2] == pytest.approx(found.modes.m[row], abs=6e-4)
        width = found.modes.track_width
        slow = asked_twists(found.modes.gains[row], [(0.05, 0.15), (0.15, 0.05)], width)[:, 2]
        assert shares[2:] == pytest.approx(slow / [0.1, -0.1] * width, abs=6e-4)
        assert lag_s == pytest.approx(found.modes.lag_s[row], abs=6e-4)
        if paper:
            assert [k, *shares] == pytest.approx([1.0, *[turn] * 4], abs=0.03)


def test_an_option_of_the_other_kind_is_a_usage_error(grounds, out):
    for options in (["--shared", "--kind", "traction"], ["--paper"]):
        answer = invoke(*grounds, *options, "--out", out)
        assert answer.exit_code == 2
        assert f"{options[0]} is for --kind" in answer.stderr
    assert invoke(*grounds, "--out", out.with_suffix(".txt")).exit_code == 2
    assert not out.exists()


@pytest.mark.parametrize(
    ("settings", "kind", "message"),
    [
        ({"gyro": False}, "velocity", "one: no yaw rate"),
        ({"poses": False}, "traction", r"one.*pose"),
        ({"ground": None}, "velocity", "have no terrain; expected .run. terrain"),
        ({"ground": None}, "traction", "names no mode; expected .run. terrain"),
        ({"ground": "unknown"}, "velocity", "have no terrain"),
    ],
)
def test_runs_that_cannot_be_used_are_reported(make, out, settings, kind, message):
    run = make("one", 1.0, **({"ground": "ice"} | settings))
    answer = invoke(run, "--kind", kind, "--out", out)
    with pytest.raises(OdometryError, match=message):
        raise answer.exception
    assert not out.exists()


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.01, "are the most similar: driven as in these runs they take less than 0.1 s"),
        (0.52, "are the most similar: driven as in these runs they take about 0.5 s"),
        (40.0, "differ little: driven as in these runs they take about 40 s"),
        (1e9, "differ little: driven as in these runs they take for ever"),
    ],
)
def test_the_time_to_tell_two_modes_apart_is_said(capsys, seconds, words):
    _print_alike((Pair(("ice", "sand"), seconds),))
    assert capsys.readouterr().out == f"ice and sand {words} to be distinguished.\n"
