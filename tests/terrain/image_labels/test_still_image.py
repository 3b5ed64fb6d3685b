"""An image that stays though the robot moves, and images of which that must not be said."""

import cv2
import numpy as np
import pytest

from odometry.geometry import se2
from terrain.camera.camera import Camera
from terrain.image_labels.still_image import StillImage, StillWatch, details_of

SIZE = (320, 240)
MATRIX = [[230, 0, 159.5], [0, 230, 119.5], [0, 0, 1]]
PX_M = 0.004
STEP = np.array([0.12, 0.0, 0.03])


def down(pitch_deg):
    return Camera.from_mount(SIZE, MATRIX, [0] * 4, [0.1, 0, 0.8, 0, np.radians(pitch_deg), 0])


@pytest.fixture(scope="module")
def terrain():
    """Greys (2000, 2000) of random terrain around the origin."""
    rough = np.random.default_rng(4).normal(0, 1, (2000, 2000))
    return 120 + 60 * cv2.GaussianBlur(rough, (0, 0), 2.0) * 4


def seen(terrain, camera, pose=(0, 0, 0), noise=0.0, seed=0):
    """What the camera of a robot at a pose shows; above the horizon a skyline far away."""
    pixels = np.stack(np.meshgrid(*map(np.arange, SIZE)), axis=-1).reshape(-1, 2)
    x, y = se2.transform(np.array(pose, float), camera.pixels_to_ground(pixels)).T / PX_M + 1000
    far = ~(np.hypot(x - 1000, y - 1000) < 980)
    u, v = (np.where(far, -1, of).reshape(SIZE[::-1]).astype(np.float32) for of in (x, y))
    image = cv2.remap(terrain, u, v, cv2.INTER_LINEAR)
    skyline = cv2.GaussianBlur(np.random.default_rng(9).normal(120, 90, SIZE[::-1]), (0, 0), 2.0)
    image = np.where(far.reshape(SIZE[::-1]), skyline, image)
    image = image + np.random.default_rng(seed).normal(0, noise, image.shape)
    return np.clip(image, 0, 255).astype(np.uint8)


def stays(camera, before, after, step=STEP):
    return StillImage(camera).stays(details_of(before), details_of(after), step)


def recompressed(image):
    encoded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 60])[1]
    return cv2.imdecode(encoded, cv2.IMREAD_GRAYSCALE)


def with_clock(image):
    return cv2.putText(image.copy(), "23:59:01", (5, 20), 0, 0.6, 255, 2)


CHANGES = [
    lambda image: image,
    lambda image: np.clip(image + np.random.default_rng(2).normal(0, 8, image.shape), 0, 255),
    lambda image: np.clip(1.15 * image + 5, 0, 255),
    recompressed,
    with_clock,
]


@pytest.mark.parametrize("change", CHANGES, ids=["same", "noise", "light", "jpeg", "clock"])
def test_a_frozen_view_is_found_whatever_else_changes(terrain, change):
    camera = down(40)
    image = seen(terrain, camera)
    assert stays(camera, image, change(image).astype(np.uint8)) is True


@pytest.mark.parametrize("pitch_deg", [10, 25, 40])
@pytest.mark.parametrize("step", [STEP, np.array([0.12, 0, 0]), np.array([0.0, 0, 0.2])])
def test_terrain_that_moves_is_none_with_a_far_horizon_as_well(terrain, pitch_deg, step):
    camera = down(pitch_deg)
    images = seen(terrain, camera, noise=2), seen(terrain, camera, step, noise=2, seed=1)
    assert stays(camera, *images, step) is False


def test_parts_of_the_robot_and_dirt_may_stay(terrain):
    camera = down(40)
    before, after = seen(terrain, camera), seen(terrain, camera, STEP)
    rng = np.random.default_rng(3)
    for image in (before, after):
        image[:, 60:240] = cv2.resize(seen(terrain, down(70), (1, 1, 1)), SIZE)[:, 60:240]
    assert stays(camera, before, after) is False
    dirt = np.zeros(SIZE[::-1])
    for u, v, radius in zip(*rng.uniform(0, SIZE[0], (2, 30)), rng.uniform(8, 25, 30), strict=True):
        cv2.circle(dirt, (int(u), int(v)), int(radius), 0.8, -1)
    dirt = cv2.GaussianBlur(dirt, (0, 0), 4)
    smooth = 120 + (terrain - 120) / 4
    images = (seen(smooth, camera, pose) * (1 - dirt) for pose in ((0, 0, 0), STEP))
    assert stays(camera, *(image.astype(np.uint8) for image in images)) is False


def test_stripes_along_the_way_are_no_frozen_view(terrain):
    camera, step = down(40), np.array([0.12, 0, 0])
    furrows = np.repeat(terrain[:, 1000][:, None], 2000, axis=1)
    assert stays(camera, seen(furrows, camera), seen(furrows, camera, step), step) is False


def test_a_frozen_view_is_found_where_the_terrain_has_left_it(terrain):
    camera, step = down(60), np.array([1.5, 0, 0])
    image = seen(terrain, camera)
    assert stays(camera, image, CHANGES[1](image).astype(np.uint8), step) is True
    assert stays(camera, image, seen(terrain, camera, step), step) is False
    furrows = np.repeat(terrain[:, 1000][:, None], 2000, axis=1)
    rough = 120 + 0.9 * (furrows - 120) + 0.4 * (terrain - 120)
    images = seen(rough, camera), seen(rough, camera, step)
    assert stays(camera, *images, step) is False


def test_noise_alone_is_no_frozen_view():
    rng = np.random.default_rng(5)
    images = [np.clip(rng.normal(100, 20, SIZE[::-1]), 0, 255).astype(np.uint8) for _ in range(2)]
    assert stays(down(40), *images) is False


def test_a_robot_that_stands_says_nothing(terrain):
    image = seen(terrain, down(40))
    assert stays(down(40), image, image, np.array([0.01, 0, 0])) is None


def test_the_answer_holds_while_the_robot_stands_and_ends_when_the_view_moves(terrain):
    camera = down(40)
    watch = StillWatch(camera)
    first, other = seen(terrain, camera), seen(terrain, camera, (0.5, 0, 0))
    poses_m = [0.0, 0.01, 0.2, 0.21, 0.4, 0.6]
    images = [first, first, first, first, first, other]
    answers = [
        watch.stays(image, np.array([x, 0.0, 0.0]))
        for x, image in zip(poses_m, images, strict=True)
    ]
    assert answers == [False, False, True, True, True, False]
