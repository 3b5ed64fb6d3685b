"""A dead time against commands looked up on a fine grid."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.effects.commands.late_treads import CommandDelay
from odometry.models.inputs import Inputs

PARTS = 2000


def delayed(speeds, time_s, delay_s):
    return CommandDelay().tread_speeds(np.array([delay_s]), Inputs(speeds, time_s=time_s))


@given(st.integers(0, 2**32 - 1), st.floats(0.0, 1.0))
def test_it_is_the_mean_of_what_was_commanded_before(seed, delay_s):
    """Uneven stamps; before the first command the same was held."""
    rng = np.random.default_rng(seed)
    time_s = np.concatenate([[0.0], np.cumsum(rng.uniform(0.01, 0.3, 20))])
    speeds = rng.uniform(-2, 2, (21, 2))
    found = delayed(speeds, time_s, delay_s)
    for row in range(20):
        fine_s = time_s[row] + (np.arange(PARTS) + 0.5) / PARTS * (time_s[row + 1] - time_s[row])
        held = np.maximum(np.searchsorted(time_s, fine_s - delay_s, side="right") - 1, 0)
        np.testing.assert_allclose(found[row], speeds[held].mean(axis=0), atol=4 * 30 / PARTS)


def test_whole_periods_shift_the_rows(rng):
    speeds = rng.uniform(-2, 2, (30, 2))
    found = delayed(speeds, 0.05 * np.arange(30), 0.15)
    np.testing.assert_allclose(found[3:], speeds[:-3], atol=1e-12)
    np.testing.assert_allclose(found[:3], speeds[[0, 0, 0]], atol=1e-12)


def test_a_pause_and_the_next_run_begin_anew(rng):
    """Nothing of before a pause of 5 s, or of another run, acts after it."""
    speeds = rng.uniform(-2, 2, (30, 2))
    steps_s = np.full(29, 0.05)
    steps_s[9], steps_s[19] = 5.0, -7.0
    time_s = np.concatenate([[0.0], np.cumsum(steps_s)])
    found = delayed(speeds, time_s, 0.1)
    for rows in (slice(0, 10), slice(10, 20), slice(20, 30)):
        np.testing.assert_allclose(
            found[rows], delayed(speeds[rows], time_s[rows], 0.1), atol=1e-12
        )
