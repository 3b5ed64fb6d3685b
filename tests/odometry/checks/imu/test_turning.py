"""One tread of the wrong sign, where the way along has the sign of the turns in a part."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.recording import check_recording
from odometry.checks.turns.turns_in_parts import turns_flip
from tests.odometry.checks.answers import UNKNOWN, warnings
from tests.odometry.checks.drives import shunting
from tests.odometry.checks.faulty import SENSORS, gyroscope, treads


@pytest.mark.parametrize(
    ("sensors", "side"), list(zip(SENSORS, ("left", "right", "left"), strict=True))
)
def test_it_is_named_where_turns_seem_to_flip(side, sensors):
    signs = (-1, 1) if side == "left" else (1, -1)
    run = treads(shunting(2), lambda left, right: (signs[0] * left, signs[1] * right))
    assert turns_flip(Evidence(run))
    assert warnings(SENSORS[sensors](run)) == [f"tread_{side}_reversed"]
    assert warnings(SENSORS[sensors](shunting(2))) == []


def test_turns_that_flip_beside_it_leave_the_cause_open():
    """The gyroscope has another sign from the middle on, as well."""
    run = treads(shunting(2), lambda left, right: (left, -right))
    flipped = gyroscope(run, lambda rate: np.where(np.arange(len(rate)) < 1600, rate, -rate))
    assert warnings(flipped) == UNKNOWN


def test_it_is_no_robot_that_is_blocked():
    run = treads(shunting(0), lambda left, right: (left, -right))
    assert [f.name for f in check_recording(run).findings] == ["tread_right_reversed"]
