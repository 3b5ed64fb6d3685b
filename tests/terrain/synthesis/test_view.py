"""What is rendered lies where the camera model says, from every pose."""

import cv2
import numpy as np
import pytest
import skimage.data

from odometry.simulation.ground import GroundMap, to_world
from terrain.camera.camera import Camera
from terrain.errors import SynthesisError
from terrain.region.region import Rectangle
from terrain.region.warp import ground_view
from terrain.synthesis.config import default_camera
from terrain.synthesis.texture import Texture
from terrain.synthesis.view import (
    NOISE_GREY_LEVELS,
    SKY_BRIGHTNESS,
    Illumination,
    Scene,
    View,
    encode_jpeg,
    expose,
    jpeg_image,
)


@pytest.fixture(scope="module")
def camera():
    return default_camera()


@pytest.fixture(scope="module")
def view(camera):
    return View.of(camera)


def laid(photo, **where):
    choice = {"angle_rad": 0.4, "photo_point_px": (0, 0), "world_point": (0, 0)} | where
    return Texture.laid(photo, 0.003, **choice)


def test_edge_of_zones_is_seen_where_the_camera_puts_it(camera, view):
    """Black ground up to x = 5, white beyond: the step in each column is at the edge's pixel."""
    black, white = (laid(np.full((64, 64), level, np.uint8)) for level in (0, 255))
    ground = GroundMap(np.array([5.0]), ("black", "white"))
    pose = np.array([3.6, 0.4, 0.3])
    image = Scene(view, ground, (black, white)).brightness(pose)
    y = np.linspace(-3, 3, 4001)
    in_robot = to_world(
        np.array([0.0, 0.0, -pose[2]]), np.column_stack([np.full_like(y, 5.0), y]) - pose[:2]
    )
    edge = camera.ground_to_pixels(in_robot)
    edge = edge[camera.in_image(edge)]
    assert np.ptp(edge[:, 0]) > 500
    order = np.argsort(edge[:, 0])
    for column in range(20, 620, 50):
        row = np.interp(column, edge[order, 0], edge[order, 1])
        if 5 < row < 475:
            assert (image[: int(np.floor(row)), column] > 254).all()
            assert (image[int(np.ceil(row)) + 1 :, column] == 0).all()


def test_photograph_seen_from_above_is_the_photograph(camera, view):
    """Laid upright ahead of the robot, rendered, warped back: the same picture, not mirrored."""
    photo = skimage.data.grass()[100:228, 200:328]
    edge = 128 * 0.003
    texture = laid(photo, angle_rad=-np.pi / 2, photo_point_px=(64, 64), world_point=(1.05, 0.0))
    scene = Scene(view, GroundMap(np.empty(0), ("grass",)), (texture,))
    image = np.clip(scene.brightness(np.zeros(3)), 0, 255).astype(np.uint8)
    square = Rectangle(1.05 - edge / 2, 1.05 + edge / 2, -edge / 2, edge / 2)
    seen = ground_view(image, camera, square, 0.003).astype(float)
    blurred = cv2.GaussianBlur(photo.astype(float), (0, 0), 0.6)
    assert seen.shape == photo.shape
    assert np.corrcoef(seen.ravel(), blurred.ravel())[0, 1] > 0.93
    assert np.corrcoef(seen.ravel(), blurred[:, ::-1].ravel())[0, 1] < 0.3


def warped_from(before, camera, view, pose_before, pose_after):
    """The later frame made of the earlier one through the ground plane; NaN where it is unseen."""
    points_world = to_world(pose_after, view.points_robot)
    in_before = to_world(
        np.array([0.0, 0.0, -pose_before[2]]), points_world - np.asarray(pose_before[:2])
    )
    pixels = camera.ground_to_pixels(in_before)
    seen = camera.in_image(pixels)
    pixels = np.nan_to_num(pixels, nan=-1.0).astype(np.float32)
    warped = cv2.remap(before.astype(np.float32), pixels[..., 0], pixels[..., 1], cv2.INTER_LINEAR)
    return np.where(seen, warped, np.nan)


def test_ground_stays_put_while_the_robot_moves(camera, view):
    texture = laid(skimage.data.gravel()[:, :256])
    scene = Scene(view, GroundMap(np.empty(0), ("gravel",)), (texture,))
    rng, light = np.random.default_rng(5), Illumination(1.0, 0.0)
    poses = np.array([2.0, 0.3, 0.5]), np.array([2.13, 0.36, 0.56])
    before, after = (expose(scene.brightness(pose), light, rng) for pose in poses)

    def agreement(pose_after):
        warped = warped_from(before, camera, view, poses[0], pose_after)
        both = np.isfinite(warped)
        assert both.mean() > 0.5
        return np.corrcoef(warped[both], after[both])[0, 1]

    assert agreement(poses[1]) > 0.9
    assert agreement(poses[1] + [0.05, 0.0, 0.0]) < 0.4


def test_sky_and_cameras_without_ground():
    level = Camera.from_mount(
        (64, 48), [[60, 0, 31.5], [0, 60, 23.5], [0, 0, 1]], [], [0, 0, 1, 0, 0, 0]
    )
    ground = GroundMap(np.empty(0), ("black",))
    image = Scene(View.of(level), ground, (laid(np.zeros((32, 32), np.uint8)),)).brightness(
        np.zeros(3)
    )
    assert (image[:23] == SKY_BRIGHTNESS).all()
    assert (image[25:] == 0).all()
    up = Camera.from_mount((64, 48), level.matrix, [], [0, 0, 1, 0, -1.0, 0])
    with pytest.raises(SynthesisError, match="shows no terrain"):
        View.of(up)


def test_exposure_has_its_gain_slope_and_noise():
    rng = np.random.default_rng(6)
    image = expose(np.full((200, 201), 100, np.float32), Illumination(1.1, 0.1), rng).astype(float)
    columns = image.mean(axis=0)
    np.testing.assert_allclose(columns[[0, 100, 200]], [99.0, 110.0, 121.0], atol=0.6)
    assert (image - columns).std() == pytest.approx(np.hypot(NOISE_GREY_LEVELS, 0.29), rel=0.05)


def test_light_changes_slowly():
    gains = [Illumination.at(t, (0.0, 0.0)).gain for t in np.arange(0, 60, 0.25)]
    assert np.ptp(gains) == pytest.approx(0.16, abs=0.01)
    assert np.abs(np.diff(gains)).max() < 0.01


def test_jpeg_keeps_the_order_of_colours():
    image = np.zeros((32, 32, 3), np.uint8)
    image[..., 0] = 200
    decoded = jpeg_image(encode_jpeg(image, 95))
    np.testing.assert_allclose(decoded.mean(axis=(0, 1)), [200, 0, 0], atol=4)
    assert jpeg_image(encode_jpeg(image[..., 0], 95)).shape == (32, 32)


def test_default_camera_resolves_patches_at_the_region(view):
    """A pixel about 1 m ahead is at most 1.5 times the patches' 3 mm; the region takes up to 2."""
    points = view.points_robot
    near = (np.abs(points[..., 0] - 1.0) < 0.02) & (np.abs(points[..., 1]) < 0.3)
    assert view.detail_m[near].max() < 1.5 * 0.003
