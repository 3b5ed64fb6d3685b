"""Calibration files of ROS, Kalibr and OpenCV, against what wrote them and against cv2."""

import json

import cv2
import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from terrain.camera_files.read import read_calibration
from terrain.errors import CameraError

MATRIX = [[501.5, 0.0, 322.25], [0.0, 499.0, 239.0], [0.0, 0.0, 1.0]]
FLAT = [value for row in MATRIX for value in row]
LENS = [-0.3, 0.1, 1e-05, -0.002, 0.01]
ROS = f"""image_width: 640
image_height: 480
camera_name: front
camera_matrix:
  rows: 3
  cols: 3
  data: {FLAT}
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: {LENS}
"""
ECHO = f"""header:
  frame_id: front_optical
height: 480
width: 640
distortion_model: plumb_bob
d: {LENS}
k:
{"".join(f"- {value}{chr(10)}" for value in FLAT)}binning_x: 0
---
height: 480
"""
KALIBR = """cam0:
  camera_model: pinhole
  intrinsics: [501.5, 499.0, 322.25, 239.0]
  distortion_model: radtan
  distortion_coeffs: [-0.3, 0.1, 1.0e-05, -0.002]
  resolution: [640, 480]
  T_cam_imu:
  - [0.0, -1.0, 0.0, 0.1]
  - [0.0, 0.0, -1.0, 0.2]
  - [1.0, 0.0, 0.0, 0.3]
  - [0.0, 0.0, 0.0, 1.0]
cam1:
  camera_model: pinhole
  intrinsics: [300.0, 300.0, 370.0, 240.0]
  distortion_model: equidistant
  distortion_coeffs: [-0.01, 0.02, -0.01, 0.002]
  resolution: [752, 480]
"""


def written(tmp_path, text, name="camera.yaml"):
    file = tmp_path / name
    file.write_text(text)
    return file


@pytest.mark.parametrize("text", [ROS, ECHO], ids=["file", "topic"])
def test_ros(tmp_path, text):
    found = read_calibration(written(tmp_path, text))
    assert found.lens.image_size == (640, 480)
    np.testing.assert_array_equal(found.lens.matrix, MATRIX)
    np.testing.assert_array_equal(found.lens.distortion, LENS)
    assert found.name == ("front" if text is ROS else "")


def test_kalibr(tmp_path):
    found = read_calibration(written(tmp_path, KALIBR), name="cam0")
    np.testing.assert_array_equal(found.lens.matrix, MATRIX)
    np.testing.assert_array_equal(found.lens.distortion, LENS[:4])
    np.testing.assert_allclose(found.camera_from_imu[:3, 3], [0.1, 0.2, 0.3])
    assert found.name == "cam0"


@pytest.mark.parametrize("suffix", ["yaml", "yml", "xml", "json"])
@pytest.mark.parametrize("names", [("camera_matrix", "distortion_coefficients"), ("K", "D")])
def test_opencvs_own_files(tmp_path, suffix, names):
    file = tmp_path / f"camera.{suffix}"
    storage = cv2.FileStorage(str(file), cv2.FILE_STORAGE_WRITE)
    storage.write("image_width", 640)
    storage.write("image_height", 480)
    storage.write(names[0], np.array(MATRIX))
    storage.write(names[1], np.array([LENS]))
    storage.release()
    found = read_calibration(file)
    assert found.lens.image_size == (640, 480)
    np.testing.assert_array_equal(found.lens.matrix, MATRIX)
    np.testing.assert_array_equal(found.lens.distortion, LENS)


def test_a_size_that_the_file_does_not_state(tmp_path):
    file = written(tmp_path, json.dumps({"mtx": MATRIX, "dist": LENS}), "camera.json")
    assert read_calibration(file, image_size=(640, 480)).lens.image_size == (640, 480)
    with pytest.raises(CameraError, match="size of the image is not stated"):
        read_calibration(file)


def test_a_table_of_a_run(tmp_path):
    table = f"[camera]\nimage_size = [640, 480]\nmatrix = {MATRIX}\ndistortion = {LENS}\n"
    mount = [0.1, 0.0, 0.5, 0.0, 0.4, 0.0]
    found = read_calibration(written(tmp_path, f"{table}mount = {mount}\n", "camera.toml"))
    np.testing.assert_array_equal(found.mount, mount)
    found = read_calibration(written(tmp_path, table, "camera.toml"))
    assert found.mount is None
    np.testing.assert_array_equal(found.lens.distortion, LENS)


@pytest.mark.parametrize(
    ("coefficients", "focus"),
    [((0.0, 0.0, 0.0, 0.0), 400.0), ((-0.01, 0.02, -0.01, 0.002), 350.0),
     ((-0.04, -0.003, 0.0005, -0.0001), 420.0), ((0.05, -0.01, 0.003, 0.0), 400.0)],
)  # fmt: skip
def test_a_fisheye_agrees_with_opencvs(tmp_path, coefficients, focus):
    """Points over the whole image through cv2.fisheye and through the pinhole that is read."""
    text = KALIBR.replace("[-0.01, 0.02, -0.01, 0.002]", str(list(coefficients)))
    text = text.replace("[300.0, 300.0,", f"[{focus}, {focus + 1},")
    found = read_calibration(written(tmp_path, text), name="cam1")
    assert "fisheye" in found.notes[0]
    u, v = np.meshgrid(np.linspace(0, 751, 23), np.linspace(0, 479, 17))
    pixels = np.stack([u, v], axis=-1).reshape(-1, 1, 2)
    rays = cv2.fisheye.undistortPoints(pixels, found.lens.matrix, np.array(coefficients))
    points = np.concatenate([rays, np.ones_like(rays[..., :1])], axis=-1)
    seen, _ = cv2.projectPoints(
        points, np.zeros(3), np.zeros(3), found.lens.matrix, found.lens.distortion
    )
    assert np.abs(seen - pixels).max() < 0.25


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (KALIBR, "several cameras: cam0, cam1"),
        (KALIBR.replace("cam1", "cam1\n  x").replace("pinhole", "omni"), "cannot be read as YAML"),
        (KALIBR.partition("cam1")[0].replace("pinhole", "omni"), "camera_model 'omni'"),
        (KALIBR.partition("cam1")[0].replace("radtan", "fov"), "distortion model 'fov'"),
        (KALIBR.partition("cam0:\n")[2].join(["a:\n", ""]).partition("cam1")[0]
         .replace("[640, 480]", "[640.5, 480]"), "expected whole numbers"),
        (ROS.replace("plumb_bob", "equidistant"), "has 4 values, found 5"),
        (ROS.replace("501.5", "nan"), "not finite"),
        (ROS.replace("501.5", "wide"), "expected numbers"),
        (ROS.replace("501.5", "-501.5"), "positive fx"),
        (ROS.replace("camera_matrix", "projection_matrix"), "no camera_matrix"),
        (ECHO.replace("binning_x: 0", "binning_x: 2"), "binning_x = 2"),
        ("just words", "no names with values"),
        ("[1, 2", "cannot be read as YAML"),
        ("&a [*a]", "cannot be read as YAML"),
        ("<a><b></a>", "cannot be read as XML"),
        ('<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "DTD or entities"),
        ("", "no names with values"),
        ("[" * 5000, "cannot be read as YAML"),
    ],
)  # fmt: skip
def test_what_cannot_be_used_is_said(tmp_path, text, words):
    with pytest.raises(CameraError, match=words) as error:
        read_calibration(written(tmp_path, text))
    assert "camera.yaml" in str(error.value)


def test_a_lens_wider_than_a_pinhole(tmp_path):
    """At f = 200 px an equidistant lens shows 108 degrees off its axis in the corner."""
    text = KALIBR.replace("300.0, 300.0", "200.0, 200.0")
    text = text.replace("[-0.01, 0.02, -0.01, 0.002]", "[0, 0, 0, 0]")
    with pytest.raises(CameraError, match=r"more than 80 degrees.*fisheye.undistortImage"):
        read_calibration(written(tmp_path, text), name="cam1")


FOCUS, CENTRE = st.floats(200.0, 900.0), st.floats(-5.0, 5.0)
COEFFICIENTS = st.lists(st.floats(-1e-3, 1e-3), min_size=5, max_size=5)


SIZES = st.tuples(st.integers(60, 4000), st.integers(60, 4000))


@given(SIZES, st.tuples(FOCUS, FOCUS), CENTRE, COEFFICIENTS)
def test_every_format_gives_the_lens_that_was_written(tmp_path_factory, size, focus, off, lens):
    """To the last digit: nothing is rounded or mixed up on the way."""
    (width, height), scale = size, size[0] / 640
    matrix = [
        [focus[0] * scale, 0.0, width / 2 + off],
        [0.0, focus[1] * scale, height / 2 - off],
        [0.0, 0.0, 1.0],
    ]
    flat = [value for row in matrix for value in row]
    ros = {
        "image_width": width,
        "image_height": height,
        "camera_matrix": {"rows": 3, "cols": 3, "data": flat},
        "distortion_model": "plumb_bob",
        "distortion_coefficients": {"rows": 1, "cols": 5, "data": lens},
    }
    kalibr = {
        "camera_model": "pinhole",
        "intrinsics": [flat[0], flat[4], flat[2], flat[5]],
        "distortion_model": "radtan",
        "distortion_coeffs": lens[:4],
        "resolution": [width, height],
    }
    folder = tmp_path_factory.mktemp("lenses")
    for content, expected in ((ros, lens), ({"cam0": kalibr}, lens[:4])):
        found = read_calibration(written(folder, yaml.safe_dump(content))).lens
        assert found.image_size == (width, height)
        np.testing.assert_array_equal(found.matrix, matrix)
        np.testing.assert_array_equal(found.distortion[: len(expected)], expected)
        assert not found.distortion[len(expected) :].any()
