"""CameraInfo that changes on the way, or does not name its model, is said."""

import numpy as np
import pytest

from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course

MATRIX = np.array([[50, 0, 32], [0, 50, 24], [0, 0, 1.0]])
ZOOMED = MATRIX * [[2, 1, 1], [1, 2, 1], [1, 1, 1]]
MOVED = MATRIX * [[1, 1, 1.1], [1, 1, 1], [1, 1, 1]]
LENS = [0.1, 0, 0, 0, 0]


def drive(kind="mcap"):
    """Wheels and an image."""
    bag = Bag(kind)
    for t_s, left, right, *_ in course(10.0):
        rates = [left / RADIUS_M, right / RADIUS_M]
        bag.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), rates)
    bag.image(0.5, np.zeros((48, 64), np.uint8), "mono8")
    return bag


def notes(bag, tmp_path):
    path = bag.write(tmp_path / ("drive.bag" if bag.kind == "ros1" else "drive"))
    run, said = imported(tmp_path / "run", path)
    return run, [note for note in said.notes if "amera" in note and "mount" not in note]


@pytest.mark.parametrize("kind", ["mcap", "ros1"])
@pytest.mark.parametrize(
    ("later", "words"),
    [
        ({"matrix": ZOOMED}, "focal length 50 to 100 pixels, first after 7 s"),
        ({"matrix": MOVED}, "camera matrix"),
        ({"size": (128, 96)}, "size 64 x 48 to 128 x 96 pixels"),
        ({"distortion": [0.2, 0, 0, 0, 0]}, "distortion"),
        ({"roi": {"x_offset": 8}}, "region of interest or binning"),
        ({"projection": ZOOMED}, "matrix of rectified images"),
    ],
)
def test_a_later_camera_info_that_differs_is_said(kind, later, words, tmp_path):
    bag = drive(kind)
    for t_s in range(10):
        said = {"size": (64, 48), "matrix": MATRIX, "distortion": LENS}
        if t_s >= 7:
            said |= later
        bag.camera_info(float(t_s), **said)
    run, told = notes(bag, tmp_path)
    assert run.settings["camera"]["matrix"] == MATRIX.tolist()
    (note,) = [one for one in told if one.startswith("warning: ")]
    assert f"/camera/camera_info changes on the way ({words}" in note
    assert "3 of its 10 messages differ" in note
    assert note in run.settings["source"]["notes"]


def test_a_camera_info_that_stays_or_is_rounded_is_not_said(tmp_path):
    bag = drive()
    for t_s in range(10):
        bag.camera_info(float(t_s), (64, 48), MATRIX + 1e-5 * t_s, LENS)
    assert not any(note.startswith("warning") for note in notes(bag, tmp_path)[1])


@pytest.mark.parametrize(
    ("model", "lens", "said"),
    [("", [0.1, 0.01, 0, 0], True), ("", [0.0] * 5, False), ("plumb_bob", LENS, False)],
)
def test_a_distortion_model_that_is_not_stated_is_said(model, lens, said, tmp_path):
    bag = drive()
    bag.camera_info(0.0, (64, 48), MATRIX, lens, model=model)
    run, told = notes(bag, tmp_path)
    assert run.settings["camera"]["distortion"] == (lens if any(lens) else [])
    assert any("does not state the distortion model" in note for note in told) == said
