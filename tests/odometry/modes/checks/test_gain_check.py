"""Gains that are off: runs whose gain is given, of modes whose spread is written out by hand."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.checks.gain_check import GainCheck, gain_check
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.track import follow_modes
from odometry.modes.identify.held_out_gains import CLIP_RAD_S
from odometry.modes.models.mode_set import UNDETERMINED
from odometry.modes.models.mode_set_file import read_mode_set, write_mode_set
from odometry.modes.show.gain_words import gain_words
from tests.odometry.modes.mode_examples import run_of, track, traction_set

SIZE = 1500  # 30 s at 50 Hz
SPREAD, POWER = 0.02, 1e-4


def modes_of(spread=SPREAD, power=POWER, turns=(0.5, 0.8)):
    mode_set = traction_set(turns)
    return replace(
        mode_set, modes=replace(mode_set.modes, gain_spread=np.full(2, spread), gain_power=power)
    )


def checked(turn, mode_set=None, leading=0):
    """What is found of a run that turns by `turn` of what was requested while a mode leads."""
    modes = (mode_set or modes_of()).modes
    signals = modes.signals(run_of(turn, track_width=0.5, size=SIZE))
    rows = np.broadcast_to(leading, len(signals))
    return gain_check(signals, modes, rows, np.zeros(len(signals)))


def test_a_gain_within_its_spread_is_not_off():
    for turn in (0.5, 0.5 * 1.02, 0.5 * 0.98):
        assert not checked(turn).off.any()


@pytest.mark.parametrize("share", [-0.12, 0.12])
def test_a_gain_beyond_its_spread_is_off_by_what_it_is(share):
    found = checked(0.5 * (1 + share))
    assert found.off[SIZE // 2 :].all()
    assert np.nanmedian(found.excess) == pytest.approx(share, abs=0.01)


def test_a_mode_that_differs_more_from_turn_to_turn_may_be_off_by_more():
    assert checked(0.56).off.any()
    assert not checked(0.56, modes_of(spread=0.3)).off.any()
    assert not checked(0.56, modes_of(power=0.1)).off.any()


def test_what_another_mode_left_says_nothing_of_the_leading_one():
    half = np.arange(SIZE) >= SIZE // 2
    turns = np.where(half, 0.8, 0.5)
    modes = modes_of().modes
    signals = modes.signals(run_of(turns, track_width=0.5, size=SIZE))
    leading = (signals.stamps_s >= signals.stamps_s[0] + 0.02 * (SIZE // 2)).astype(int)
    found = gain_check(signals, modes, leading, np.zeros(len(signals)))
    assert not found.off.any()


def test_a_spike_is_no_turn():
    modes = modes_of().modes
    signals = modes.signals(run_of(0.5, track_width=0.5, size=SIZE))
    signals.measured[::200, -1] += 100 * CLIP_RAD_S
    assert not gain_check(signals, modes, np.zeros(SIZE, dtype=int), np.zeros(SIZE)).off.any()


def test_a_set_without_a_spread_has_no_such_test():
    assert checked(0.6, traction_set()) is None


@pytest.mark.slow
def test_a_terrain_beside_a_mode_is_not_named():
    found = follow_modes(run_of(0.55, track_width=0.5, size=SIZE), modes_of())
    alone = replace(found, fit=None, between=None, contradicted=None, gyroscope=None)
    without = named_modes(replace(alone, gain=None), 0.9)
    off = found.gain.off
    assert (without[off] == "none").mean() > 0.9
    assert set(named_modes(alone, 0.9)[off]) == {UNDETERMINED}


@pytest.mark.parametrize(
    ("excess", "words"),
    [
        (0.1, "10 % more than on b, 0.5 of the way to c"),
        (-0.3, "30 % less than on b, beyond a"),
        (0.4, "40 % more than on b, beyond c"),
    ],
)
def test_words_say_between_which_modes_the_turns_lie(excess, words):
    known = replace(track(["b"] * 4, ["unknown"] * 4), between=object())
    rows = np.ones(4, dtype=bool)
    gain = GainCheck(rows, np.full(4, excess))
    gains = np.array([0.8, 1.0, 1.2])
    assert gain_words(known, gain, gains, rows) == words
    assert gain_words(replace(known, between=None), gain, gains, rows) == words.split(",")[0]
    beyond = gain_words(known, gain, np.array([1.0, 1.0, 1.0]), rows)
    assert beyond.endswith("on b, beyond all modes")


def test_a_set_keeps_its_spread(tmp_path):
    mode_set = modes_of()
    write_mode_set(tmp_path / "set.toml", mode_set)
    again = read_mode_set(tmp_path / "set.toml").modes
    np.testing.assert_array_equal(again.gain_spread, mode_set.modes.gain_spread)
    assert again.gain_power == POWER
    write_mode_set(tmp_path / "old.toml", traction_set())
    assert read_mode_set(tmp_path / "old.toml").modes.gain_spread is None
