"""Columns of encoder counts, where the robot drives ahead for the most part."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.recording import check_recording
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import PERIOD_S, uneven
from tests.odometry.checks.faulty import treads, without_gyroscope

METRES_A_COUNT = {"metres": 1.0, "radians of 8 cm": 0.08, "ticks": 5e-4}


@pytest.mark.parametrize(
    ("unit", "gyroscope"), list(zip(METRES_A_COUNT, (True, False, True), strict=True))
)
def test_counts_that_grow_all_the_time_are_named(unit, gyroscope):
    """They explain a half of the way ahead, as any number of one sign does."""
    run = uneven() if gyroscope else without_gyroscope(uneven())
    step = PERIOD_S / METRES_A_COUNT[unit]
    counted = treads(run, lambda *sides: tuple(step * np.cumsum(v) for v in sides))
    assert warnings(counted) == ["treads_are_counters"]


def test_counts_without_poses_and_gyroscope_may_be_counters_or_another_unit():
    """No motion says which: both are said, and what is done about counters."""
    run = replace(without_gyroscope(uneven()), pose=None)
    counted = treads(run, lambda *sides: tuple(2000 * np.cumsum(v) for v in sides))
    (found,) = check_recording(counted).findings
    assert found.name == "tread_unit"
    assert "another unit than m/s, or" in found.cause
    assert "encoder" in found.cause
    assert "differentiate" in found.remedy
