"""Frames of sensors that are stated twice, poses of other things, and names of images."""

import numpy as np
import pytest

from odometry.bags.topics.topic_guess import RECTIFIED
from tests.odometry.bags.test_frames import drive, static, tables, urdf


@pytest.mark.parametrize(
    ("again", "words"),
    [
        (("base_link", "imu_link", (0, 0, 0.2), (0, 1, 0, 0)), "twice, 0 m and 180 degrees apart"),
        (("base_link", "imu_link", (0.3, 0, 0.2), (1, 0, 0, 0)), "twice, 0.3 m and 0 degrees"),
        (("plate", "imu_link", (0, 0, 0.2), (1, 0, 0, 0)), "twice, in base_link, then in plate"),
        (("base_link", "imu_link", (0, 0, 0.2), (1, 0, 0, 0)), ""),
        (("base_link", "gripper", (0, 0, 0.5), (1, 0, 0, 0)), ""),  # of no sensor that is used
    ],
)
def test_a_frame_that_is_stated_twice_otherwise_is_said(again, words, tmp_path):
    bag = drive()
    static(bag, ("base_link", "imu_link", (0, 0, 0.2), (1, 0, 0, 0)))
    static(bag, ("base_link", "gripper", (0, 0, 0.2), (1, 0, 0, 0)))
    static(bag, again)
    _, said = tables(bag, tmp_path)
    found = [note for note in said.notes if "static transforms" in note]
    assert len(found) == bool(words)
    assert all(note.startswith("warning: /imu/data") and words in note for note in found)


def test_wheels_of_several_radii_are_said(tmp_path):
    bag, text = drive(), urdf().replace('radius="0.15"', 'radius="0.12"', 1)
    bag.text("/robot_description", 0.0, text)
    _, said = tables(bag, tmp_path, unsized=True)
    assert any("wheels of 0.12 to 0.15 m radius" in note for note in said.notes)


def test_poses_of_what_the_camera_sees_are_no_reference(tmp_path):
    bag = drive()
    for t_s in np.arange(0.0, 4.0, 0.01):
        bag.pose_stamped("/marker/pose", t_s, bag.pose((0, 0, 2), (1, 0, 0, 0)), "camera_optical")
    run, _ = tables(bag, tmp_path)
    assert run.settings["source"]["topics"]["reference"] == "/gps/fix"


def test_a_camera_with_a_camera_info_is_taken_before_one_without(tmp_path):
    bag = drive()
    bag.image(0.6, np.zeros((48, 64), np.uint8), "mono8")
    _, kind, t_s, message = bag.written[-1]
    bag.written[-1] = ("/front/image_raw", kind, t_s, message)
    run, said = tables(bag, tmp_path)
    assert "images: /camera/image_raw" in said.notes
    assert "camera" in run.settings


@pytest.mark.parametrize(
    ("images", "info", "is_of_it"),
    [
        ("/image_raw", "/camera_info", True),
        ("/image_raw/compressed", "/camera_info", True),
        ("/front/image_raw", "/camera_info", False),
        ("/front/image_raw/compressed", "/front/camera_info", True),
    ],
)
def test_the_camera_info_that_belongs_to_images(tmp_path, images, info, is_of_it):
    bag = drive()
    names = {"/camera/image_raw": images, "/camera/camera_info": info}
    bag.written = [(names.get(topic, topic), *others) for topic, *others in bag.written]
    run, _ = tables(bag, tmp_path)
    assert ("camera" in run.settings) == is_of_it


@pytest.mark.parametrize(
    ("images", "rectified"),
    [
        ("/camera/image_rect", True),
        ("/camera/image_rect_color", True),
        ("/camera/rectified", True),
        ("/camera/imageRectified", True),
        ("/direct_camera/image_raw", False),
        ("/camera/unrectified", False),
    ],
)
def test_images_are_rectified_by_a_word_of_their_name(images, rectified):
    assert bool(RECTIFIED.search(images)) == rectified
