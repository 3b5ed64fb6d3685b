"""Power of errors of a speed that positions with noise measured: both are put in."""

import numpy as np
import pytest

from odometry.modes.identify.gain_spread import growing_power
from odometry.modes.identify.travel_power import travel_power
from odometry.modes.models.response import Record, Response

STEP_S, SIZE = 0.1, 20000
EXACT = Response(10.0, np.array([0.0, 5.0, 5.0]))
NOISE_M, TURNING_RAD_S = 0.02, 0.5


def record(rng, *, power=0.0, growing=0.0, noise_m=NOISE_M):
    """A robot of 0.05 m/s that turns now and then, by positions read 0.15 s before and after."""
    turning = TURNING_RAD_S * (np.arange(SIZE) // 400 % 2)
    errors = np.sqrt((power + growing * turning**2) / STEP_S) * rng.normal(size=SIZE)
    places_m = noise_m * rng.normal(size=SIZE + 3)
    read = (places_m[3:] - places_m[:-3]) / (3 * STEP_S)
    return Record(
        STEP_S, np.column_stack([0.05 + errors + read, turning, *[np.full(SIZE, 0.05)] * 2])
    )


def test_noise_of_positions_is_no_power_of_a_slow_robot(rng):
    found = travel_power([record(rng)], 0, EXACT, by=1)
    assert found[0] < 0.05 * NOISE_M**2
    assert growing_power([record(rng)], 0, EXACT, by=1)[0] > 0.3 * NOISE_M**2


def test_power_that_is_put_in_is_found_beside_the_noise(rng):
    records = [record(rng, power=1e-4, growing=1e-3) for _ in range(4)]
    assert travel_power(records, 0, EXACT, by=1) == pytest.approx([1e-4, 1e-3], rel=0.3)


def test_of_blocks_of_one_duration_all_is_power(rng):
    short = Record(STEP_S, record(rng).table[:30])
    assert travel_power([short], 0, EXACT, by=1) == pytest.approx(
        growing_power([short], 0, EXACT, by=1)
    )


def test_records_shorter_than_a_block_have_none(rng):
    short = Record(STEP_S, record(rng).table[:10])
    assert travel_power([short], 0, EXACT, by=1).tolist() == [0.0, 0.0]
