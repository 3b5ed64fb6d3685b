"""Wrong lenses and pitches are named by how terrain changes its size from image to image."""

import re
from dataclasses import replace

import numpy as np
import pytest

from terrain.camera.camera import Camera
from terrain.checks import image_motion as image_motion_module
from terrain.checks import lens_from_motion
from terrain.checks.ground_steps import GroundSteps
from terrain.checks.image_motion import image_motion
from tests.studies.recordings.check_image_motion import moved


def scaled(camera, *by):
    matrix = camera.matrix.copy()
    matrix[[0, 1], [0, 1]] *= by
    return Camera.from_mount(camera.image_size, matrix, camera.distortion, camera.mount)


def causes(run, camera):
    findings, skipped = image_motion(run, camera)
    assert not skipped
    return {finding.name: finding.cause for finding in findings}


@pytest.mark.slow
def test_a_wrong_pitch_is_named_with_the_one_that_fits(drive, camera):
    """Another sign of it below, without a gyroscope."""
    other = moved(camera, 4, lambda pitch: pitch - np.radians(8.0))
    found = causes(drive, other)
    assert set(found) == {"camera_lens"}
    fits, stated = map(float, re.findall(r"[0-9.]+\d", found["camera_lens"])[:2])
    assert fits == pytest.approx(np.degrees(camera.mount[4]), abs=0.3)
    assert stated == pytest.approx(fits - 8.0, abs=0.3)
    assert found["camera_lens"].startswith("The camera points")


@pytest.mark.slow
def test_a_wrong_focal_length_is_named_with_its_factor(drive, camera):
    times = 0.5  # images of twice the size
    cause = causes(drive, scaled(camera, times, times))["camera_lens"]
    assert cause.startswith("The focal length is")
    assert float(re.findall(r"[0-9.]+", cause)[0]) == pytest.approx(1 / times, rel=0.02)


@pytest.mark.slow
def test_images_that_were_stretched_are_named(drive, camera):
    cause = causes(drive, scaled(camera, 1.0, 1.3))["camera_lens"]
    assert cause.startswith("The vertical focal length is 0.7")
    assert "stretched" in cause


@pytest.mark.parametrize("off_deg", [-1.5, 1.5])
def test_a_pitch_that_is_off_by_little_is_not_accused(drive, camera, off_deg):
    other = moved(camera, 4, lambda pitch: pitch + np.radians(off_deg))
    assert causes(drive, other) == {}


def test_another_height_is_no_other_lens(drive, camera):
    assert set(causes(drive, moved(camera, 2, lambda z: 1.5 * z))) == {"camera_height"}


def test_a_camera_that_rocks_is_not_accused(drive, camera, monkeypatch):
    """Sizes that change to and fro: their median is not sure."""
    monkeypatch.setattr(GroundSteps, "scale", (-0.057, 0.167))
    assert causes(drive, camera) == {}


def test_what_no_single_number_mends_is_another_camera(drive, camera):
    """A homography, of which no mount is fitted."""
    other = scaled(camera, 0.5, 0.5)
    other = Camera.from_homography(
        other.image_size, other.matrix, other.distortion, other.ground_to_image
    )
    assert causes(drive, other)["camera_lens"] == lens_from_motion.OTHER_CAMERA


def test_a_lens_far_off_is_named_where_nothing_agrees(drive, camera, monkeypatch):
    monkeypatch.setattr(image_motion_module, "EXPLAINED", 0.0)
    assert causes(drive, scaled(camera, 2.0, 2.0))["camera_lens"] == lens_from_motion.OTHER_CAMERA
    findings, skipped = image_motion(drive, scaled(camera, 1.2, 1.2))
    assert findings == []
    assert "do not agree" in skipped


@pytest.mark.slow
def test_without_a_gyroscope_the_pitch_is_named_as_well(drive, camera):
    blind = replace(drive, imu=None, odometry=without_rates(drive.odometry))
    assert blind.yaw_rate is None
    other = moved(camera, 4, lambda pitch: pitch + np.radians(8))
    assert f"{np.degrees(camera.mount[4]):.0f}" in causes(blind, other)["camera_lens"]


def without_rates(table):
    columns = {name: of for name, of in table.columns.items() if name != "gyro_z"}
    return replace(table, columns=columns)
