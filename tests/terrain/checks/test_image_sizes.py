"""Sizes of images, image_size and matrix that contradict each other."""

import cv2
import numpy as np
import pytest

from odometry.checks.findings.finding import Level


def scaled(matrix, factor):
    return (np.diag([factor, factor, 1.0]) @ np.array(matrix)).tolist()


def test_image_size_swapped(faulty):
    faulty.settings(camera={"image_size": [120, 160]})
    found = faulty.found()
    assert list(found) == ["image_size"]  # and no second finding that follows from it
    assert "swapped" in found["image_size"].cause
    assert "24 of 24 images" in found["image_size"].seen
    assert "[160, 120]" in found["image_size"].remedy


def test_images_scaled(faulty):
    faulty.images(lambda image: cv2.resize(image, None, fx=0.5, fy=0.5))
    finding = faulty.found()["image_size"]
    assert "scaled by a factor of 0.5" in finding.cause
    assert "24 of 80x60" in finding.seen


def test_only_image_size_of_another_resolution(faulty):
    faulty.settings(camera={"image_size": [320, 240]})
    found = faulty.found()
    assert list(found) == ["image_size"]
    assert "another resolution than images and matrix" in found["image_size"].cause


def test_images_rotated(faulty):
    faulty.images(lambda image: cv2.rotate(image, cv2.ROTATE_90_CLOCKWISE))
    assert "rotated by 90 degrees" in faulty.found()["image_size"].cause


def test_images_cropped(faulty):
    faulty.images(lambda image: image[:70])
    assert "cropped" in faulty.found()["image_size"].cause


def test_a_few_images_of_another_size_are_a_note(faulty):
    for file in faulty.files[:3]:
        file.write_bytes(cv2.imencode(".jpg", cv2.imread(str(file))[:50])[1].tobytes())
    finding = faulty.found()["image_size"]
    assert finding.level is Level.NOTE
    assert "3 of 24 images" in finding.seen
    assert "3 of 160x50" in finding.seen


@pytest.mark.parametrize("factor", [0.5, 2.0, 3.0])
def test_matrix_of_another_resolution(faulty, world, factor):
    faulty.settings(camera={"matrix": scaled(world.camera["matrix"], factor)})
    found = faulty.found()
    assert "camera_matrix" in found
    assert "another resolution" in found["camera_matrix"].cause
    assert "focal length" in found["camera_matrix"].cause
    assert "region_outside" not in found  # mended by that factor, the region is inside the image


def test_a_part_of_larger_images_is_not_told_to_be_scaled(faulty):
    """An image of 160 x 120, cut out of one of 640 x 480 whose camera has a focal length of 600."""
    faulty.settings(camera={"matrix": [[600.0, 0, 220.0], [0, 600.0, 160.0], [0, 0, 1.0]]})
    finding = faulty.found()["camera_matrix"]
    assert finding.cause.startswith("Images are a part that was cut out of larger ones")
    assert "resolution" in finding.cause
    assert "Divide" not in finding.remedy


def test_dividing_is_only_for_images_that_were_scaled(faulty, world):
    faulty.settings(camera={"matrix": scaled(world.camera["matrix"], 2.0)})
    remedy = faulty.found()["camera_matrix"].remedy
    assert remedy.startswith("Divide the first two rows of matrix by ")
    assert "cut out of larger ones" in remedy


def test_a_long_focal_length_about_the_middle_is_a_crop_of_which_nothing_is_said(faulty):
    faulty.settings(camera={"matrix": [[600.0, 0, 80.0], [0, 600.0, 60.0], [0, 0, 1.0]]})
    assert "camera_matrix" not in faulty.found()
