"""The region ahead: Chen 2023 eq. 22, the predicted place, and when there is no region."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import ConfigError
from odometry.recording.run import Robot
from terrain.camera.camera import Camera
from terrain.region.region import NoRegion, Rectangle, RegionConfig, predict_region
from tests.terrain.region.regions import (
    AHEAD,
    ALL_ROUND,
    MATRIX,
    ROBOT,
    box_round_footprint,
    moved_by_small_steps,
    twists,
)


@given(twist=twists, ahead_s=st.floats(0.05, 5.0), scale=st.sampled_from([1.0, 1.2, 1.5]))
def test_rectangle_bounds_the_enlarged_footprint_at_the_predicted_place(twist, ahead_s, scale):
    region = predict_region(
        ROBOT, ALL_ROUND, twist, 1.0, RegionConfig(footprint_scale=scale, ahead_s=ahead_s)
    )
    pose = moved_by_small_steps(twist, ahead_s)
    np.testing.assert_allclose(region.pose_ahead, pose, atol=1e-6)
    low, high = box_round_footprint(pose, scale * ROBOT.length, scale * ROBOT.width)
    rectangle = region.rectangle
    np.testing.assert_allclose([rectangle.x_min, rectangle.y_min], low, atol=1e-6)
    np.testing.assert_allclose([rectangle.x_max, rectangle.y_max], high, atol=1e-6)
    assert region.ahead_s == ahead_s


def test_chen_enlarges_the_footprint_by_a_fifth():
    region = predict_region(
        ROBOT, ALL_ROUND, np.array([1.0, 0.0, 0.0]), 1.0, RegionConfig(ahead_s=2.0)
    )
    expected = Rectangle(2.0 - 0.36, 2.0 + 0.36, -0.30, 0.30)
    np.testing.assert_allclose(region.rectangle.corners, expected.corners, atol=1e-12)


def test_length_and_width_default_to_the_track_width():
    region = predict_region(
        Robot(track_width=0.4),
        ALL_ROUND,
        np.array([1.0, 0.0, 0.0]),
        1.0,
        RegionConfig(ahead_s=1.0, footprint_scale=1.0),
    )
    expected = Rectangle(0.8, 1.2, -0.2, 0.2)
    np.testing.assert_allclose(region.rectangle.corners, expected.corners, atol=1e-12)


def test_a_robot_that_stands_has_no_region():
    assert predict_region(ROBOT, AHEAD, np.zeros(3), 0.0, RegionConfig()) == NoRegion(
        "the robot is stationary"
    )


@pytest.mark.parametrize(
    "twist",
    [
        pytest.param([0.0, 0.0, 1.0], id="turning on the spot"),
        pytest.param([-0.5, 0.0, 0.0], id="reversing"),
    ],
)
def test_where_the_camera_does_not_see_the_way_there_is_no_region(twist):
    region = predict_region(ROBOT, AHEAD, np.array(twist), 0.5, RegionConfig())
    assert region == NoRegion("the region lies outside the image")


def test_a_fixed_time_may_lie_outside_the_image():
    forward = np.array([0.5, 0.0, 0.0])
    near = predict_region(ROBOT, AHEAD, forward, 0.5, RegionConfig(ahead_s=0.2))
    assert near == NoRegion("the region lies outside the image")
    assert predict_region(ROBOT, AHEAD, forward, 0.5, RegionConfig(ahead_s=2.0)).ahead_s == 2.0


def test_the_search_ends_at_its_limits():
    forward, whole = np.array([0.5, 0.0, 0.0]), {"least_share": 1.0}
    found = predict_region(ROBOT, AHEAD, forward, 0.5, RegionConfig(**whole))
    for limit in (
        {"most_ahead_lengths": 0.9 * found.distance_ahead_m / ROBOT.length},
        {"most_ahead_s": 0.9 * found.ahead_s},
    ):
        ends = RegionConfig(**whole, **limit)
        assert isinstance(predict_region(ROBOT, AHEAD, forward, 0.5, ends), NoRegion)


@pytest.mark.parametrize("speed", [0.03, 0.5, 5.0])
def test_the_same_terrain_is_looked_at_however_slowly_the_robot_drives(speed):
    region = predict_region(ROBOT, AHEAD, np.array([speed, 0.0, 0.0]), speed, RegionConfig())
    usual = predict_region(ROBOT, AHEAD, np.array([1.0, 0.0, 0.0]), 1.0, RegionConfig())
    assert region.distance_ahead_m == pytest.approx(usual.distance_ahead_m, abs=0.01)


def test_a_camera_that_sees_the_robots_own_ground_looks_no_time_ahead():
    down = Camera.from_mount((640, 480), MATRIX, [], [0.0, 0.0, 2.0, 0.0, np.pi / 2, 0.0])
    region = predict_region(ROBOT, down, np.array([0.5, 0.0, 0.1]), 0.5, RegionConfig())
    assert region.ahead_s == region.distance_ahead_m == 0.0
    np.testing.assert_allclose(region.pose_ahead, 0.0, atol=1e-12)


def test_straight_ahead_the_treads_have_the_left_and_the_right_half():
    forward, apart = np.array([0.5, 0.0, 0.0]), RegionConfig(per_tread=True)
    left, right = predict_region(ROBOT, AHEAD, forward, 0.5, apart).rectangles
    (whole,) = predict_region(ROBOT, AHEAD, forward, 0.5, RegionConfig()).rectangles
    assert (left.x_min, left.x_max) == pytest.approx((whole.x_min, whole.x_max))
    assert (left.y_min, left.y_max) == pytest.approx((0.0, whole.y_max))
    assert (right.y_min, right.y_max) == pytest.approx((whole.y_min, 0.0))


def test_after_a_turn_the_halves_lie_along_the_heading_then():
    """Each half holds its four corners, carried to the pose ahead, and no more."""
    apart = RegionConfig(per_tread=True)
    region = predict_region(ROBOT, AHEAD, np.array([0.5, 0.0, 0.15]), 0.5, apart)
    x, y, yaw = region.pose_ahead
    assert yaw > 0.2
    length, width = 1.2 * ROBOT.length, 1.2 * ROBOT.width
    for rectangle, side in zip(region.rectangles, (1, -1), strict=True):
        ends, edges = (-length / 2, length / 2), (0, side * width / 2)
        corners = np.array([(a, b) for a in ends for b in edges])
        turned = corners @ np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
        turned += (x, y)
        low, high = turned.min(axis=0), turned.max(axis=0)
        assert (rectangle.x_min, rectangle.y_min) == pytest.approx(tuple(low))
        assert (rectangle.x_max, rectangle.y_max) == pytest.approx(tuple(high))


def test_a_large_robot_looks_farther_ahead():
    """2.1 m long, with a camera that sees the ground from 1.8 m on."""
    large = Robot(track_width=1.4, length=2.12, width=1.5)
    camera = Camera.from_mount((640, 480), MATRIX, [], [1.0, 0.0, 1.5, 0.0, 0.4, 0.0])
    region = predict_region(large, camera, np.array([1.0, 0.0, 0.0]), 1.0, RegionConfig())
    assert region.distance_ahead_m > 3.0


def test_corners_go_clockwise_in_the_image_from_far_left():
    pixels = AHEAD.ground_to_pixels(Rectangle(1.0, 1.5, -0.2, 0.3).corners)
    (far_left, far_right, near_right, near_left) = pixels
    assert far_left[0] < far_right[0]
    assert near_left[0] < near_right[0]
    assert max(far_left[1], far_right[1]) < min(near_left[1], near_right[1])


@pytest.mark.parametrize(
    "setting",
    [
        {"footprint_scale": 0.0},
        {"most_ahead_s": -1.0},
        {"most_ahead_lengths": 0.0},
        {"coarsest": 0.0},
        {"least_share": 0.0},
        {"least_share": 1.1},
        {"ahead_s": -0.1},
    ],
)
def test_settings_without_sense_are_refused(setting):
    with pytest.raises(ConfigError, match=next(iter(setting))):
        RegionConfig(**setting)


def test_a_region_keeps_its_own_pose_and_not_all_that_were_tried():
    """Regions of a long run are kept: a view of 200 poses would keep 5 kB with each."""
    region = predict_region(ROBOT, AHEAD, np.array([1.0, 0.0, 0.1]), 1.0, RegionConfig())
    assert region.pose_ahead.base is None
    assert region.pose_ahead.nbytes == 24
