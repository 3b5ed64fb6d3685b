"""What a check of the odometer's covariance means, by hand: 3 is right, 12 is twice too far."""

import numpy as np
import pytest

from odometry.evaluation.odometer_noise import USUAL_NOISE
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.open_loop_consistency import OpenLoopConsistency
from terrain.result.evaluation_notes import advice, not_checked, verdict


def check(mean, distance_m=5.0):
    return OpenLoopConsistency(distance_m, 40, 10, mean, np.array([1.7, 4.7]))


def found(*checks, poses=80, own=()):
    return OdometerUncertainty(lambda: [np.eye(3)[None]], {}, USUAL_NOISE, poses, "", checks, own)


@pytest.mark.parametrize(
    ("mean", "word"), [(3.0, "consistent"), (9.0, "too small"), (0.5, "too large")]
)
def test_a_verdict_says_in_which_direction_a_covariance_is_wrong(mean, word):
    assert verdict(check(mean)) == word


def test_a_covariance_that_is_too_small_says_by_how_much_and_what_to_do():
    said = advice(found(check(3.0), check(12.0, 20.0), check(6.0, 100.0)), "truth")
    assert said.startswith(
        "Checked against the truth, the odometer's covariance is too small over 20 and"
    )
    assert "2.0 times as large as sigma_x" in said
    assert "Multiply the covariance by 4.0" in said


def test_without_a_truth_the_poses_judge():
    said = advice(found(check(3.0), check(3.0, 20.0)), "pose")
    assert said.startswith("Checked against the poses, ")
    assert said.endswith("as large as its errors over 5 and 20 m.")


def test_over_other_distances_the_check_by_own_poses_counts():
    own = (check(12.0), check(9.0, 100.0))
    said = advice(found(check(3.0), own=own), "pose")
    assert "too small over 100 m" in said
    assert "Multiply the covariance by 3.0" in said


def test_one_that_is_too_large_is_safe():
    assert "nothing needs to be done" in advice(found(check(0.75)), "truth")


def test_what_was_not_checked_says_why():
    assert "the filter took in no pose. It is that of other" in advice(found(poses=0), "")
    assert "not checked" in advice(found(), "pose")
    assert not_checked(found(), 100.0, "truth") == "not checked: the truth holds no 100 m"
    assert "100 m apart in a half" in not_checked(found(), 100.0, "pose")
    assert not_checked(found(poses=0), 100.0, "") == "not checked: no pose to check it by"
