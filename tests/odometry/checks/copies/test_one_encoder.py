"""One encoder that is read for both sides."""

import numpy as np
import pytest

from odometry import check_recording
from tests.odometry.checks.drives import drive, winding
from tests.odometry.checks.faulty import put


def names(run):
    return [finding.name for finding in check_recording(run).findings]


@pytest.mark.parametrize(
    "copy",
    [
        lambda _, speed: np.r_[speed[:1], speed[:-1]],
        lambda t, speed: np.interp(t - 0.08, t, speed),
        lambda _, speed: 1.04 * speed,
        lambda _, speed: np.round(speed, 3),
    ],
    ids=["next row", "late", "another radius", "rounded"],
)
def test_one_encoder_for_both_sides_is_noticed(copy):
    run = winding()
    left = copy(run.odometry.stamps_s, run.odometry["v_right"])
    assert names(put(run, "odometry", v_left=left))[0] == "treads_equal"


def test_a_circle_may_have_treads_of_one_ratio():
    at_s = 0.05 * np.arange(2400)
    speed = 1 + 0.3 * np.sin(at_s / 7)
    run = drive(speed, 0.6 * speed)
    left, right = (speed * (1 + side * 0.27) for side in (-1, 1))
    assert "treads_equal" not in names(put(run, "odometry", v_left=left, v_right=right))
