"""The camera against OpenCV, against hand-worked numbers, and against itself there and back."""

import cv2
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from terrain.camera.camera import Camera
from terrain.camera.distortion import distort, radius_limit
from terrain.errors import CameraError

MATRIX = [[410.0, 0.0, 322.0], [0.0, 400.0, 236.0], [0.0, 0.0, 1.0]]
LENS = [-0.3, 0.1, 0.001, -0.002, 0.01]
MOUNT = [0.3, 0.05, 0.8, 0.04, 0.7, -0.1]


def mounted(distortion=LENS, mount=MOUNT):
    return Camera.from_mount((640, 480), MATRIX, distortion, mount)


def test_straight_down_by_hand():
    """1 m above (0.5, 0.2), looking down: a point 0.1 m ahead is up, 0.05 m to the left is left."""
    camera = mounted([], [0.5, 0.2, 1.0, 0.0, np.pi / 2, 0.0])
    pixel = camera.ground_to_pixels([0.6, 0.25])
    np.testing.assert_allclose(pixel, [322.0 - 410 * 0.05, 236.0 - 400 * 0.1], atol=1e-9)


def test_forty_five_degrees_by_hand():
    """At h = 1 m and 45 degrees down the axis meets the ground 1 m ahead, at the range sqrt(2)."""
    camera = mounted([], [0.0, 0.0, 1.0, 0.0, np.pi / 4, 0.0])
    np.testing.assert_allclose(camera.ground_to_pixels([1.0, 0.0]), [322.0, 236.0], atol=1e-9)
    np.testing.assert_allclose(
        camera.ground_to_pixels([1.0, -0.2]), [322.0 + 410 * 0.2 / np.sqrt(2), 236.0], atol=1e-9
    )
    # 2 m ahead lies atan(2) - 45 degrees above the axis
    above = 400 * np.tan(np.arctan(2.0) - np.pi / 4)
    np.testing.assert_allclose(camera.ground_to_pixels([2.0, 0.0])[1], 236.0 - above, atol=1e-9)


def test_positive_roll_lowers_the_right_side():
    """Rolled to the right, a camera sees the ground to its right higher in the image."""
    level, rolled = mounted([], [0, 0, 1, 0, 0.7, 0]), mounted([], [0, 0, 1, 0.2, 0.7, 0])
    right = [1.3, -0.3]
    assert rolled.ground_to_pixels(right)[1] < level.ground_to_pixels(right)[1] - 10


@pytest.mark.parametrize(
    "distortion",
    [
        [],
        [-0.1, 0.05, 0.001, -0.002],
        LENS,
        [-0.3, 0.1, 0.001, -0.002, 0.01, 0.02, 0.03, 0.004],
        [-0.3, 0.1, 0.001, -0.002, 0.01, 0.02, 0.03, 0.004, 0.001, 0.002, -0.001, 0.002],
        [-0.2, 0.1, 0.001, -0.002, 0.01, 0.02, 0.03, 0.004, 0, 0, 0, 0, 0.02, -0.01],
    ],
)
def test_agrees_with_opencv(distortion):
    """The same points through cv2.projectPoints with a rotation written out element by element."""
    roll, pitch, yaw = MOUNT[3:]
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    robot_from_camera = np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
    forward, left, up = robot_from_camera.T
    rotation = np.array([-left, -up, forward])
    x, y = np.meshgrid(np.linspace(0.8, 3.0, 9), np.linspace(-0.6, 0.7, 7))
    points = np.stack([x, y], axis=-1)
    in_space = np.concatenate([points, np.zeros((*x.shape, 1))], axis=-1).reshape(-1, 3)
    expected, _ = cv2.projectPoints(
        in_space,
        cv2.Rodrigues(rotation)[0],
        -rotation @ np.array(MOUNT[:3]),
        np.array(MATRIX),
        np.array(distortion) if distortion else None,
    )
    seen = mounted(distortion).ground_to_pixels(points)
    np.testing.assert_allclose(seen.reshape(-1, 2), expected.reshape(-1, 2), atol=1e-8)


@settings(max_examples=60, deadline=None)
@given(
    k1=st.floats(-0.4, 0.2),
    k2=st.floats(-0.1, 0.2),
    p1=st.floats(-0.005, 0.005),
    p2=st.floats(-0.005, 0.005),
    height=st.floats(0.2, 3.0),
    roll=st.floats(-0.4, 0.4),
    pitch=st.floats(0.1, 1.6),
    yaw=st.floats(-3.1, 3.1),
)
def test_there_and_back(*, k1, k2, p1, p2, height, roll, pitch, yaw):
    camera = mounted([k1, k2, p1, p2], [0.1, -0.2, height, roll, pitch, yaw])
    columns, rows = np.meshgrid(np.linspace(0, 639, 8), np.linspace(0, 479, 6))
    pixels = np.stack([columns, rows], axis=-1)
    ground = camera.pixels_to_ground(pixels)
    back = camera.ground_to_pixels(ground)
    on_ground = np.isfinite(ground).all(axis=-1)
    np.testing.assert_array_equal(np.isfinite(back).all(axis=-1), on_ground)
    # near the horizon metres run away, so that what is left of them in doubles is less
    near = on_ground & (np.linalg.norm(ground, axis=-1) < 1e3 * height)
    np.testing.assert_allclose(back[near], pixels[near], atol=1e-6)


def test_horizon_and_behind_have_no_answer():
    camera = mounted([], [0.0, 0.0, 1.0, 0.0, 0.3, 0.0])
    horizon_row = 236.0 - 400 * np.tan(0.3)
    rows = np.array([horizon_row - 50, horizon_row - 1e-6, horizon_row + 1])
    ground = camera.pixels_to_ground(np.column_stack([np.full(3, 322.0), rows]))
    np.testing.assert_array_equal(np.isnan(ground[:, 0]), [True, True, False])
    assert np.isnan(camera.ground_to_pixels([[-5.0, 0.0], [-0.5, 1.0]])).all()


def test_far_points_do_not_fold_into_the_image():
    """With k1 < 0 OpenCV's polynomial turns back: unchecked, points far aside land in the image."""
    distortion = np.array([-0.35, 0.0, 0.0, 0.0])
    camera = mounted(distortion, [0.0, 0.0, 1.0, 0.0, np.pi / 2, 0.0])
    aside = np.array([0.0, 1.6])
    unchecked, _ = cv2.projectPoints(
        np.array([[-aside[1], 0.0, 1.0]]), np.zeros(3), np.zeros(3), np.array(MATRIX), distortion
    )
    assert camera.in_image(unchecked.reshape(2))
    assert np.isnan(camera.ground_to_pixels(aside)).all()
    limit = 1 / np.sqrt(3 * 0.35)  # d/dr (r + k1 r^3) = 0
    assert np.isfinite(camera.ground_to_pixels([0.0, limit - 1e-3])).all()
    assert np.isnan(camera.ground_to_pixels([0.0, limit + 1e-3])).all()


@pytest.mark.parametrize(
    ("distortion", "aside_m"),
    [
        ([-0.5, 0.07, 0.0, 0.0], [0.0, 2.2]),  # past the second turn of the radial part
        ([0.0, 0.0, 0.0, -0.1], [0.0, -2.5]),  # past the fold of the tangential part
    ],
)
def test_no_point_past_a_fold_is_seen(distortion, aside_m):
    camera = mounted(distortion, [0.0, 0.0, 1.0, 0.0, np.pi / 2, 0.0])
    unchecked, _ = cv2.projectPoints(
        np.array([[-aside_m[1], 0.0, 1.0]]),
        np.zeros(3),
        np.zeros(3),
        np.array(MATRIX),
        np.array(distortion),
    )
    assert camera.in_image(unchecked.reshape(2))
    assert np.isnan(camera.ground_to_pixels(aside_m)).all()


@settings(max_examples=60, deadline=None)
@given(
    k1=st.floats(-0.4, 0.3),
    k2=st.floats(-0.2, 0.2),
    k3=st.floats(-0.1, 0.1),
    p1=st.floats(-0.01, 0.01),
    p2=st.floats(-0.01, 0.01),
)
@example(k1=-0.25, k2=-0.125, k3=1e-38, p1=0.0, p2=0.0)  # a vanishing leading coefficient
def test_every_seen_ground_point_is_found_again(*, k1, k2, k3, p1, p2):
    camera = mounted([k1, k2, p1, p2, k3], [0.1, -0.2, 1.0, 0.1, 0.9, 0.2])
    ground = np.stack(np.meshgrid(np.linspace(0.3, 2.5, 9), np.linspace(-1.2, 1.2, 9)), axis=-1)
    pixels = camera.ground_to_pixels(ground)
    seen = camera.in_image(pixels)
    assert seen.any()
    np.testing.assert_allclose(camera.pixels_to_ground(pixels[seen]), ground[seen], atol=1e-6)


@pytest.mark.parametrize("k1", [-2e-323, -1e-300, 5e-324])
def test_a_lens_of_next_to_no_distortion_bends_nothing(k1):
    """Its limit is a radius whose square no float holds."""
    points = np.array([[0.3, -0.7], [1e3, 0.0]])
    np.testing.assert_array_equal(distort(points, np.array([k1, 0.0, 0.0, 0.0])), points)


@pytest.mark.parametrize("scale", [1.0, -3.0, 1e-4])
def test_homography_of_any_scale_and_sign_is_the_same_camera(scale):
    one = mounted()
    other = Camera.from_homography((640, 480), MATRIX, LENS, scale * one.ground_to_image)
    points = np.random.default_rng(0).uniform([-3, -2], [5, 2], (200, 2))
    np.testing.assert_allclose(
        other.ground_to_pixels(points), one.ground_to_pixels(points), rtol=1e-10
    )


def test_undistorted_pixels_share_the_matrix():
    """A dot painted where the lens puts a ground point moves to where the homography puts it."""
    camera = mounted()
    image = np.zeros((480, 640), np.uint8)
    u, v = camera.ground_to_pixels([1.6, 0.45])
    cv2.circle(image, (round(u), round(v)), 3, 255, -1)
    undistorted = cv2.undistort(image, camera.matrix, camera.distortion)
    rows, columns = np.nonzero(undistorted > 100)
    x, y, w = camera.ground_to_image @ [1.6, 0.45, 1.0]
    np.testing.assert_allclose([columns.mean(), rows.mean()], [x / w, y / w], atol=0.8)
    assert np.hypot(u - x / w, v - y / w) > 5


def test_image_borders():
    inside = mounted().in_image([[0, 0], [639, 479], [-0.1, 0], [0, 479.1], [np.nan, 1]])
    np.testing.assert_array_equal(inside, [True, True, False, False, False])


def test_an_image_of_another_size_is_refused():
    with pytest.raises(CameraError, match="480x640 pixels, the camera's are 640x480"):
        mounted().check_size(np.zeros((640, 480), np.uint8))


@pytest.mark.parametrize(("p1", "p2"), [(0.0, 0.0), (0.05, -0.02), (-0.1, 0.15), (0.4, 0.3)])
def test_a_lens_holds_where_it_neither_turns_back_nor_folds(p1, p2):
    """Against the sign of the determinant of OpenCV's own derivatives by differences."""
    lens = np.array([-0.2, 0.03, p1, p2, 0.0])
    share = np.linspace(-1.6, 1.6, 81)
    points = np.stack(np.meshgrid(share, share), axis=-1).reshape(-1, 2)

    def by_opencv(at):
        rays = np.column_stack([at, np.ones(len(at))])
        return cv2.projectPoints(rays, np.zeros(3), np.zeros(3), np.eye(3), lens)[0][:, 0]

    by_x, by_y = (
        (by_opencv(points + aside) - by_opencv(points - aside)) / 2e-6 for aside in 1e-6 * np.eye(2)
    )
    determinant = by_x[:, 0] * by_y[:, 1] - by_x[:, 1] * by_y[:, 0]
    clear = np.abs(determinant) > 1e-4
    holds = (determinant > 0) & (np.hypot(*points.T) <= radius_limit(lens))
    found = distort(points, lens)
    np.testing.assert_array_equal(np.isfinite(found).all(axis=1)[clear], holds[clear])
    np.testing.assert_allclose(found[holds & clear], by_opencv(points)[holds & clear], atol=1e-9)
