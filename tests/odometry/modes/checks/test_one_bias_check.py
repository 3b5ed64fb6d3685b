"""One bias over a minute: slow turns to both sides, signals whose gain and bias are given."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.checks.one_bias_check import BEFORE_S, LEAST_WAY, WINDOW_S, one_bias_check
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.track import follow_signals
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals
from tests.odometry.modes.mode_examples import velocity_set

STEP_S, SIZE = 0.1, 2000
STAMPS_S = STEP_S * np.arange(SIZE)
GAIN, OTHER = 1.0, 1.4
TURN_RAD_S, TURN_S = 0.04, 15.0  # to each side in turn: slow, and longer than filters wait
SIDES = np.where(STAMPS_S % (2 * TURN_S) < TURN_S, 1.0, -1.0)
BOTH = STAMPS_S > TURN_S + 3.0  # both sides lie in the window


def set_of(turns=(GAIN, OTHER), spread=0.0, sigma=0.004):
    mode_set = velocity_set(turns, sigma=sigma)
    errors = {"errors_last_s": 0.3, "gain_spread": np.full(len(turns), spread)}
    return replace(mode_set, modes=replace(mode_set.modes, **errors))


def signals_of(gain, sides=SIDES, bias_rad_s=0.0):
    """The yaw rate of a gain, as share of the first mode's, with a constant bias."""
    half = TURN_RAD_S / 2 / GAIN * sides
    measured = np.column_stack([np.full(SIZE, np.nan), 2 * half * gain + bias_rad_s])
    speeds = np.column_stack([0.1 - half, 0.1 + half])
    return Signals(STAMPS_S, speeds, measured, np.full(SIZE, "unknown", dtype=object))


def checked(signals, mode_set=None, *, leading=0, bias_rad_s=0.0, sigma_rad_s=5e-4):
    modes, rows = (mode_set or set_of()).modes, np.broadcast_to(leading, SIZE)
    of_filters = (np.broadcast_to(of, SIZE) for of in (bias_rad_s, sigma_rad_s))
    return one_bias_check(signals, modes, rows, (*of_filters, STEP_S / 0.3))


@pytest.mark.parametrize("share", [-0.12, 0.12])
def test_a_gain_that_is_off_is_no_bias_that_changes_with_the_turn(share):
    follows = TURN_RAD_S * share * SIDES  # the bias that explains each turn
    assert checked(signals_of(GAIN + share), bias_rad_s=follows)[BOTH].all()
    assert not checked(signals_of(GAIN + share / 6), bias_rad_s=follows / 6).any()


def test_turns_to_one_side_may_be_those_of_a_bias_that_is_not_known():
    circle = signals_of(GAIN - 0.12, np.ones(SIZE))
    assert not checked(circle, sigma_rad_s=0.005).any()
    both = signals_of(GAIN - 0.12)
    assert checked(both, sigma_rad_s=0.005)[BOTH].all()


def test_a_bias_that_was_known_before_does_not_go_away_on_a_circle():
    circle = signals_of(GAIN - 0.14, np.ones(SIZE))
    goes = -0.14 * TURN_RAD_S * np.clip((STAMPS_S - 30.0) / 30.0, 0.0, 1.0)
    off = checked(circle, bias_rad_s=goes)
    assert off[(STAMPS_S > 40.0) & (STAMPS_S < BEFORE_S + 30.0)].all()
    assert not off[STAMPS_S > BEFORE_S + 60.0].any()  # what is believed since then


def test_a_constant_bias_is_no_gain():
    assert not checked(signals_of(GAIN, bias_rad_s=0.004)).any()
    assert not checked(signals_of(GAIN, bias_rad_s=0.03), bias_rad_s=0.03).any()


def test_what_is_near_the_mode_by_the_way_to_the_next_one_contradicts_nothing():
    far = set_of((GAIN, GAIN + 0.12 / LEAST_WAY + 0.2))
    assert not checked(signals_of(GAIN + 0.12), far).any()
    assert checked(signals_of(GAIN + 0.12), set_of((GAIN, GAIN + 0.12 / LEAST_WAY - 0.2))).any()


def test_a_mode_whose_turns_differ_more_may_be_off_by_more():
    assert not checked(signals_of(GAIN + 0.12), set_of(spread=0.1)).any()


def test_what_was_measured_while_another_mode_led_says_nothing():
    changes_s = 100.0
    gains = np.where(changes_s > STAMPS_S, OTHER, GAIN)
    leading = np.where(changes_s > STAMPS_S, 1, 0)
    assert not checked(signals_of(gains), leading=leading).any()
    assert checked(signals_of(gains))[(changes_s < STAMPS_S) & (changes_s + 40.0 > STAMPS_S)].all()


def test_a_minute_later_it_is_forgotten():
    changes_s = 100.0
    off = checked(signals_of(np.where(changes_s > STAMPS_S, GAIN + 0.12, GAIN)))
    assert off[BOTH & (changes_s > STAMPS_S)].all()
    assert not off[changes_s + WINDOW_S + STEP_S < STAMPS_S].any()


def test_spikes_are_no_gain():
    """Two in a hundred, each a thousand times the turn."""
    bias = 0.03  # farther from 0 than an error may be
    signals = signals_of(GAIN, bias_rad_s=bias)
    signals.measured[SIDES > 0, -1] += np.where(np.arange(np.sum(SIDES > 0)) % 50 == 0, 40.0, 0.0)
    assert not checked(signals, bias_rad_s=bias)[BOTH].any()


def test_a_slow_robot_has_no_name_on_a_terrain_beside_the_mode():
    """The filters follow a bias from turn to turn, and are sure of the nearest mode."""
    signals = signals_of(GAIN - 0.13)
    signals.measured[:, -1] += np.random.default_rng(3).normal(0, 0.004, SIZE)
    answers = [
        named_modes(follow_signals(signals, set_of(), ModesConfig(one_bias_sigmas=sigmas)), 0.9)
        for sigmas in (1e6, ModesConfig.one_bias_sigmas)
    ]
    late = 2 * TURN_S < STAMPS_S
    without, with_it = (np.mean(of[late] == "ice") for of in answers)
    assert without > 0.3
    assert with_it < 0.02
