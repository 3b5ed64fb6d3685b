"""The step of rounded positions is found, and nothing else is taken for rounding."""

import numpy as np
import pytest

from odometry.positions.rounding import (
    BAND,
    BIN,
    LEAST_STEP_M,
    _band,
    rounding_step_m,
    steps_m,
)

STAMPS_S = np.arange(0.0, 150.0, 0.1)
LOOPS = np.column_stack([9 * np.sin(STAMPS_S / 9), 6 * np.sin(STAMPS_S / 7 + 1)])
LANES = np.column_stack(  # along one axis to and fro, over to the next lane of 0.5 m after each
    [5 * np.abs((STAMPS_S / 10) % 2 - 1), 0.5 * np.floor(STAMPS_S / 10)]
)


def rounded(path, steps_m, offset_m=0.0):
    return np.round((path - offset_m) / steps_m) * steps_m + offset_m


@pytest.mark.parametrize("step_m", [0.03, 0.1, 0.25, 0.4])
@pytest.mark.parametrize("share", [0.0, 0.1, 0.2])
def test_the_step_is_found_under_noise(rng, step_m, share):
    noise = share * step_m * rng.standard_normal(LOOPS.shape)
    measured = rounded(LOOPS, step_m, offset_m=0.37) + noise
    assert rounding_step_m(STAMPS_S, measured) == pytest.approx(step_m, rel=0.02)


def test_axes_may_differ_in_step_and_the_coarser_counts():
    measured = rounded(LOOPS, np.array([0.08, 0.11]))
    assert rounding_step_m(STAMPS_S, measured) == pytest.approx(0.11, rel=0.02)


def test_one_rounded_axis_is_no_rounding():
    measured = np.column_stack([rounded(LOOPS[:, 0], 0.1), LOOPS[:, 1]])
    assert rounding_step_m(STAMPS_S, measured) == 0.0


@pytest.mark.parametrize("path", [LOOPS, LANES, 0 * LOOPS], ids=["loops", "lanes", "rest"])
@pytest.mark.parametrize("sigma_m", [0.0, 0.01, 0.1])
def test_positions_that_were_not_rounded_have_no_step(path, sigma_m):
    for seed in range(5):
        noise = sigma_m * np.random.default_rng(seed).standard_normal(path.shape)
        assert rounding_step_m(STAMPS_S, path + noise) == 0.0


def test_a_robot_that_stops_at_even_distances_is_not_rounded():
    drive_s, stop_s = 2.0, 4.0
    phase = STAMPS_S % (drive_s + stop_s)
    x = 0.5 * (STAMPS_S // (drive_s + stop_s) + np.minimum(phase / drive_s, 1.0))
    assert rounding_step_m(STAMPS_S, np.column_stack([x, 0.3 * np.cos(x)])) == 0.0


def test_rounding_much_finer_than_noise_is_none(rng):
    noise = 0.1 * rng.standard_normal(LOOPS.shape)
    assert rounding_step_m(STAMPS_S, rounded(LOOPS + noise, 0.05)) in (
        0.0,
        pytest.approx(0.05, rel=0.02),
    )
    assert rounding_step_m(STAMPS_S, rounded(LOOPS, 0.05) + noise) == 0.0


@pytest.mark.parametrize("far_m", [1e6, 1e12, 1e300])
def test_positions_far_apart_are_searched_for_coarse_steps_alone(far_m):
    """One stray position made a transform of as many gigabytes as it is kilometres away."""
    stray = rounded(LOOPS, 0.1)
    stray[700] = far_m
    assert rounding_step_m(STAMPS_S, stray) == 0.0


def test_a_step_of_a_long_way_is_found():
    assert rounding_step_m(STAMPS_S, rounded(100 * LOOPS, 0.4)) == pytest.approx(0.4, rel=0.02)


def test_few_steps_of_a_slow_robot_are_recognised_where_values_repeat():
    stamps_s = np.arange(0.0, 60.0, 0.05)
    path = np.column_stack([0.15 * stamps_s, 0.02 * np.sin(stamps_s)])
    assert steps_m(stamps_s, np.round(path)).tolist() == [1.0, 1.0]
    assert steps_m(stamps_s, path).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("count", [0, 1, 6])
def test_few_positions_show_no_steps(count):
    positions = np.arange(2.0 * count).reshape(-1, 2)
    assert steps_m(np.arange(float(count)), positions).tolist() == [0.0, 0.0]


def test_steady_speeds_of_a_simulation_are_no_steps():
    stamps_s = np.arange(0.0, 20.0, 0.05)
    path = np.column_stack([stamps_s, np.zeros(len(stamps_s))])
    assert steps_m(stamps_s, path).tolist() == [0.0, 0.0]


def test_the_agreement_with_each_step_is_the_mean_of_phasors(rng):
    places = rng.uniform(0, 30, 500)
    steps, agreement_of = _band(places, places, LEAST_STEP_M)
    binned = np.floor((places - places.min()) / (BIN * LEAST_STEP_M)) * BIN * LEAST_STEP_M
    expected = [abs(np.exp(-2j * np.pi * binned / step).mean()) for step in steps]
    assert LEAST_STEP_M <= steps.min() < steps.max() < BAND * LEAST_STEP_M
    np.testing.assert_allclose(agreement_of(places), expected, atol=1e-9)
