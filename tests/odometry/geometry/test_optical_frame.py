from math import cos, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.geometry import se3
from odometry.geometry.se3 import mount_of_optical, optical_of_mount


def seen_from_robot(right, down, ahead, place=(0.0, 0.0, 0.0)):
    """Pose of an optical frame by where its axes point in the robot frame."""
    return se3.pose(np.array(place), np.column_stack([right, down, ahead]))


def test_a_level_camera_has_no_angles():
    optical = seen_from_robot([0, -1, 0], [0, 0, -1], [1, 0, 0], (0.3, -0.1, 0.8))
    assert mount_of_optical(optical) == pytest.approx((0.3, -0.1, 0.8, 0, 0, 0))


def test_the_rotation_that_robot_descriptions_give_an_optical_frame_is_level():
    """rpy = (-pi/2, 0, -pi/2) from camera_link to its optical frame, as REP-103 prescribes."""
    rotation = se3.rotation_from_roll_pitch_yaw(np.array([-pi / 2, 0, -pi / 2]))
    mount = mount_of_optical(se3.pose(np.zeros(3), rotation))
    assert mount == pytest.approx((0, 0, 0, 0, 0, 0), abs=1e-12)


def test_a_view_downwards_is_a_positive_pitch():
    down_rad = radians(50)
    ahead = [cos(down_rad), 0, -sin(down_rad)]
    image_down = [-sin(down_rad), 0, -cos(down_rad)]
    mount = mount_of_optical(seen_from_robot([0, -1, 0], image_down, ahead))
    assert mount == pytest.approx((0, 0, 0, 0, down_rad, 0), abs=1e-12)


def test_a_view_to_the_left_is_a_positive_yaw():
    mount = mount_of_optical(seen_from_robot([1, 0, 0], [0, 0, -1], [0, 1, 0]))
    assert mount == pytest.approx((0, 0, 0, 0, 0, pi / 2), abs=1e-12)


def test_a_camera_whose_image_leans_right_has_a_positive_roll():
    """Roll is positive with the right side down: what is right in the image is low outside."""
    lean_rad = 0.2
    right = [0, -cos(lean_rad), -sin(lean_rad)]
    image_down = [0, sin(lean_rad), -cos(lean_rad)]
    mount = mount_of_optical(seen_from_robot(right, image_down, [1, 0, 0]))
    assert mount == pytest.approx((0, 0, 0, lean_rad, 0, 0), abs=1e-12)


@given(
    place=st.tuples(*3 * [st.floats(-10, 10)]),
    roll=st.floats(-3.1, 3.1),
    pitch=st.floats(-1.5, 1.5),
    yaw=st.floats(-3.1, 3.1),
)
def test_the_way_back_gives_the_mount_again(place, roll, pitch, yaw):
    mount = (*place, roll, pitch, yaw)
    assert mount_of_optical(optical_of_mount(np.array(mount))) == pytest.approx(mount, abs=1e-9)
