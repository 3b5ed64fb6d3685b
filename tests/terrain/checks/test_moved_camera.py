"""A camera that was moved while recording, on images turned as such a camera sees them."""

import re
import shutil

import cv2
import numpy as np
import pytest

import odometry
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.ground_steps import ground_steps
from terrain.checks.image_agreement import ImageMotion
from terrain.checks.image_motion import image_motion
from terrain.checks.lens_from_motion import RESIZED
from terrain.checks.moved_camera import moved_camera

TURN_DEG = 6.0


@pytest.fixture(scope="module")
def moved(tmp_path_factory):
    """The demo, whose camera looks higher in some of its images."""

    def of(chosen):
        folder = tmp_path_factory.mktemp("runs") / "moved"
        shutil.copytree(odometry.shipped_data() / "runs" / "demo", folder)
        run = Run.read(folder)
        camera = Camera.from_table(run.settings["camera"])
        turn, _ = cv2.Rodrigues(np.array([-np.radians(TURN_DEG), 0.0, 0.0]))
        turn = camera.matrix @ turn @ np.linalg.inv(camera.matrix)
        for name in run.images["file"][chosen(run.images.stamps_s)]:
            image = cv2.imread(str(folder / str(name)))
            image = cv2.undistort(image, camera.matrix, camera.distortion)
            turned = cv2.warpPerspective(image, turn, camera.image_size)
            cv2.imwrite(str(folder / str(name)), turned)
        return run, camera

    return of


@pytest.mark.parametrize("later", [True, False])
def test_the_time_and_the_new_pitch_are_named(moved, later):
    run, camera = moved(lambda t: t - t[0] > 25 if later else t - t[0] < 25)
    findings, _ = image_motion(run, camera)
    finding = {one.name: one for one in findings}["camera_moved"]
    at_s = float(re.findall(r"about ([0-9.]+) s", finding.seen)[0])
    assert at_s == pytest.approx(25, abs=3)
    looks = float(re.findall(r"points ([0-9.]+) degrees", finding.cause)[0])
    stated = float(np.degrees(camera.mount[4]))
    assert abs(looks - stated) == pytest.approx(TURN_DEG, abs=1.0)
    assert ("from about" if later else "until about") in finding.seen
    assert "camera_lens" not in {one.name for one in findings}


def test_a_camera_that_is_wrong_all_the_time_was_not_moved(moved):
    run, camera = moved(lambda t: t >= t[0])
    motion = ImageMotion(run, ground_steps(run, camera))
    assert abs(motion.steps.scale[0]) > RESIZED
    assert list(moved_camera(motion, camera)) == []


def test_a_camera_that_is_turned_to_and_fro_was_not_moved(moved):
    run, camera = moved(lambda t: (t // 2) % 2 == 0)
    assert "camera_moved" not in {one.name for one in image_motion(run, camera)[0]}
