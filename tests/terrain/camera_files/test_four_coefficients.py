"""Files of OpenCV, which do not say whether four coefficients are those of a fisheye lens."""

import cv2
import numpy as np
import pytest

from terrain.camera_files.lens_models import lens_of
from terrain.camera_files.read import read_calibration
from terrain.errors import CameraError

MATRIX = np.array([[600.0, 0.0, 639.5], [0.0, 600.0, 479.5], [0.0, 0.0, 1.0]])
FOUR = np.array([0.02, -0.005, 0.001, -0.0005])
SIZE = (1280, 960)


def written(folder, coefficients, model=""):
    file = folder / "camera.yaml"
    storage = cv2.FileStorage(str(file), cv2.FILE_STORAGE_WRITE)
    storage.write("K", MATRIX)
    storage.write("D", np.asarray(coefficients).reshape(-1, 1))
    if model:
        storage.write("distortion_model", model)
    storage.release()
    return file


def test_four_coefficients_of_no_model_are_refused(tmp_path):
    """A fisheye that is read as an ordinary lens shows the terrain elsewhere, without a word."""
    with pytest.raises(CameraError, match=r"distortion_model: equidistant.*plumb_bob"):
        read_calibration(written(tmp_path, FOUR), image_size=SIZE)


@pytest.mark.parametrize("model", ["equidistant", "plumb_bob"])
def test_they_are_what_the_file_says(tmp_path, model):
    found = read_calibration(written(tmp_path, FOUR, model), image_size=SIZE)
    expected, _ = lens_of(model, SIZE, MATRIX, FOUR)
    np.testing.assert_array_equal(found.lens.distortion, expected.distortion)


@pytest.mark.parametrize("coefficients", [np.zeros(4), [*FOUR, 0.0]])
def test_no_distortion_and_five_coefficients_are_plain(tmp_path, coefficients):
    found = read_calibration(written(tmp_path, coefficients), image_size=SIZE)
    assert len(found.lens.distortion) in (0, len(coefficients))
