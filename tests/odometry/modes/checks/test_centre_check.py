"""Turning centres that are off: runs whose centre is given, of modes whose spread is stated."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.checks.centre_check import centre_check
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.track import follow_modes
from odometry.modes.models.mode_set import UNDETERMINED
from odometry.modes.models.mode_set_file import read_mode_set, write_mode_set
from tests.odometry.modes.checks.centre_examples import centre_run, centre_set

CHANGES = np.where(np.arange(2000) < 1000, 0.12, 0.0)  # ahead, up to 20 s


def checked(run, mode_set=None, leads_from_s=(0.0, np.inf)):
    """Stamps, and where the centre is off of modes that lead from these times on."""
    modes = (mode_set or centre_set()).modes
    signals = modes.signals(run)
    leading = np.searchsorted(leads_from_s, signals.stamps_s, side="right") - 1
    return signals.stamps_s, centre_check(signals, modes, leading)


@pytest.mark.parametrize("ahead_m", [0.0, 0.03, -0.03])
def test_a_centre_within_its_spread_is_not_off(ahead_m):
    assert not checked(centre_run(ahead_m))[1].any()


def test_a_centre_beyond_its_spread_is_off():
    stamps_s, off = checked(centre_run(0.12))
    assert off[stamps_s > 10.0].all()
    assert not checked(centre_run(0.12), centre_set(spread=0.1))[1].any()


def test_what_another_mode_left_says_nothing_of_the_leading_one():
    stamps_s, off = checked(centre_run(CHANGES), leads_from_s=(0.0, 20.0))
    assert off[stamps_s < 20.0].any()
    assert not off[stamps_s >= 20.0].any()


def test_the_last_seconds_take_back_what_was_off_before():
    stamps_s, off = checked(centre_run(CHANGES))
    assert off[(stamps_s > 12.0) & (stamps_s < 20.0)].all()
    assert not off[stamps_s > 24.5].any()


def test_a_set_without_a_spread_and_a_run_with_few_poses_have_no_such_test():
    assert checked(centre_run(0.2), centre_set(spread=None))[1] is None
    assert checked(centre_run(0.2, pose_rows=100))[1] is None


@pytest.mark.slow
def test_another_set_of_wheels_that_turns_as_a_mode_is_not_named():
    found = follow_modes(centre_run(0.12), centre_set(spread=0.01))
    alone = replace(found, fit=None, between=None, contradicted=None, gyroscope=None)
    assert found.centre.mean() > 0.5
    without = named_modes(replace(alone, centre=None), 0.9)
    assert (without[found.centre] == "none").mean() > 0.9
    assert set(named_modes(alone, 0.9)[found.centre]) == {UNDETERMINED}


def test_a_set_keeps_its_spread_and_older_sets_have_none(tmp_path):
    for spread in (0.02, None):
        mode_set = centre_set(spread=spread)
        write_mode_set(tmp_path / "set.toml", mode_set)
        again = read_mode_set(tmp_path / "set.toml").modes
        for name in ("centre_spread", "centre_noise"):
            np.testing.assert_equal(getattr(again, name), getattr(mode_set.modes, name))
