"""The table [camera]: read, written, and refused where it is none; outlines of the robot."""

import numpy as np
import pytest

from terrain.camera.camera import Camera
from terrain.errors import CameraError
from tests.terrain.camera.test_camera import LENS, MATRIX, mounted


def test_table_round_trip():
    one = mounted()
    for camera in (one, Camera.from_homography((640, 480), MATRIX, LENS, one.ground_to_image)):
        again = Camera.from_table(camera.to_table() | {"note": "ignored"})
        assert again.to_table() == camera.to_table()


TABLE = mounted().to_table()
BUMPER = [[0, 400], [639, 400], [639, 479], [0, 479]]


def test_the_image_shows_no_terrain_where_it_shows_the_robot():
    camera = Camera.from_table(TABLE | {"robot_outlines": [BUMPER, [[10, 10], [30, 10], [10, 30]]]})
    shown = {(320, 390): True, (320, 400): False, (0, 479): False, (14, 14): False, (28, 28): True}
    pixels = np.array([*shown, (np.nan, 420), (320, 480)])
    np.testing.assert_array_equal(camera.in_image(pixels), [True] * 5 + [False] * 2)
    np.testing.assert_array_equal(camera.shows_terrain(pixels), [*shown.values(), False, False])
    assert camera.shows_terrain([320.0, 390.4])
    again = Camera.from_table(camera.to_table())
    np.testing.assert_array_equal(again.robot_outlines[0], BUMPER)
    assert "robot_outlines" not in TABLE


@pytest.mark.parametrize(
    ("outlines", "said"),
    [
        ("all", "robot_outlines = 'all', expected polygons"),
        ([[[0, 0], [10, 0]]], "robot_outlines\\[0\\] = .*, expected at least 3 pixels"),
        ([BUMPER, [0, 0, 5]], "robot_outlines\\[1\\] has shape|robot_outlines\\[1\\] must hold"),
        ([[[0, 0], [700, 0], [0, 20]]], "corner \\[700.0, 0.0\\], .* of 640x480 pixels"),
        ([[[0, 0], [float("nan"), 0], [0, 20]]], "not finite"),
    ],
)
def test_outlines_that_are_none_are_refused(outlines, said):
    with pytest.raises(CameraError, match=said):
        Camera.from_table(TABLE | {"robot_outlines": outlines})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"matrix": None}, "matrix must|matrix has shape"),
        ({"matrix": [[1, 0], [0, 1]]}, r"shape \(2, 2\)"),
        ({"matrix": [[0, 0, 1], [0, 1, 1], [0, 0, 1]]}, "positive fx and fy"),
        ({"matrix": [[1e-300, 0, 1], [0, 9, 1], [0, 0, 1]]}, "positive fx and fy"),
        ({"matrix": [[9, 1, 1], [0, 9, 1], [0, 0, 1]]}, r"fx, 0, cx"),
        ({"image_size": [640.5, 480]}, "whole numbers"),
        ({"image_size": [0, 480]}, "whole numbers"),
        ({"distortion": [1, 2, 3]}, "3 values"),
        ({"distortion": [float("nan")] * 4}, "not finite"),
        ({"mount": [0, 0, -1, 0, 0, 0]}, "above the ground"),
        ({"distortion": [[1], [1, 2], [3], [4]]}, "must hold numbers"),
        ({"distortion": 3}, "1 values"),
        ({"mount": [0, 0, 1e300, 0, 0, 0]}, "above 1e"),
        ({"image_size": [1e5, 1e5]}, "at most 64000000 pixels"),
        ({"mount": "high"}, "must hold numbers"),
        ({"ground_to_image": np.eye(3).tolist()}, "mount and ground_to_image$"),
    ],
)
def test_wrong_tables(change, message):
    with pytest.raises(CameraError, match=message) as error:
        Camera.from_table(TABLE | change, where="my_run/run.toml")
    assert str(error.value).startswith("my_run/run.toml: [camera] ")


@pytest.mark.parametrize("key", ["image_size", "matrix", "distortion", "mount"])
def test_missing_keys(key):
    table = {name: value for name, value in TABLE.items() if name != key}
    with pytest.raises(CameraError, match="neither" if key == "mount" else f"{key} missing"):
        Camera.from_table(table)


def test_singular_homography():
    with pytest.raises(CameraError, match="singular"):
        Camera.from_homography((640, 480), MATRIX, [], [[1, 2, 3], [2, 4, 6], [0, 0, 1]])
