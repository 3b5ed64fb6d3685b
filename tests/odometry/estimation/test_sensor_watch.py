"""What is kept of a belief whose pose is not to be taught."""

import numpy as np

from odometry.estimation.sensor_watch import parted


def test_the_pose_says_nothing_of_the_rest_and_the_rest_nothing_of_the_pose(rng):
    root = rng.standard_normal((9, 9))
    mean, covariance = rng.standard_normal(9), root @ root.T
    found_mean, found = parted((mean, covariance), None, newly_stuck=False)
    np.testing.assert_array_equal(found_mean, mean)
    for block in (slice(0, 3), slice(3, 9)):
        np.testing.assert_array_equal(found[block, block], covariance[block, block])
    np.testing.assert_array_equal(found[:3, 3:], 0.0)
    np.testing.assert_array_equal(found, found.T)
