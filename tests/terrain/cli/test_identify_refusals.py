"""`identify` where there is no answer: one message that says why, and no file."""

import re
import shutil

import pytest

from tests.terrain.cli.identify_calls import SHORT, assert_refused


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
    assert_refused(command, answer, "First correct what the check warned of", "swapped")


def test_a_straight_run_is_refused_with_names_and_nothing_is_written(command, across_run):
    answer = command(across_run, *SHORT)
    assert_refused(command, answer, "Error: ", "y_left", "y_right", "x_icr", "[ground]")


def test_a_refusal_begins_with_the_reason_and_ends_with_the_fit_in_a_line(command, across_run):
    _, output, messages = command(across_run, *SHORT)
    assert output == ""
    said = messages[messages.index("Error: ") :].rstrip().splitlines()
    assert said[0].startswith("Error: the runs do not determine these parameters")
    place = said.index("Nothing is written. The fit that is refused:")
    assert re.match(
        r"  \[ground\] icr, \d+ windows, residuals .*y_left = .* \(open\)", said[place + 1]
    )
    assert len(said[place:]) <= 3


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


def test_an_unknown_model_is_reported_with_the_known_ones(command, curvy_run):
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
