"""A gyroscope that repeats one reading: stretches are put in, by how often readings repeat."""

import numpy as np
import pytest

from odometry.modes.recorded.bank_inputs import velocity_signals
from odometry.modes.recorded.held_rates import held_rates
from tests.odometry.modes.checks.test_turn_agreement import with_gyro
from tests.odometry.modes.mode_examples import run_of

SIZE, HELD = 2000, slice(1200, 1500)


def treads(rng):
    return rng.normal(1.0, 0.1, (SIZE, 2))


def test_a_reading_that_is_held_is_no_measurement(rng):
    rates = rng.normal(0.0, 0.01, SIZE)
    rates[HELD] = rates[HELD.start]
    assert np.flatnonzero(held_rates(rates, treads(rng))).tolist() == list(range(1201, 1500))


@pytest.mark.parametrize("step", [0.01, 0.05])
def test_few_digits_repeat_readings_by_themselves(rng, step):
    rates = np.round(rng.normal(0.0, 0.02, SIZE) / step) * step
    assert not held_rates(rates, treads(rng)).any()


def test_a_gyroscope_that_is_slower_than_the_rows_repeats_them(rng):
    rates = np.repeat(rng.normal(0.0, 0.01, SIZE // 10), 10)
    assert not held_rates(rates, treads(rng)).any()
    rates[HELD] = rates[HELD.start]
    assert held_rates(rates, treads(rng))[HELD][1:].all()


def test_a_turn_without_noise_has_one_rate():
    turns = np.repeat([0.0, 0.2, 0.1], [100, 900, 1000])  # as the treads ask
    speeds = np.column_stack([0.5 - turns, 0.5 + turns])
    assert not held_rates(turns, speeds).any()
    assert not held_rates(np.full(SIZE, 0.2), np.full((SIZE, 2), 0.5)).any()


def test_a_gyroscope_with_noise_has_no_constant_rate_on_a_circle_either(rng):
    rates = 0.2 + rng.normal(0.0, 0.01, SIZE)
    rates[HELD] = rates[HELD.start]
    assert held_rates(rates, np.full((SIZE, 2), 0.5))[HELD][1:].all()


def test_what_is_not_measured_is_not_held(rng):
    rates = rng.normal(0.0, 0.01, SIZE)
    rates[HELD] = np.nan
    assert not held_rates(rates, treads(rng)).any()
    assert not held_rates(np.full(SIZE, np.nan), treads(rng)).any()


def test_held_readings_are_no_signal_of_a_run():
    def frozen(rates):
        return np.where(np.arange(len(rates)) > 200, rates[200], rates)

    measured = velocity_signals(with_gyro(run_of(1.6), frozen)).measured[:, 1]
    assert np.isfinite(measured[:201]).all()
    assert np.isnan(measured[201:]).all()
