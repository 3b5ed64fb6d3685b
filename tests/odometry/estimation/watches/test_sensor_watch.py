"""What is kept of a belief whose pose is not to be taught."""

import numpy as np
import pytest

from odometry.estimation.watches.pose_watch import PoseWatch, moved
from odometry.estimation.watches.tread_watch import parted


def test_the_pose_says_nothing_of_the_rest_and_the_rest_nothing_of_the_pose(rng):
    root = rng.standard_normal((9, 9))
    mean, covariance = rng.standard_normal(9), root @ root.T
    found_mean, found = parted((mean, covariance), None, newly_stuck=False)
    np.testing.assert_array_equal(found_mean, mean)
    for block in (slice(0, 3), slice(3, 9)):
        np.testing.assert_array_equal(found[block, block], covariance[block, block])
    np.testing.assert_array_equal(found[:3, 3:], 0.0)
    np.testing.assert_array_equal(found, found.T)


@pytest.mark.parametrize(
    ("speeds", "yaw_rate", "expected"),
    [
        ([-1.0, 3.0], 0.5, (0.2, 0.05)),
        ([np.nan, 3.0], 0.5, (0.0, 0.05)),
        ([-1.0, 3.0], np.nan, (0.2, 0.0)),
    ],
)
def test_wheel_travel_of_a_step_is_the_mean_of_both_treads(speeds, yaw_rate, expected):
    assert moved(PoseWatch(), np.array(speeds), yaw_rate, 0.1) == pytest.approx(expected)


def test_rounded_positions_show_the_way_ahead_alone():
    watch = PoseWatch(rounded_m=0.5)
    assert moved(watch, np.array([-1.0, 3.0]), 0.5, 0.1) == pytest.approx((0.1, 0.0))
