"""Errors of gains on stretches that are held out, of yaw rates that are made here."""

import numpy as np
import pytest

from odometry.modes.identify.held_out_gains import gain_errors
from odometry.modes.models.yaw_rate_noise import YawRateStretch
from tests.odometry.modes.mode_examples import traction_set

STEP_S, WIDTH, SIZE = 0.02, 0.5, 6000
INFORMATION = 4.0 * 0.6**2  # of a window at 0.6 rad/s
MODES = traction_set((0.5, 0.8)).modes


def stretch_of(turn, rng, noise=0.0, spread=0.0):
    """A stretch of 2 min in turns of 4 s to both sides, of another gain in each."""
    t = STEP_S * np.arange(SIZE)
    number = (t / 4).astype(int)
    half = 0.3 * np.where(number % 2, 1.0, -1.0)
    speeds = np.column_stack([0.5 - half, 0.5 + half])
    gains = turn * (1 + spread * rng.normal(size=number[-1] + 1)[number])
    rates = gains * 2 * half / WIDTH + noise * rng.normal(size=SIZE)
    driving = np.ones(SIZE, dtype=bool)
    return YawRateStretch(t, speeds, rates, driving, STEP_S, np.zeros(SIZE), WIDTH)


def found(seed=3, stretches=2, **errors):
    rng = np.random.default_rng(seed)
    turns = dict(zip(MODES.names, (0.5, 0.8), strict=True))
    return gain_errors(
        MODES,
        {
            name: [stretch_of(of, rng, **errors) for _ in range(stretches)]
            for name, of in turns.items()
        },
    )


def deviation(spread, power):
    """Of the gains in a window: which of the two it comes of does not show at one yaw rate."""
    return np.sqrt(spread**2 + power / INFORMATION)


@pytest.mark.parametrize("stretches", [1, 2])
def test_a_spread_from_turn_to_turn_is_measured(stretches):
    of_modes = deviation(*found(stretches=stretches, spread=0.05))
    np.testing.assert_allclose(of_modes, 0.05, rtol=0.4)


def test_noise_of_a_yaw_rate_counts_by_its_power():
    of_noise = 0.05 * np.sqrt(STEP_S / INFORMATION)
    assert (deviation(*found(noise=0.05)) / of_noise > 0.5).all()
    assert (deviation(*found(noise=0.05)) / of_noise < 2.0).all()


def test_a_stretch_of_another_gain_is_off_by_it_where_it_is_held_out():
    rng = np.random.default_rng(5)
    stretches = {
        "none": [stretch_of(0.5, rng), stretch_of(0.55, rng)],
        "all": [stretch_of(0.8, rng)] * 2,
    }
    of_none, of_all = deviation(*gain_errors(MODES, stretches))
    assert of_none == pytest.approx(0.1, rel=0.2)  # 0.05 alone within the stretches
    assert of_all == pytest.approx(0.1 / np.sqrt(2), rel=0.2)  # that of all windows: no less


def test_too_little_measured_determines_nothing():
    assert gain_errors(MODES, {name: [] for name in MODES.names}) is None
