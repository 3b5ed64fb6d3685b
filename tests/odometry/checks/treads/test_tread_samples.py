"""Zeros amid motion: messages that were lost, and not speeds that round to zero."""

import numpy as np
import pytest

from odometry.checks.recording import check_recording
from odometry.estimation.speed_step import tick_of
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import put, treads

DROPPED = "dropped_speeds"


def names(run):
    return [finding.name for finding in check_recording(run).findings]


def at_uneven_stamps(run, seed=3):
    """Stamps that come up to a third of a period early or late."""
    rng = np.random.default_rng(seed)
    stamps_s = run.odometry.stamps_s
    return put(run, "odometry", t=stamps_s + 0.05 / 3 * rng.uniform(-1, 1, len(stamps_s)))


def by_ticks(run, tick_m):
    """Speeds of a counter: whole ticks since the row before, over the time since then."""
    periods_s = np.diff(run.odometry.stamps_s, prepend=run.odometry.stamps_s[0] - 0.05)

    def counted(speeds):
        return np.diff(np.floor(np.cumsum(speeds * periods_s) / tick_m), prepend=0) * tick_m

    return treads(run, lambda *speeds: tuple(counted(speed) / periods_s for speed in speeds))


def with_zeros(run, share=0.01, seed=4):
    rng = np.random.default_rng(seed)
    kept = rng.random((2, len(run.odometry))) > share
    return treads(run, lambda *speeds: tuple(v * k for v, k in zip(speeds, kept, strict=True)))


@pytest.mark.parametrize("tick_m", [0.03, 0.05])
def test_few_ticks_between_uneven_stamps_are_not_lost_messages(tick_m):
    """To leave these rows out, as is advised for lost ones, would double the speed."""
    run = by_ticks(at_uneven_stamps(winding()), tick_m)
    assert np.sum(run.odometry["v_left"] == 0) > 50
    assert names(run) == ["coarse_speeds"]


def test_messages_lost_beside_fine_ticks_are():
    assert DROPPED in names(with_zeros(by_ticks(at_uneven_stamps(winding()), 0.005)))


def test_one_speed_that_is_held_is_no_tick():
    """One speed is one way in every row."""
    periods_s = np.full(400, 0.05)
    held = np.where(np.arange(400) % 40 == 0, 0.0, 0.8)
    assert tick_of(held, periods_s) is None
    ticks = np.random.default_rng(5).integers(0, 4, 400)
    assert tick_of(0.02 * ticks / periods_s, periods_s) == pytest.approx(0.02)
