"""Turns that contradict a mode: innovations are drawn here, white or in proportion to the turn."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.checks.track_checks import (
    LEAST_RAD_S,
    WINDOWS_S,
    contradicted_lately,
    turn_sums,
    turns_are_off,
)
from odometry.modes.follow.answers import named_modes
from odometry.modes.models.innovation_test import Innovations, mode_fit
from odometry.modes.models.mode_set import UNDETERMINED
from odometry.modes.modes_config import ModesConfig
from odometry.windows.recorded.spans import within
from tests.odometry.modes.mode_examples import track

STEP_S, SIZE = 0.02, 1500
STAMPS_S = STEP_S * np.arange(SIZE)
WEAVING = 0.5 * np.sign(np.sin(2 * np.pi * STAMPS_S / 3.0 + 1e-6))  # 1.5 s to either side


def left_over(normalised, independent=1.0):
    """Of two modes, the first of which is in the lead."""
    both = np.stack([normalised, normalised + 50.0], axis=1)
    return Innovations(both[..., None], np.zeros(SIZE, dtype=int), STAMPS_S, independent)


def asked(rates):
    return np.column_stack([rates, 2 * rates])


def white(seed=5):
    return np.random.default_rng(seed).normal(size=SIZE)


def test_sums_are_those_written_out():
    innovations = white()
    sums = turn_sums(left_over(innovations), asked(WEAVING), 6.0)
    window = slice(1000 - 300 + 1, 1001)
    rates, clipped = WEAVING[window], np.clip(innovations[window], -3, 3)
    of_sides = [
        clipped[side * rates > 0].sum() * side / np.sqrt((side * rates > 0).sum())
        for side in (1, -1)
    ]
    np.testing.assert_allclose(sums[1000, :2], of_sides)
    assert sums[1000, 2] == pytest.approx(sum(of_sides) / np.sqrt(2))


def test_sums_have_unit_variance_where_the_mode_is_true():
    last = [turn_sums(left_over(white(seed)), asked(WEAVING), 6.0)[-1] for seed in range(300)]
    np.testing.assert_allclose(np.std(last, axis=0), 1.0, atol=0.12)


def test_errors_that_last_are_expected_to():
    """Each is held for half a second: 25 samples are worth one."""
    seeds = range(200)
    held = [white(seed)[np.arange(SIZE) // 25] for seed in seeds]
    last = [turn_sums(left_over(one, 0.04), asked(WEAVING), 6.0)[-1] for one in held]
    np.testing.assert_allclose(np.std(last, axis=0), 1.0, atol=0.2)


@pytest.mark.parametrize("share", [-0.3, 0.3])
def test_a_gain_that_is_off_shows_over_turns_to_both_sides_where_a_plain_sum_cancels(share):
    innovations = left_over(white() + share * np.sign(WEAVING))
    off = turns_are_off(innovations, asked(WEAVING))
    assert off[round(max(WINDOWS_S) / STEP_S) :].mean() > 0.95
    sums = turn_sums(innovations, asked(WEAVING), max(WINDOWS_S))
    assert np.sign(sums[-1]).tolist() == [np.sign(share)] * 3
    plain = mode_fit(innovations, np.array([20.0, 20.0]), 0.05).lasting
    assert np.nanmax(np.abs(plain[300:])) < ModesConfig.long_sigmas


def test_a_gain_to_one_side_alone_is_off():
    off = turns_are_off(left_over(white() + 0.5 * (WEAVING > 0)), asked(WEAVING))
    assert off[round(max(WINDOWS_S) / STEP_S) :].all()


def test_nothing_is_off_on_straights_nor_where_nothing_was_measured():
    straight = np.full(SIZE, 0.9 * LEAST_RAD_S)
    assert not turns_are_off(left_over(white() + ModesConfig.turn_sigmas), asked(straight)).any()
    assert not turns_are_off(left_over(np.full(SIZE, np.nan)), asked(WEAVING)).any()


def test_a_rest_does_not_take_back_what_turns_contradicted():
    """Off in the first half, nothing measured after it: by the clock it would be named again."""
    half = SIZE // 2
    known = white() + 0.8 * np.sign(WEAVING)
    known[half:] = np.nan
    off = turns_are_off(left_over(known), asked(WEAVING))
    assert off[half - 1]
    assert off[half:].all()


def test_a_mode_that_turns_contradict_is_not_named():
    known = replace(track(["a", "a"], ["a"] * 2), turns_are_off=np.array([False, True]))
    assert named_modes(known, 0.9).tolist() == ["a", UNDETERMINED]


def contradicted_for_two_seconds(leading, begin_s=10.0):
    """Of two modes; each one that leads between 10 and 12 s is far off."""
    both = np.random.default_rng(8).normal(size=(SIZE, 2, 1))
    both[within(STAMPS_S, np.array([[begin_s, begin_s + 2.0]]))] += 2.0
    return Innovations(both, leading, STAMPS_S, 1.0)


def test_a_mode_that_was_contradicted_is_not_named_again_at_once():
    found = contradicted_lately(contradicted_for_two_seconds(np.zeros(SIZE, dtype=int)))
    ends_s = STAMPS_S[found][-1]
    assert not found[STAMPS_S < 10.0].any()
    assert 12.0 + 6.0 - 1.0 < ends_s - ModesConfig.turn_holds_s < 12.0 + 6.0


def test_another_mode_than_the_contradicted_one_may_be_named():
    leading = (STAMPS_S >= 19.0).astype(int)  # six seconds say nothing against it any more
    found = contradicted_lately(contradicted_for_two_seconds(leading))
    assert found[STAMPS_S < 19.0][-1]
    assert not found[STAMPS_S >= 19.0].any()


def test_rest_takes_back_no_contradiction():
    innovations = contradicted_for_two_seconds(np.zeros(SIZE, dtype=int))
    innovations.normalised[STAMPS_S >= 12.0] = np.nan
    assert contradicted_lately(innovations)[-1]


def test_a_change_of_the_leading_mode_is_no_contradiction_of_the_new_one():
    """The one before it was far off for two seconds, then the other one leads and fits."""
    leading = (STAMPS_S >= 12.0).astype(int)
    assert not contradicted_lately(contradicted_for_two_seconds(leading))[STAMPS_S >= 12.0].any()
