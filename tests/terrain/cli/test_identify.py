"""`identify`: from run folders to a parameter set, or a refusal that says why."""

import re
import shutil
import sys

import numpy as np
import pytest

from odometry.parameters import read_parameters
from terrain.cli.main import main

SHORT = ("--horizon", "0.5", "--starts", "1")
TRUTH = {"y_left": 0.26, "y_right": -0.24, "x_icr": 0.03, "alpha_left": 1.0, "alpha_right": 1.0}


@pytest.fixture
def command(monkeypatch, capsys, tmp_path):
    """Run the verb as a user would: its exit code, output and messages; the file to write."""
    out = tmp_path / "set.toml"

    def run(*arguments, model="icr"):
        texts = ["identify", "--model", model, "--out", str(out), *map(str, arguments)]
        monkeypatch.setattr(sys, "argv", ["terrain-odometry", *texts])
        with pytest.raises(SystemExit) as caught:
            main()
        output, messages = capsys.readouterr()
        return caught.value.code, output, messages

    run.out = out
    return run


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
    code, output, _ = command(curvy_run, "--horizon", "6", "--starts", "1", model="icr_symmetric")
    assert code == 0
    assert "No held-out error" in output
    assert "held out, by" not in output


def test_speeds_a_third_of_the_true_are_refused_with_the_reason(command, curvy_run, tmp_path):
    slow = shutil.copytree(curvy_run, tmp_path / "slow")
    header, *lines = (slow / "odometry.csv").read_text().splitlines()
    names = header.split(",")
    rows = [dict(zip(names, line.split(","), strict=True)) for line in lines]
    for row in rows:
        row |= {name: str(float(row[name]) / 3) for name in ("v_left", "v_right")}
    text = "\n".join([header, *(",".join(row.values()) for row in rows)]) + "\n"
    (slow / "odometry.csv").write_text(text)
    answer = command(slow, "--horizon", "0.2", "--starts", "1", model="icr_symmetric")
    assert_refused(command, answer, "alpha ended at its bound 2", "another unit")


def test_a_refusal_says_what_the_check_warned_of(command, curvy_run, tmp_path):
    swapped = shutil.copytree(curvy_run, tmp_path / "swapped")
    text = (swapped / "odometry.csv").read_text()
    for old, new in (("v_left", "swap"), ("v_right", "v_left"), ("swap", "v_right")):
        text = text.replace(old, new)
    (swapped / "odometry.csv").write_text(text)
    answer = command(swapped, *SHORT)
    assert_refused(command, answer, "Mend first what the check warned of", "swapped")


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


def test_the_ground_can_be_named(command, curvy_run):
    code, output, _ = command(curvy_run, *SHORT, "--terrain", "wet grass")
    assert code == 0
    assert output.count("RUN --terrain 'wet grass' --") == 2  # to compare on, and to run
    assert list(read_parameters(command.out).terrains) == ["wet grass"]


def test_the_windows_are_those_that_were_asked_for(command, curvy_run):
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


def test_the_same_call_writes_the_same_bytes(command, curvy_run):
    contents = []
    for _ in range(2):
        command(curvy_run, *SHORT, "--seed", "3", "--loss", "linear")
        contents.append(command.out.read_bytes())
    assert contents[0] == contents[1]


def assert_refused(command, answer, *words, code=1):
    assert answer[0] == code, answer
    assert "Traceback" not in answer[2]
    for word in words:
        assert word in answer[2]
    assert not command.out.exists()


def test_a_straight_run_is_refused_with_names_and_nothing_is_written(command, across_run):
    answer = command(across_run, *SHORT)
    assert_refused(command, answer, "Error: ", "y_left", "y_right", "x_icr", "[ground]")


def test_a_refusal_begins_with_the_reason_and_ends_with_the_fit_in_a_line(command, across_run):
    _, output, messages = command(across_run, *SHORT)
    assert output == ""
    said = messages[messages.index("Error: ") :].rstrip().splitlines()
    assert said[0].startswith("Error: the runs cannot tell these parameters apart")
    place = said.index("Nothing is written. The fit that is refused:")
    assert re.match(
        r"  \[ground\] icr, \d+ windows, residuals .*y_left = .* \(open\)", said[place + 1]
    )
    assert len(said[place:]) <= 3


def test_windows_that_are_shorter_than_asked_are_explained(command, curvy_run, tmp_path):
    """Poses that were chained over half a second each."""
    chained = shutil.copytree(curvy_run, tmp_path / "chained")
    header, *lines = (chained / "pose.csv").read_text().splitlines()
    rows = [f"{line},{int(2 * float(line.split(',')[0]))}" for line in lines]
    (chained / "pose.csv").write_text("\n".join([f"{header},window", *rows]) + "\n")
    code, _, messages = command(chained, "--starts", "1")
    assert code == 0
    assert "windows are shorter than the 2 m asked for (0." in messages
    assert "`window` of pose.csv changes that often" in messages


def test_a_refusal_leaves_an_earlier_file_alone(command, across_run):
    command.out.write_text("earlier")
    assert command(across_run, *SHORT)[0] == 1
    assert command.out.read_text() == "earlier"


def test_robots_of_different_width_are_refused(command, curvy_run, tmp_path):
    other = shutil.copytree(curvy_run, tmp_path / "other")
    settings = (other / "run.toml").read_text().replace("track_width = 0.3", "track_width = 0.4")
    (other / "run.toml").write_text(settings)
    answer = command(curvy_run, other, *SHORT)
    assert_refused(command, answer, str(curvy_run), str(other), "0.3", "0.4")


def test_a_run_without_poses_is_refused(command, curvy_run, tmp_path):
    blind = shutil.copytree(curvy_run, tmp_path / "blind")
    (blind / "pose.csv").unlink()
    assert_refused(command, command(curvy_run, blind, *SHORT), str(blind), "pose.csv")


def test_a_missing_run_is_refused(command, tmp_path):
    answer = command(tmp_path / "absent")
    assert_refused(command, answer, "absent: there is no such folder")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--fix", "mu=0.5"), ("'mu' is no parameter of 'icr'",)),
        (("--free", "mu"), ("'mu' is no parameter of 'icr'",)),
        (("--fix", "alpha_left=3"), ("alpha_left = 3.0",)),
        (("--horizon", "-1"), ("horizon_m = -1.0",)),
        (("--stride", "0"), ("stride = 0.0",)),
        (("--position-sigma", "nan"), ("position_sigma_m = nan",)),
        (("--horizon", "500"), ("no window of 500 m", "choose a shorter horizon")),
    ],
)
def test_what_cannot_be_done_is_one_message_and_exit_code_1(command, curvy_run, options, words):
    assert_refused(command, command(curvy_run, *options), "Error: ", *words)


def test_an_unknown_model_is_told_with_the_known_ones(command, curvy_run):
    answer = command(curvy_run, model="icrs")
    assert_refused(command, answer, "'icrs'", "did you mean icr?", "icr_symmetric", code=2)


@pytest.mark.parametrize(
    "options",
    [
        ("--fix", "mu"),
        ("--fix", "mu=much"),
        ("--loss", "cauchy"),
        ("--starts", "0"),
        ("--seed", "-1"),
    ],
)
def test_a_call_that_makes_no_sense_is_a_usage_error(command, curvy_run, options):
    assert_refused(command, command(curvy_run, *options), code=2)


def test_no_run_is_a_usage_error(command):
    assert_refused(command, command(), "RUN", code=2)


def test_the_reserved_name_is_no_ground(command, curvy_run):
    assert_refused(command, command(curvy_run, *SHORT, "--terrain", "unknown"), "unknown")


def test_infinity_is_no_value(command, curvy_run):
    assert_refused(command, command(curvy_run, *SHORT, "--fix", "x_icr=inf"), "x_icr = inf")


def test_a_file_that_cannot_be_written_is_one_message(command, curvy_run, tmp_path):
    (tmp_path / "file").write_text("")
    answer = command(curvy_run, *SHORT, "--out", tmp_path / "file" / "set.toml")
    assert_refused(command, answer, "Error: ", "file")


def test_a_picture_is_drawn_where_asked_and_part_of_no_identity(command, curvy_run, tmp_path):
    picture = tmp_path / "icrs.png"
    assert command(curvy_run, *SHORT)[0] == 0
    without = command.out.read_bytes()
    for _ in range(2):
        code, output, _ = command(curvy_run, *SHORT, "--picture", picture)
        assert code == 0
        assert f"Wrote {picture}" in output
    assert command.out.read_bytes() == without
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("name", "code"), [("photo.png", 1), ("photo.jpg", 2)])
def test_a_picture_that_cannot_be_written_is_refused_first(
    command, curvy_run, tmp_path, name, code
):
    (tmp_path / name).write_bytes(b"a photograph")
    found, _, messages = command(curvy_run, *SHORT, "--picture", tmp_path / name)
    assert found == code
    assert name in messages
    assert not command.out.exists()
    assert (tmp_path / name).read_bytes() == b"a photograph"


def test_positions_without_yaw_are_enough(command, curvy_run, tmp_path):
    """The yaw column emptied: what was done instead is said, and what positions cannot tell."""
    bare = shutil.copytree(curvy_run, tmp_path / "gnss")
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
    assert "times the noise found of positions" in output
    assert "Note: positions without yaw: " in messages
    assert "Note: [sensors] pose is not stated" in messages
