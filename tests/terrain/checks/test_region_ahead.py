"""Mistakes in [camera] that put the region ahead outside the image, each named by its cause."""

import re

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from terrain.camera.camera import Camera

X, Y, Z, ROLL, PITCH, YAW = 0.2, 0.0, 0.55, 0.01, 0.85, 0.02
PLACE = [X, Y, Z]


def optical_angles(world):
    """Angles of the optical frame of the camera, by its axes: z ahead, x right, y down."""
    forward, left, up = world.rotation(ROLL, PITCH, YAW).T
    axes = np.column_stack([-left, -up, forward])
    pitch = -np.arcsin(axes[2, 0])
    return [
        float(np.arctan2(axes[2, 1], axes[2, 2])),
        float(pitch),
        float(np.arctan2(axes[1, 0], axes[0, 0])),
    ]


MOUNTS = {
    "degrees": [*PLACE, 0.57, 48.7, 1.1],
    "wrong sign": [*PLACE, ROLL, -PITCH, YAW],
    "yaw is off by 90": [*PLACE, ROLL, PITCH, YAW + np.pi / 2],
    "yaw is off by -90": [*PLACE, ROLL, PITCH, YAW - np.pi / 2],
    "yaw is off by 180": [*PLACE, ROLL, PITCH, YAW + np.pi],
    "z are in mm": [200.0, 0.0, 550.0, ROLL, PITCH, YAW],
    "height z is in mm": [0.2, 0.0, 550.0, ROLL, PITCH, YAW],
    "height z is in cm": [0.2, 0.0, 55.0, ROLL, PITCH, YAW],
    "z are in cm": [20.0, 0.0, 55.0, ROLL, PITCH, YAW],
    "degrees, and x, y and z are in mm": [200.0, 0.0, 550.0, 0.57, 48.7, 1.1],
    "pitch and roll are exchanged": [X, Y, 1.3, 0.7, 0.0, 0.0],
}


def test_nothing_is_found_where_nothing_is_odd(faulty):
    assert faulty.found() == {}


@pytest.mark.parametrize("words", MOUNTS)
def test_a_wrong_mount_is_named(faulty, words):
    faulty.settings(camera={"mount": [float(value) for value in MOUNTS[words]]})
    finding = faulty.found()["region_outside"]
    assert finding.level is Level.WARNING
    assert words in finding.cause.split("; less likely")[0]
    assert finding.seen.startswith("the region ahead is ")
    assert "of 24 images" in finding.seen


def test_angles_of_the_optical_frame_are_named(faulty, world):
    faulty.settings(camera={"mount": [*PLACE, *optical_angles(world)]})
    cause = faulty.found()["region_outside"].cause
    assert "optical frame" in cause.split("; less likely")[0]


def test_a_camera_below_the_ground_is_unreadable(faulty):
    faulty.settings(camera={"mount": [X, Y, -Z, ROLL, PITCH, YAW]})
    finding = faulty.found()["camera_unreadable"]
    assert "z has the wrong sign" in finding.cause
    assert "above the ground" in finding.seen


RIGHT_FORWARD = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
HOMOGRAPHIES = {
    "image_to_ground": np.linalg.inv,
    "it takes mm": lambda h: h @ np.diag([1e-3, 1e-3, 1.0]),
    "it takes cm": lambda h: h @ np.diag([1e-2, 1e-2, 1.0]),
    "image_to_ground, not ground_to_image, and it takes mm": (
        lambda h: np.linalg.inv(h @ np.diag([1e-3, 1e-3, 1.0]))
    ),
    "x right and y forward": lambda h: h @ RIGHT_FORWARD,
}


@pytest.mark.parametrize("words", HOMOGRAPHIES)
def test_a_wrong_homography_is_named(faulty, world, words):
    right = Camera.from_table(world.camera).ground_to_image
    wrong = HOMOGRAPHIES[words](right).tolist()
    faulty.settings(camera={"mount": None, "ground_to_image": wrong})
    assert words in faulty.found()["region_outside"].cause.split("; less likely")[0]


def test_the_right_homography_is_not_odd(faulty, world):
    right = Camera.from_table(world.camera).ground_to_image.tolist()
    faulty.settings(camera={"mount": None, "ground_to_image": right})
    assert faulty.found() == {}


def test_pixels_without_matrix_are_named(faulty, world):
    right = Camera.from_table(world.camera).ground_to_image
    normalised = np.linalg.solve(np.array(world.camera["matrix"]), right).tolist()
    faulty.settings(camera={"mount": None, "ground_to_image": normalised})
    assert "matrix is left out" in faulty.found()["region_outside"].cause


def test_no_cause_is_invented(faulty):
    faulty.settings(camera={"mount": [X, Y, 4.0, 0.0, -0.4, 2.3]})
    finding = faulty.found()["region_outside"]
    assert "cannot be determined" in finding.cause


WIDE = {"width": 0.9, "length": 0.7}  # with its margin wider than what the camera shows


def test_a_view_narrower_than_the_robot_is_no_mistake(faulty):
    faulty.settings(robot=WIDE)
    finding = faulty.found()["region_in_part"]
    assert finding.level is Level.NOTE
    share = int(re.search(r"shows (\d+) % of the region", finding.seen)[1])
    assert 40 <= share < 100


@pytest.mark.parametrize("words", sorted(MOUNTS.keys() - {"pitch and roll are exchanged"}))
def test_mistakes_of_a_narrow_view_are_named(faulty, words):
    faulty.settings(camera={"mount": [float(value) for value in MOUNTS[words]]}, robot=WIDE)
    assert words in faulty.found()["region_outside"].cause.split("; less likely")[0]


def test_a_robot_in_mm_is_named(faulty):
    faulty.settings(robot={"length": 400.0, "width": 340.0})
    cause = faulty.found()["region_outside"].cause
    assert "length and width of run.toml are in mm" in cause


def test_a_robot_that_reverses_is_no_fault_of_the_camera(faulty):
    file = faulty.folder / "odometry.csv"
    header, *rows = file.read_text().split()
    cells = [row.split(",") for row in rows]
    file.write_text(
        "\n".join([header, *(f"{t},-{left},-{right}" for t, left, right in cells)]) + "\n"
    )
    (faulty.folder / "pose.csv").unlink()
    finding = faulty.found()["region_seldom_seen"]
    assert finding.level is Level.NOTE
    assert "reverses" in finding.cause


def test_height_comes_back_from_a_homography(world):
    camera = Camera.from_table(world.camera)
    assert camera.height_m == pytest.approx(Z)
    scaled = Camera.from_homography((160, 120), camera.matrix, [], -3 * camera.ground_to_image)
    assert scaled.height_m == pytest.approx(Z)
