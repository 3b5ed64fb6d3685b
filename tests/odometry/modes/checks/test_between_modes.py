"""Turns between two modes: runs whose gain is given, and a share written out by hand."""

import csv

import numpy as np
import pytest

from odometry.modes.checks.between_modes import WINDOW_S, between_modes
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.followed import followed
from odometry.modes.follow.track import follow_modes
from odometry.modes.models.mode_set import NONE_OF_THESE
from odometry.modes.models.traction import LEFT_TURN
from odometry.modes.show.doubts import doubts
from odometry.modes.show.files import write_modes
from tests.odometry.modes.mode_examples import run_of, traction_set, velocity_set

SIZE = 2500  # 50 s at 50 Hz
AFTER = round(WINDOW_S / 0.02)


def of_turns(turns, modes=(1.0, 1.3, 1.6), biases=0.0):
    """What is found of runs that turn by `turns` per difference of speeds."""
    names = ("ice", "tar", "mud")[: len(modes)]
    mode_set = velocity_set(modes, names)
    run = run_of(turns, size=SIZE)
    signals = mode_set.modes.signals(run)
    return between_modes(signals, mode_set.modes, np.full(SIZE, biases), 1.0)


@pytest.mark.parametrize(
    ("turn", "pair", "share"),
    [(1.15, ("ice", "tar"), 0.5), (1.39, ("tar", "mud"), 0.3), (1.54, ("tar", "mud"), 0.8)],
)
def test_a_turn_between_two_modes_is_measured(turn, pair, share):
    found = of_turns(turn)
    assert found.holds[AFTER:].mean() > 0.95
    assert {found.pairs[place] for place in found.place[found.holds]} == {pair}
    assert np.median(found.share[found.holds]) == pytest.approx(share, abs=0.08)


@pytest.mark.parametrize("turn", [0.7, 1.0, 1.3, 1.6, 2.2])
def test_a_mode_and_what_is_beyond_all_modes_is_between_none(turn):
    assert not of_turns(turn).holds.any()


@pytest.mark.parametrize("change", [0.3, 0.5, 0.7])
@pytest.mark.parametrize("after", [1.3, 1.6])
def test_a_change_from_one_mode_to_another_is_between_none(change, after):
    turns = np.where(np.arange(SIZE) < change * SIZE, 1.0, after)
    assert not of_turns(turns).holds.any()


def test_terrains_that_last_for_some_seconds_are_taken_less_often_for_one_between():
    turns = np.where(np.arange(SIZE) // 300 % 2 == 0, 0.5, 0.8)  # 6 s of each
    often = of_traction(turns, traction_set((0.5, 0.8)).modes).holds.mean()
    rarely = of_traction(turns, traction_set((0.5, 0.8)).modes, stay_s=4.0).holds.mean()
    assert rarely < often / 2
    assert of_traction(0.65, traction_set((0.5, 0.8)).modes, stay_s=4.0).holds[AFTER:].mean() > 0.95


def test_a_bias_that_is_believed_is_taken_out():
    run_off = of_turns(1.0, biases=0.002)
    assert not run_off.holds.any()


def test_one_mode_has_no_neighbour():
    assert of_turns(1.0, modes=(1.0,)) is None


def of_traction(turn, modes, **settings):
    run = run_of(turn, track_width=0.5, size=SIZE)
    return between_modes(modes.signals(run), modes, np.zeros(SIZE), 1.0, **settings)


@pytest.mark.parametrize(("turn", "between"), [(0.5, False), (0.65, True), (0.8, False)])
def test_traction_modes_have_turns_between_them_too(turn, between):
    found = of_traction(turn, traction_set((0.5, 0.8)).modes)
    assert found.holds[AFTER:].mean() == pytest.approx(float(between), abs=0.05)


def test_wheels_that_turn_more_to_one_side_and_less_to_the_other_are_next_to_none():
    modes = traction_set((0.5, 0.8)).modes
    modes.gains[1, LEFT_TURN, 2, 3] = -2.0  # what makes wide turns differ from those on the spot
    assert of_traction(0.65, modes) is None


def test_the_answer_between_two_modes_is_none_of_these():
    mode_set = velocity_set((1.0, 1.3), sigma=0.1)
    track = follow_modes(run_of(1.15, size=SIZE), mode_set)
    assert track.between.holds[AFTER:].mean() > 0.9
    answers = named_modes(track, 0.9)
    assert set(answers[track.between.holds]) == {NONE_OF_THESE}


def test_the_two_modes_are_said_with_when_and_how_far_between(tmp_path):
    made = followed(run_of(1.15, size=SIZE), velocity_set((1.0, 1.3), sigma=0.1))
    (first, *_) = doubts(made)
    assert first.reason.startswith("the robot turns by more than ice and by less than tar, 0.5 of ")
    assert first.share == pytest.approx(made.motion.between.holds.mean(), abs=0.01)
    write_modes(made, tmp_path)
    rows = list(csv.DictReader((tmp_path / "modes.csv").read_text().splitlines()))
    last = rows[-1]
    assert (last["answer"], last["between"]) == (NONE_OF_THESE, "ice and tar")
    assert float(last["between_share"]) == pytest.approx(0.5, abs=0.1)
    assert (rows[0]["between"], rows[0]["between_share"]) == ("", "")
