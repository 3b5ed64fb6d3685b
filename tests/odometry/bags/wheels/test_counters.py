"""Counts of encoders whose counter overflows."""

import numpy as np
import pytest

from odometry.bags.wheels.counters import Counters
from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag

TICKS = 60_000  # a turn
RATE_HZ = 20.0
PER_MESSAGE = np.array([[6000], [-4000]])  # forwards, backwards


def counted(bits, *, signed):
    """Differences of a count, and the count as its register shows it."""
    steps = np.repeat(PER_MESSAGE, 40, axis=0)
    size, count = 2**bits, np.concatenate([[[0]], np.cumsum(steps, axis=0)])
    return steps, (count + size // 2) % size - size // 2 if signed else count % size


@pytest.mark.parametrize("signed", [True, False])
@pytest.mark.parametrize("cut", [2, 30, 60])
def test_a_counter_is_unwrapped_wherever_its_rows_are_parted(signed, cut):
    steps, register = counted(16, signed=signed)
    counters, register = Counters(), register.astype(float)
    found = [counters.steps(part) for part in (register[:cut], register[cut - 1 :])]
    np.testing.assert_array_equal(np.concatenate(found), steps)
    assert counters.wraps == int(np.count_nonzero(np.abs(np.diff(register[:, 0])) > 40_000))


@pytest.mark.parametrize(
    "places",
    [
        np.array([0.0, 60_000.0, 120_000.0, 60_000.0]),  # a larger counter, and large steps
        np.array([0.5, 60_000.5, 1.5]),  # angles or metres, not counts
        np.array([0.0, 30_000.0, 0.0]),  # a reset, or a wrap of 15 bits
        np.array([0.0, np.nan, 60_000.0, 70_000.0]),
    ],
)
def test_other_places_are_differenced_as_they_are(places):
    counters = Counters()
    found = counters.steps(places[:, None])
    np.testing.assert_array_equal(found, np.diff(places)[:, None])
    assert counters.notes("/encoders") == []


def bag_of(register):
    bag = Bag("ros1")
    layout = bag.message("std_msgs/msg/MultiArrayLayout", dim=[], data_offset=0)
    for place, count in enumerate(register[:, 0]):
        data = np.array([count, count], dtype=np.int16)
        made = bag.message("std_msgs/msg/Int16MultiArray", layout=layout, data=data)
        bag.add("/encoders", "std_msgs/msg/Int16MultiArray", 1 + place / RATE_HZ, made)
    return bag


OPTIONS = {"wheels__topic": "/encoders", "wheels__unit": "turns", "wheels__gear": TICKS}


def test_an_import_of_ticks_of_16_bits_has_the_true_speeds(tmp_path):
    """A fine encoder wraps once a second, and the differences were taken as they are."""
    steps, register = counted(16, signed=True)
    path = bag_of(register).write(tmp_path / "drive")
    run, said = imported(tmp_path / "run", path, **OPTIONS)
    expected = steps[:, 0] * 2 * np.pi * RADIUS_M / TICKS * RATE_HZ
    np.testing.assert_allclose(run.odometry["v_left"], expected, rtol=1e-5)
    assert any("a counter of 16 bits wrapped in" in note for note in said.notes)


def test_a_counter_that_is_too_small_for_its_rate_stops_the_import(tmp_path):
    """30 000 ticks a message forwards are 35 536 backwards, and 40 000 are 25 536 backwards."""
    for ticks in (30_000, 40_000):
        count = np.cumsum(np.full((60, 1), ticks), axis=0)
        register = (count + 2**15) % 2**16 - 2**15
        path = bag_of(register).write(tmp_path / f"drive_{ticks}")
        with pytest.raises(BagError, match="a counter changes by nearly half of its size"):
            imported(tmp_path / f"run_{ticks}", path, **OPTIONS)
