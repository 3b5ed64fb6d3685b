"""Speeds from encoder counts that wrapped, and single samples that are wrong otherwise."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.treads.wrapped_counts import unwrapped
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import PERIOD_S, winding
from tests.odometry.checks.faulty import treads, without_gyroscope

WAY_M = 1.31  # of 65536 counts
SENSORS = {
    "gyroscope and poses": lambda run: run,
    "gyroscope": lambda run: replace(run, pose=None),
    "poses": without_gyroscope,
}


def wrapped(speed_m_s):
    counts = np.cumsum(speed_m_s) * PERIOD_S / WAY_M
    return np.diff(counts - np.round(counts), prepend=0.0) * WAY_M / PERIOD_S


@pytest.mark.parametrize("sensors", SENSORS)
def test_counts_that_wrap_are_named_and_the_rest_is_judged_without(sensors):
    run = SENSORS[sensors](winding())
    counts = treads(run, lambda left, right: (wrapped(left), wrapped(right)))
    assert warnings(counts) == ["counts_wrapped"]
    (found,), mended = unwrapped(counts)
    assert "by 1.31" in found.seen
    for name in ("v_left", "v_right"):
        np.testing.assert_allclose(mended.odometry[name], run.odometry[name], atol=0.2)
    swapped = treads(counts, lambda left, right: (right, left))
    assert set(warnings(swapped)) > {"counts_wrapped"}


@pytest.mark.parametrize("value", [-99999.0, -99.0, None])
def test_samples_that_come_anywhere_are_no_wraps(value, rng):
    run = winding()
    rows = rng.random(len(run.odometry)) < 0.02
    sizes = -30 * rng.random(len(rows)) if value is None else value
    spiky = treads(run, lambda left, right: (np.where(rows, sizes, left), right))
    assert unwrapped(spiky)[0] == []
    assert {"absurd_speed", "placeholder_speeds", "sensors_disagree"} & set(warnings(spiky))


def test_glitches_of_other_sizes_at_each_turn_of_a_wheel_are_no_wraps():
    run = winding()
    glitch = np.abs(wrapped(run.odometry["v_left"]) - run.odometry["v_left"]) > 1
    sizes = np.where(np.cumsum(glitch) % 2, 0.94, 1.06) * WAY_M / PERIOD_S
    odd = treads(run, lambda left, right: (left - np.where(glitch, sizes, 0.0), right))
    assert unwrapped(odd)[0] == []
