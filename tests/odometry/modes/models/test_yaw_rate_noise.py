from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.models.response import BLOCK_S
from odometry.modes.models.yaw_rate_noise import (
    LASTING_S,
    NOT_MEASURED,
    YawRateNoise,
    YawRateStretch,
    estimated_yaw_rate_noise,
    yaw_rate_stretch_of,
)
from tests.odometry.modes.mode_drives import ROBOT, asked_twists, gains_of, run_of_tables, wandering

STEP_S = 0.02
LEFT, RIGHT = np.zeros((2, 3, 3))
RIGHT[0], RIGHT[1] = [0.0, 0.1, 0.2], [0.0, 0.0, 0.2]
GAINS = gains_of([[1.0, 0.0, 0.05], [0.0, 0.0, 0.5]], LEFT, RIGHT)


def stretch(errors, accelerations=0.0):
    """What a gyroscope measured, of which only the step and the accelerations count, and errors."""
    blank, steady = np.zeros(len(errors)), np.broadcast_to(accelerations, errors.shape)
    return YawRateStretch(
        blank, np.zeros((len(errors), 2)), blank, blank > 0, STEP_S, steady, 1.0
    ), errors


def drive(rng, size, errors, *, gyro=True):
    """What the gains ask for, a stamp late as a lag of nothing is, and errors."""
    treads = wandering(rng, size, STEP_S)
    late = np.append(treads[:1], treads[:-1], axis=0)
    columns = {"t": STEP_S * np.arange(size), "v_left": treads[:, 0], "v_right": treads[:, 1]}
    if gyro:
        columns["gyro_z"] = asked_twists(GAINS, late, ROBOT.track_width)[:, 2] + errors
    return run_of_tables(columns)


def test_errors_are_what_the_gains_leave(rng):
    errors = rng.normal(size=3000)
    errors[7] = np.nan
    run = drive(rng, 3000, errors)
    found = yaw_rate_stretch_of(run, np.arange(3000))
    np.testing.assert_allclose(found.errors(GAINS, 0.0), np.delete(errors, 7), atol=1e-9)
    assert found.step_s == pytest.approx(STEP_S)
    assert found.accelerations_m_s2.shape == (2999,)
    assert found.accelerations_m_s2.min() == 0.0  # held for a second each


def test_a_stationary_robot_has_no_error(rng):
    run = drive(rng, 300, np.arange(300.0))
    still = {name: run.odometry[name] * (np.arange(300) >= 100) for name in ("v_left", "v_right")}
    run = replace(run, odometry=replace(run.odometry, columns=run.odometry.columns | still))
    assert len(yaw_rate_stretch_of(run, np.arange(300)).errors(GAINS, 0.0)) == 200
    still = {name: np.zeros(300) for name in ("v_left", "v_right")}
    run = replace(run, odometry=replace(run.odometry, columns=run.odometry.columns | still))
    assert yaw_rate_stretch_of(run, np.arange(300)) is None


def test_a_gyroscope_read_less_often_than_the_treads(rng):
    errors = np.where(np.arange(3000) % 10 == 0, 0.1, np.nan)
    found = yaw_rate_stretch_of(drive(rng, 3000, errors), np.arange(3000))
    assert found.step_s == pytest.approx(10 * STEP_S)
    variance = estimated_yaw_rate_noise([(found, found.errors(GAINS, 0.0))]).variance
    assert variance == pytest.approx(0.1**2 * LASTING_S / (10 * STEP_S))


def test_stamps_may_be_those_of_a_clock(rng):
    run = drive(rng, 3000, 0.01 * rng.normal(size=3000))
    late = replace(run.odometry, columns=run.odometry.columns | {"t": run.odometry["t"] + 1.7e9})
    plain, clock = (
        yaw_rate_stretch_of(of, np.arange(3000)).errors(GAINS, 0.1)
        for of in (run, replace(run, odometry=late))
    )
    np.testing.assert_allclose(clock, plain, atol=1e-4)


def test_a_part_of_a_run_alone(rng):
    rows = np.arange(100, 400)
    errors = yaw_rate_stretch_of(drive(rng, 500, np.arange(500.0)), rows).errors(GAINS, 0.0)
    np.testing.assert_allclose(errors[1:], rows[1:], atol=1e-9)


def test_without_a_gyroscope_or_a_step_there_are_none(rng):
    run, without = (drive(rng, 100, 0.0, gyro=gyro) for gyro in (True, False))
    assert yaw_rate_stretch_of(without, np.arange(100)) is None
    assert yaw_rate_stretch_of(run, np.array([3])) is None
    assert estimated_yaw_rate_noise([]) == YawRateNoise(NOT_MEASURED)


def test_white_noise_is_what_it_is(rng):
    found = estimated_yaw_rate_noise([stretch(0.05 * rng.normal(size=40_000))])
    of_block = 0.05**2 * STEP_S / BLOCK_S  # of the square of a mean, which a chance leaves
    blocks = 40_000 * STEP_S / BLOCK_S
    chance = 4 * of_block * np.sqrt(2 / blocks) * LASTING_S / STEP_S
    assert found.variance == pytest.approx(0.05**2, abs=chance + 0.05 * 0.05**2)


def test_an_error_that_is_always_there_counts_for_as_long_as_a_turn():
    """A bias is as white noise of as many times its square as there are samples in a turn."""
    found = estimated_yaw_rate_noise([stretch(np.full(5000, 0.1))])
    assert found.variance == pytest.approx(0.1**2 * LASTING_S / STEP_S)
    assert (found.growth, found.lasting) == (0.0, pytest.approx(0.1**2))


def test_both_together(rng):
    white = 0.02 * rng.normal(size=20_000)
    found = estimated_yaw_rate_noise([stretch(0.01 + white)])
    expected = 0.02**2 + 0.01**2 * LASTING_S / STEP_S
    assert found.variance == pytest.approx(expected, rel=0.2)


def test_it_grows_with_the_square_of_acceleration():
    """0.01 rad/s at rest of the treads' speeds, 0.03 while they change by 0.5 m/s^2."""
    calm, rough = (stretch(np.full(5000, e), a) for e, a in ((0.01, 0.0), (0.03, 0.5)))
    found = estimated_yaw_rate_noise([calm, rough])
    assert found.variance == pytest.approx(0.01**2 * LASTING_S / STEP_S)
    assert found.growth == pytest.approx(8 / 0.5**2)  # nine times the square
    np.testing.assert_allclose(found.variances(np.array([0.0, 0.5])) / found.variance, [1.0, 9.0])


def test_what_falls_with_acceleration_does_not_grow():
    found = estimated_yaw_rate_noise(
        [stretch(np.full(5000, e), a) for e, a in ((0.03, 0.0), (0.01, 0.5))]
    )
    assert found.growth == 0.0


def test_too_short_for_a_block_says_nothing():
    assert estimated_yaw_rate_noise([stretch(np.full(50, 0.1))]) == YawRateNoise(NOT_MEASURED)
