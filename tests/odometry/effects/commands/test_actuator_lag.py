"""The first-order lag against a step-by-step filter, and closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.effects.commands.late_treads import ActuatorLag
from odometry.models.inputs import Inputs

EFFECT = ActuatorLag()
PARTS = 400


def lagged(speeds, time_s, lag):
    return EFFECT.tread_speeds(np.array([lag]), Inputs(speeds, time_s=np.asarray(time_s)))


def step_by_step(speeds, steps_s, lag):
    """Means over each sample of v' = (u - v) / lag from rest at the first command, by midpoints."""
    reached, means = np.array(speeds[0], float), []
    for command, step_s in zip(speeds, steps_s, strict=True):
        ages = (np.arange(PARTS) + 0.5) / PARTS * step_s
        means.append(
            command + (reached - command) * np.mean([math.exp(-age / lag) for age in ages])
        )
        reached = command + (reached - command) * math.exp(-step_s / lag)
    return np.array(means)


@given(st.integers(0, 2**32 - 1), st.floats(0.02, 2.0))
def test_it_is_the_exact_response_between_held_commands(seed, lag):
    """Even and uneven stamps, some of them a microsecond apart."""
    rng = np.random.default_rng(seed)
    steps_s = rng.choice([0.02, 0.02, 0.05, 1e-6, rng.uniform(0.001, 0.4)], 30)
    speeds = rng.uniform(-2, 2, (31, 2))
    time_s = np.concatenate([[0.0], np.cumsum(steps_s)])
    expected = step_by_step(speeds[:-1], steps_s, lag)
    np.testing.assert_allclose(lagged(speeds, time_s, lag)[:-1], expected, atol=1e-4)


def test_a_change_of_command_costs_its_height_times_the_lag(rng):
    """In the long run the treads have travelled lag (u_1 - u_0) less than commanded."""
    time_s = np.concatenate([[0.0], np.cumsum(rng.uniform(0.01, 0.03, 400))])
    speeds = np.where(time_s[:, None] < time_s[50], [0.3, -0.2], [1.0, 0.5])
    missing = (speeds - lagged(speeds, time_s, 0.2))[:-1] * np.diff(time_s)[:, None]
    np.testing.assert_allclose(missing.sum(axis=0), 0.2 * np.array([0.7, 0.7]), rtol=1e-9)


def test_finer_samples_of_the_same_commands_change_nothing(rng):
    """A sample cut in two has the mean of its parts."""
    speeds, time_s = rng.uniform(-1, 1, (20, 2)), 0.1 * np.arange(20)
    cut_s = np.sort(np.concatenate([time_s, time_s[:-1] + 0.03]))
    rows = np.searchsorted(time_s, cut_s, side="right") - 1
    fine = lagged(speeds[rows], cut_s, 0.15)[:-1]
    shares = np.array([0.3, 0.7])[:, None]
    whole = (fine.reshape(19, 2, 2) * shares).sum(axis=1)
    np.testing.assert_allclose(whole, lagged(speeds, time_s, 0.15)[:-1], atol=1e-12)


@pytest.mark.parametrize("gap_s", [-3.0, 1.5])
def test_another_run_or_a_pause_begins_with_treads_that_have_caught_up(rng, gap_s):
    speeds, half_s = rng.uniform(-1, 1, (40, 2)), 0.02 * np.arange(20)
    time_s = np.concatenate([half_s, half_s + half_s[-1] + gap_s])
    together = lagged(speeds, time_s, 0.3)
    for part in (slice(0, 20), slice(20, 40)):
        np.testing.assert_allclose(together[part], lagged(speeds[part], half_s, 0.3), atol=1e-12)


def test_slow_odometry_has_no_pauses():
    """Stamps two seconds apart: the lag still shows."""
    speeds = np.array([[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [1.0, 1.0]])
    found = lagged(speeds, 2.0 * np.arange(4), 0.5)
    np.testing.assert_allclose(found[1], 1 - 0.25 * (1 - math.exp(-4)), rtol=1e-12)


def test_without_stamps_or_lag_speeds_are_as_recorded(rng):
    speeds = rng.uniform(-1, 1, (5, 2))
    np.testing.assert_array_equal(EFFECT.tread_speeds(np.array([0.2]), Inputs(speeds)), speeds)
    np.testing.assert_array_equal(lagged(speeds, np.arange(5) / 50, 0.0), speeds)
