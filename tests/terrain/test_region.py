"""The region ahead: Chen 2023 eq. 22, the predicted place, and when there is no region."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from odometry.errors import ConfigError
from odometry.run import Robot
from terrain.camera import Camera
from terrain.region import Rectangle, Region, RegionConfig, predict_region

ROBOT = Robot(track_width=0.4, length=0.6, width=0.5)
MATRIX = [[300.0, 0.0, 320.0], [0.0, 300.0, 240.0], [0.0, 0.0, 1.0]]
MOUNT = [0.3, 0.0, 0.9, 0.0, 0.8, 0.0]
AHEAD = Camera.from_mount((640, 480), MATRIX, [], MOUNT)
ALL_ROUND = Camera.from_mount(  # 200 m above, looking down: every place that is near lies in it
    (640, 480), MATRIX, [], [0.0, 0.0, 200.0, 0.0, np.pi / 2, 0.0]
)

speeds = st.floats(-2.0, 2.0)
twists = st.tuples(speeds, st.floats(-0.5, 0.5), st.floats(-1.5, 1.5)).map(np.array)


def moved_by_small_steps(twist, duration_s, steps=20_000):
    """Place and heading by Euler's midpoint rule in the plane, without sine or cosine ratios."""
    step_s = duration_s / steps
    yaw = twist[2] * step_s * (np.arange(steps) + 0.5)
    x = np.sum(twist[0] * np.cos(yaw) - twist[1] * np.sin(yaw)) * step_s
    y = np.sum(twist[0] * np.sin(yaw) + twist[1] * np.cos(yaw)) * step_s
    return np.array([x, y, twist[2] * duration_s])


def box_round_footprint(pose, length, width):
    """Least and largest x and y of the corners of a turned rectangle, one corner at a time."""
    corners = []
    for along in (-length / 2, length / 2):
        for across in (-width / 2, width / 2):
            x = pose[0] + along * np.cos(pose[2]) - across * np.sin(pose[2])
            y = pose[1] + along * np.sin(pose[2]) + across * np.cos(pose[2])
            corners.append((x, y))
    return np.min(corners, axis=0), np.max(corners, axis=0)


def outline(rectangle, points_a_side=1000):
    """Points round a rectangle."""
    part = np.linspace(0.0, 1.0, points_a_side)
    x = rectangle.x_min + part * (rectangle.x_max - rectangle.x_min)
    y = rectangle.y_min + part * (rectangle.y_max - rectangle.y_min)
    one = np.ones(points_a_side)
    sides = [(x, rectangle.y_min * one), (x, rectangle.y_max * one)]
    sides += [(rectangle.x_min * one, y), (rectangle.x_max * one, y)]
    return np.concatenate([np.column_stack(side) for side in sides])


def pixels_outside(camera, rectangle):
    """How many pixels the outline of a rectangle lies outside the image, at its worst."""
    pixels = camera.ground_to_pixels(outline(rectangle))
    beyond = np.concatenate([-pixels, pixels - (np.array(camera.image_size) - 1)])
    return np.inf if np.isnan(beyond).any() else beyond.max()


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


def corners_of_footprint(pose, length, width):
    """Corners (4, 2) of a turned rectangle."""
    x, y, yaw = pose
    turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    ends = [(1, 1), (1, -1), (-1, -1), (-1, 1)]
    return np.array(ends) * [length / 2, width / 2] @ turn + [x, y]


def pose_on_circle(travel_m, curvature):
    """Where a robot is that drives along a circle."""
    yaw = curvature * travel_m
    chord = 2 * np.sin(yaw / 2) / curvature if abs(curvature) > 1e-9 else travel_m
    return np.array([chord * np.cos(yaw / 2), chord * np.sin(yaw / 2), yaw])


def seen(camera, points):
    """Whether the image holds points (..., 2)."""
    u, v = np.moveaxis(camera.ground_to_pixels(points), -1, 0)
    width, height = camera.image_size
    return (u >= 0) & (u <= width - 1) & (v >= 0) & (v <= height - 1)


@settings(max_examples=25)
@given(
    speed=st.floats(0.1, 2.0),
    curvature=st.floats(-0.3, 0.3),
    pitch=st.floats(0.6, 1.2),
    camera_yaw=st.floats(-0.2, 0.2),
    focal=st.floats(200.0, 400.0),
)
def test_default_time_is_the_smallest_for_which_all_of_the_footprint_is_in_sight(
    speed, curvature, pitch, camera_yaw, focal
):
    """Against a search in steps of 5 mm; without a lens the corners of a rectangle suffice."""
    matrix = [[focal, 0, 320.0], [0, focal, 240.0], [0, 0, 1]]
    camera = Camera.from_mount((640, 480), matrix, [], [0.3, 0.0, 0.9, 0.0, pitch, camera_yaw])
    twist = np.array([speed, 0.0, speed * curvature])
    region = predict_region(ROBOT, camera, twist, speed, RegionConfig(least_share=1.0))
    travels_m = np.arange(0.0, 3.6, 0.005)
    footprints = [corners_of_footprint(pose_on_circle(d, curvature), 0.72, 0.6) for d in travels_m]
    found_m = travels_m[seen(camera, np.array(footprints)).all(axis=1)]
    assume(not len(found_m) or found_m[0] < 3.57)  # a step may end just before or after the limit
    if not len(found_m):
        assert region == "the region lies outside the image"
    else:
        assert isinstance(region, Region)
        assert found_m[0] - 0.0051 <= region.ahead_s * speed <= found_m[0] + 3.6 / 199
        assert region.distance_ahead_m == pytest.approx(region.ahead_s * speed)


@settings(max_examples=40)
@given(
    curvature=st.floats(0.0, 2.5),
    camera_yaw=st.floats(-0.8, 0.8),
    least_share=st.sampled_from([0.4, 0.6, 0.8]),
)
def test_where_a_corner_stays_outside_the_visible_part_is_the_region(
    curvature, camera_yaw, least_share
):
    """Against points strewn over the footprint, each carried there by itself."""
    camera = Camera.from_mount((640, 480), MATRIX, [], [*MOUNT[:5], camera_yaw])
    twist = np.array([1.0, 0.0, curvature])
    region = predict_region(ROBOT, camera, twist, 1.0, RegionConfig(least_share=least_share))
    strewn = np.random.default_rng(0).uniform(-0.5, 0.5, (400, 2)) * [0.72, 0.6]
    poses = np.array([pose_on_circle(travel_m, curvature) for travel_m in np.arange(0, 3.6, 0.02)])
    places = poses[:, 0] + 1j * poses[:, 1]
    carried = places[:, None] + (strewn @ [1, 1j]) * np.exp(1j * poses[:, 2:])
    middle = seen(camera, np.column_stack([places.real, places.imag]))
    shares = middle * seen(camera, np.stack([carried.real, carried.imag], axis=-1)).mean(axis=1)
    most = max(shares)
    if isinstance(region, str):
        assert region == "the region lies outside the image"
        assert most < least_share + 0.08  # 49 points tell a share by so much
        return
    assert most > least_share - 0.08
    reached = shares[min(round(region.distance_ahead_m / 0.02), len(shares) - 1)]
    assert reached > max(least_share, most - (1 - least_share) / 3) - 0.12
    low, high = box_round_footprint(region.pose_ahead, 0.72, 0.6)
    shown = region.rectangle
    assert (shown.x_min, shown.y_min) >= tuple(low - 1e-9)
    assert shown.x_max <= high[0] + 1e-9
    assert shown.y_max <= high[1] + 1e-9
    assert pixels_outside(camera, shown) < 1e-6


def test_the_place_is_the_middle_of_what_is_labelled():
    """At the time given the near half is out of sight: the label belongs to the far half."""
    forward = np.array([1.0, 0.0, 0.0])
    whole = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig())
    np.testing.assert_allclose(whole.place, whole.pose_ahead[:2], atol=1e-12)
    nearer = RegionConfig(ahead_s=whole.ahead_s - 0.2)
    part = predict_region(ROBOT, AHEAD, forward, 1.0, nearer)
    assert part.rectangle.x_max == pytest.approx(whole.rectangle.x_max - 0.2)
    assert part.rectangle.x_min >= whole.rectangle.x_min - 0.05
    assert part.place[0] > part.pose_ahead[0] + 0.05


def test_the_region_is_the_first_that_can_be_classified():
    """A stand-in that can read no region nearer than 1.5 m."""
    forward = np.array([1.0, 0.0, 0.0])

    def unsuited(rectangle):
        return "too near" if rectangle.x_min < 1.5 else ""

    region = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig(), unsuited=unsuited)
    assert 1.5 <= region.rectangle.x_min < 1.9
    never = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig(), unsuited=lambda _: "no")
    assert never == "no"


def test_coarse_ground_is_as_good_as_out_of_sight():
    """0.9 m above the ground and with 300 px, 0.013 m a pixel is some 2 m away."""
    forward = np.array([1.0, 0.0, 0.0])
    fine = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig(ahead_s=2.0), coarsest_m=0.013)
    whole = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig(ahead_s=2.0))
    assert fine.rectangle.x_min == whole.rectangle.x_min
    assert 1.8 < fine.rectangle.x_max < whole.rectangle.x_max
    none = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig(), coarsest_m=0.001)
    assert none == "the image is too coarse there"


@settings(max_examples=50)
@given(
    k1=st.floats(-0.35, 0.3),
    k2=st.floats(-0.05, 0.1),
    focal=st.floats(150.0, 400.0),
    pitch=st.floats(0.5, 1.2),
    camera_yaw=st.floats(-0.2, 0.2),
    omega=st.floats(-0.4, 0.4),
)
def test_the_whole_region_lies_in_the_image_of_a_curved_lens(
    *, k1, k2, focal, pitch, camera_yaw, omega
):
    """Sides bulge: the corners alone may lie in the image and the side between them not."""
    matrix = [[focal, 0, 320.0], [0, focal, 240.0], [0, 0, 1]]
    mount = [0.3, 0.0, 0.8, 0.0, pitch, camera_yaw]
    camera = Camera.from_mount((640, 480), matrix, [k1, k2, 0.001, -0.001], mount)
    region = predict_region(ROBOT, camera, np.array([1.0, 0.0, omega]), 1.0, RegionConfig())
    assume(isinstance(region, Region))
    assert pixels_outside(camera, region.rectangle) < 0.5  # the area of a pixel reaches that far


def test_a_robot_that_stands_has_no_region():
    assert predict_region(ROBOT, AHEAD, np.zeros(3), 0.0, RegionConfig()) == "the robot stands"


@pytest.mark.parametrize(
    "twist",
    [
        pytest.param([0.0, 0.0, 1.0], id="turning on the spot"),
        pytest.param([-0.5, 0.0, 0.0], id="reversing"),
    ],
)
def test_where_the_camera_does_not_see_the_way_there_is_no_region(twist):
    region = predict_region(ROBOT, AHEAD, np.array(twist), 0.5, RegionConfig())
    assert region == "the region lies outside the image"


def test_a_fixed_time_may_lie_outside_the_image():
    forward = np.array([0.5, 0.0, 0.0])
    near = predict_region(ROBOT, AHEAD, forward, 0.5, RegionConfig(ahead_s=0.2))
    assert near == "the region lies outside the image"
    assert predict_region(ROBOT, AHEAD, forward, 0.5, RegionConfig(ahead_s=2.0)).ahead_s == 2.0


def test_the_search_ends_at_its_limits():
    forward, whole = np.array([0.5, 0.0, 0.0]), {"least_share": 1.0}
    found = predict_region(ROBOT, AHEAD, forward, 0.5, RegionConfig(**whole))
    for limit in (
        {"most_ahead_lengths": 0.9 * found.distance_ahead_m / ROBOT.length},
        {"most_ahead_s": 0.9 * found.ahead_s},
    ):
        ends = RegionConfig(**whole, **limit)
        assert isinstance(predict_region(ROBOT, AHEAD, forward, 0.5, ends), str)


@pytest.mark.parametrize("speed", [0.03, 0.5, 5.0])
def test_the_same_ground_is_looked_at_however_slowly_the_robot_drives(speed):
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
