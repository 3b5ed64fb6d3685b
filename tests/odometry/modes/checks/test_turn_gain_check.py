"""Gains of the last turns: signals whose gain is given, of modes whose spread is written here."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.checks.turn_gain_check import turn_gain_check
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.track import follow_signals
from odometry.modes.identify.held_out_turns import TURNED_S
from odometry.modes.models.mode_set import UNDETERMINED
from odometry.modes.models.mode_set_file import read_mode_set, write_mode_set
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals
from tests.odometry.modes.mode_examples import velocity_set

STEP_S, SIZE = 0.02, 1500
STAMPS_S = STEP_S * np.arange(SIZE)
SPREAD, POWER = 0.02, 1e-5
TURN_S = 10.0  # and straight on from there
GAIN, OTHER = 1.0, 1.25


def set_of(spread=SPREAD, power=POWER, turns=(GAIN, OTHER)):
    # errors that last: filters alone are not sure of a mode that is off by little
    both = {
        "errors_last_s": 0.5,
        "turn_spread": np.full((2, 2), spread),
        "turn_power": np.full((2, 2), power),
    }
    mode_set = velocity_set(turns)
    return replace(mode_set, modes=replace(mode_set.modes, **both))


def signals_of(gain, side=1.0):
    """Turns to a side (N,) at so much (N,) per difference of the treads, then a straight."""
    half = np.where(STAMPS_S < TURN_S, 0.3 * side, 0.0)
    measured = np.column_stack([np.full(SIZE, np.nan), gain * 2 * half])
    speeds = np.column_stack([0.5 - half, 0.5 + half])
    return Signals(STAMPS_S, speeds, measured, np.full(SIZE, "unknown", dtype=object))


def checked(gain, mode_set=None, leading=0, signals=None):
    modes = (mode_set or set_of()).modes
    rows = np.broadcast_to(leading, SIZE)
    return turn_gain_check(signals or signals_of(gain), modes, rows, np.zeros(SIZE))


@pytest.mark.parametrize("every", [2, 5])
def test_a_gyroscope_that_is_slower_than_the_treads_measures_as_well(every):
    signals = signals_of(GAIN * 1.1)
    rates = np.where(np.arange(SIZE) % every == 0, signals.measured[:, 1], np.nan)
    measured = np.column_stack([signals.measured[:, 0], rates])
    off = checked(GAIN, signals=replace(signals, measured=measured))
    assert off[STAMPS_S > 2.0].all()


@pytest.mark.parametrize("share", [-0.1, 0.1])
def test_a_turn_beside_the_mode_contradicts_it_on_the_straight_after_it(share):
    assert checked(GAIN * (1 + share))[STAMPS_S > 1.0].all()
    assert not checked(GAIN * (1 + share / 5)).any()


def test_a_mode_whose_turns_differ_more_may_be_off_by_more():
    assert not checked(GAIN * 1.1, set_of(spread=0.1)).any()
    assert not checked(GAIN * 1.1, set_of(power=0.02)).any()


def test_what_is_near_a_mode_by_the_way_to_the_next_one_contradicts_nothing():
    off_by = 0.08
    assert checked(GAIN * (1 + off_by), set_of(turns=(GAIN, GAIN * (1 + 3 * off_by)))).any()
    assert not checked(GAIN * (1 + off_by), set_of(turns=(GAIN, GAIN * (1 + 4 * off_by)))).any()
    less = set_of(turns=(GAIN, GAIN * (1 - 4 * off_by)))  # beyond all modes: as far as to the next
    assert not checked(GAIN * (1 + off_by), less).any()


def test_a_mode_that_is_equal_in_motion_is_no_next_one():
    assert checked(GAIN * 1.1, set_of(turns=(GAIN, GAIN * 1.05))).any()
    assert not checked(GAIN * 1.1, set_of(turns=(GAIN, GAIN * 1.01))).any()


def test_a_bias_of_the_gyroscope_is_no_gain():
    """It is a twelfth of a slow turn."""
    slow = signals_of(GAIN, side=0.09)
    slow.measured[:, -1] += 0.0042
    assert not checked(GAIN, signals=slow).any()
    slow.measured[:, -1] += 0.02
    assert checked(GAIN, signals=slow).any()


def test_the_bias_that_the_filters_know_is_taken_off():
    biased = signals_of(GAIN)
    biased.measured[:, -1] += 0.2
    modes, rows = set_of().modes, np.zeros(SIZE, dtype=int)
    assert turn_gain_check(biased, modes, rows, np.zeros(SIZE)).any()
    assert not turn_gain_check(biased, modes, rows, np.full(SIZE, 0.2)).any()


def test_one_sample_far_off_is_no_gain():
    spiked = signals_of(GAIN)
    spiked.measured[100::200, -1] += 20.0
    assert not checked(GAIN, signals=spiked).any()


def test_a_later_turn_takes_back_what_an_earlier_one_contradicted():
    """After the shorter window of turning, if another mode led in the earlier one."""
    changes_s = TURN_S - TURNED_S[0] - 0.5
    gains = np.where(changes_s > STAMPS_S, OTHER, GAIN)
    leading = np.where(changes_s > STAMPS_S, 1, 0)
    off = checked(gains, leading=leading)
    assert off[(changes_s + 0.1 < STAMPS_S) & (changes_s + 1.0 > STAMPS_S)].all()
    assert not off[STAMPS_S > TURN_S].any()
    assert checked(gains)[STAMPS_S > TURN_S].all()  # where the mode led all the time


def test_what_is_measured_after_lost_rows_says_nothing():
    """The treads held a straight until then; the robot turned already."""
    kept = np.ones(SIZE, dtype=bool)
    kept[200:230] = False
    signals = signals_of(GAIN)
    signals.measured[230:250, -1] *= 3.0
    lost = Signals(
        STAMPS_S[kept], signals.tread_speeds_m_s[kept], signals.measured[kept], signals.labels[kept]
    )
    rows = np.zeros(int(kept.sum()), dtype=int)
    assert not turn_gain_check(lost, set_of().modes, rows, np.zeros(len(rows))).any()
    assert checked(GAIN, signals=signals).any()


def test_a_terrain_between_two_modes_is_not_named_after_its_turn():
    both_sides = np.where(STAMPS_S.astype(int) % 2, 1.0, -1.0)  # a bias does not explain it
    between = signals_of(GAIN * 1.1, both_sides)
    noise = np.random.default_rng(4).normal(0, 0.02, SIZE)
    between.measured[:, 1] += noise
    others = ("between_sigmas", "turn_sigmas", "long_sigmas", "one_bias_sigmas")
    config = ModesConfig(**dict.fromkeys(others, 100.0))
    found, without = (
        follow_signals(between, set_of(spread), config) for spread in (SPREAD, 10 * SPREAD)
    )
    after = (STAMPS_S > TURN_S) & (STAMPS_S < TURN_S + 2.0)
    assert set(named_modes(without, 0.9)[after]) == {"ice"}
    assert found.turns_are_off[after].all()
    assert set(named_modes(found, 0.9)[after]) == {UNDETERMINED}


def test_a_set_keeps_its_spread_and_an_earlier_one_has_no_such_test(tmp_path):
    write_mode_set(tmp_path / "set.toml", set_of())
    again = read_mode_set(tmp_path / "set.toml").modes
    np.testing.assert_array_equal(again.turn_spread, np.full((2, 2), SPREAD))
    np.testing.assert_array_equal(again.turn_power, np.full((2, 2), POWER))
    write_mode_set(tmp_path / "old.toml", velocity_set((GAIN, OTHER)))
    old = read_mode_set(tmp_path / "old.toml")
    assert checked(GAIN * 1.3, old) is None
