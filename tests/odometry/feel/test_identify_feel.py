from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import ConfigError, IdentificationError, OdometryError, RunFolderError
from odometry.feel.identify_feel import identify_feel
from odometry.feel.labels.felt import NOT_MEASURED, STATIONARY
from odometry.feel.labels.files import is_unlike, sentences
from odometry.feel.labels.follow import follow_feel
from odometry.recording.run import UNKNOWN
from tests.odometry.feel.feel_drives import drive, drives, with_imu

NAMES = ["tiles", "gravel", "snow"]


def right_share(model, runs):
    found = [follow_feel(run, model) for run in runs]
    return np.mean([(one.answers == one.run.terrain).mean() for one in found])


@pytest.mark.slow
def test_made_terrains_are_recognised_on_runs_held_out(model):
    assert model.names == tuple(sorted(NAMES))
    for length in ("window", "stretch", "run"):
        assert model.report[length]["balanced_accuracy"] > 0.95
    assert model.report["window"]["refused"] < 0.2
    assert right_share(model, [drive(name, 900 + i) for i, name in enumerate(NAMES)]) > 0.8


@pytest.mark.slow
def test_terrains_that_are_one_cannot_be_distinguished():
    runs = drives(["gravel"], count=12)
    named = [
        replace(run, settings={**run.settings, "run": {"terrain": NAMES[i % 3]}})
        for i, run in enumerate(runs)
    ]
    model = identify_feel(named)
    assert model.report["run"]["balanced_accuracy"] < 0.75
    low, high = model.report["window"]["interval"]
    assert low < 0.45
    assert high < 0.75
    felt = follow_feel(drive("gravel", 77), model)
    assert felt.probabilities.max() < 0.9


@pytest.mark.slow
def test_speed_is_not_the_label():
    """Trained slowly, judged fast: what grows with speed is taken out."""
    slow = [
        drive(name, 10 * i + j, speed=speed)
        for i, name in enumerate(NAMES)
        for j, speed in enumerate((0.15, 0.2, 0.3))
    ]
    model = identify_feel(slow)
    fast = [drive(name, 500 + i, speed=0.35) for i, name in enumerate(NAMES)]
    assert right_share(model, fast) > 0.7
    assert model.report["window_by_groups"]["speed alone"] < 0.6


def test_speeds_that_were_never_driven_are_unknown(model):
    felt = follow_feel(drive("tiles", 600, speed=2.5), model)
    assert felt.outside_speeds.all()
    assert set(felt.answers) == {UNKNOWN}
    assert any("speeds that the model does not know" in line for line in sentences(felt))


@pytest.mark.slow
def test_terrains_that_were_driven_at_their_own_speed_are_said():
    runs = drives(["tiles"], 3, speed=0.2) + drives(["gravel"], 3, speed=0.8)
    notes = identify_feel(runs).report["notes"]
    assert any("may be the speed" in note for note in notes)


def test_a_terrain_never_felt_is_unknown(model):
    felt = follow_feel(drive("grates", 700), model)
    assert (felt.answers == UNKNOWN).mean() > 0.9
    assert felt.answer_of_run[0] == UNKNOWN
    assert is_unlike(felt)
    assert any("nothing that the model" in line for line in sentences(felt))


def test_a_run_that_is_mostly_unknown_is_of_no_terrain_of_the_model(model):
    """Where its mean alone still lies near one: probabilities of the run are those of before."""
    felt = follow_feel(drive("gravel", 701), model)
    assert felt.answer_of_run[0] == "gravel"
    doubtful = replace(felt)
    answers = felt.lasting_answers.copy()
    answers[: int(0.6 * len(answers))] = UNKNOWN
    doubtful.__dict__["lasting_answers"] = answers
    assert doubtful.answer_of_run[0] == UNKNOWN
    assert not any("If it is all one terrain" in line for line in sentences(doubtful))


@pytest.mark.parametrize("factor", [10.0, 0.1])
def test_another_sensor_or_suspension_is_unknown(model, factor):
    def shaken(columns):
        for name in columns:
            if name.startswith("accel"):
                mean = columns[name].mean()
                columns[name] = mean + factor * (columns[name] - mean)
        return columns

    felt = follow_feel(with_imu(drive("gravel", 800), shaken), model)
    assert (felt.answers == UNKNOWN).mean() > 0.9


def test_another_robot_is_refused(model):
    run = drive("gravel", 801)
    other = replace(run, robot=replace(run.robot, track_width=1.2))
    with pytest.raises(RunFolderError, match="track width"):
        follow_feel(other, model)


def test_a_faster_recording_will_do_and_a_slower_one_is_refused(model):
    assert right_share(model, [drive(name, 810, rate_hz=200.0) for name in NAMES]) > 0.7
    with pytest.raises(RunFolderError, match="recorded at 50 Hz"):
        follow_feel(drive("gravel", 811, rate_hz=50.0), model)


@pytest.mark.slow
def test_a_run_without_a_column_of_the_model_is_refused_and_a_model_without_it_serves(model):
    def without(columns):
        return columns | {"accel_x": np.full(len(columns["t"]), np.nan)}

    with pytest.raises(RunFolderError, match=r"no accel_x .* the model needs"):
        follow_feel(with_imu(drive("gravel", 820), without), model)
    runs = drives(NAMES, count=3)
    runs[0] = with_imu(runs[0], without)
    smaller = identify_feel(runs)
    assert "accel_x" not in smaller.design.columns
    assert any(note.startswith("accel_x is not used") for note in smaller.report["notes"])
    follow_feel(with_imu(drive("gravel", 820), without), smaller)


def test_standing_and_gaps_say_nothing(model):
    felt = follow_feel(drive("gravel", 830, speed=0.0, turning=0.0), model)
    assert set(felt.answers) == set(felt.lasting_answers) == {STATIONARY}
    np.testing.assert_allclose(felt.probabilities, 0.9 / 3)
    np.testing.assert_allclose(felt.unknown, 0.1)

    def with_gap(columns):
        keep = (columns["t"] < 10.0) | (columns["t"] > 20.0)
        return {name: of[keep] for name, of in columns.items()}

    felt = follow_feel(with_imu(drive("gravel", 831), with_gap), model)
    assert (felt.answers == NOT_MEASURED).any()


def test_what_is_no_ground_for_a_model_is_refused():
    with pytest.raises(IdentificationError, match="two terrains"):
        identify_feel(drives(["gravel"]))
    with pytest.raises(IdentificationError, match="snow: 1 run of 5"):
        identify_feel([*drives(["gravel"]), drive("snow", 1)])
    with pytest.raises(ConfigError, match="window_s = 7"):
        identify_feel(drives(NAMES), window_s=7.0)
    with pytest.raises(IdentificationError, match="0 windows"):
        identify_feel(drives(NAMES, speed=0.0, turning=0.0, seconds=5.0))
    named = replace(drive("snow", 2), settings={"robot": {"track_width": 0.5}})
    with pytest.raises(OdometryError, match="of gravel"):
        identify_feel([*drives(["gravel"]), named])


@pytest.mark.slow
def test_the_length_of_windows_is_chosen_of_those_given():
    model = identify_feel(drives(["tiles", "gravel"], count=3), window_s=(1.0, 2.0))
    assert model.design.window_s in (1.0, 2.0)
    assert model.report["chosen"].startswith(f"windows of {model.design.window_s:g} s")
    assert len(model.report["chosen_in_folds"]) == 5
