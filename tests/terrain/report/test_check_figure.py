"""One figure for a checked run."""

import cv2
import numpy as np

from odometry.recording.run import Run
from terrain.checks.drawn_images import shown_image
from terrain.checks.recording import check_run
from terrain.report.check_figure import write_check_figure


def test_a_run_with_images(across_run, tmp_path):
    file = write_check_figure(check_run(across_run), tmp_path / "a.png")
    pixels = cv2.imread(str(file))
    assert pixels.shape[1] == 1500
    assert pixels.std() > 10
    again = write_check_figure(check_run(across_run), tmp_path / "b.png")
    assert again.read_bytes() == file.read_bytes()


def test_a_run_without_images_or_poses(world, tmp_path):
    folder = world.drive_curves(tmp_path / "bare", pose=False)
    assert write_check_figure(check_run(folder), tmp_path / "bare.png").exists()


def test_a_refused_run_has_no_figure(tmp_path):
    assert write_check_figure(check_run(tmp_path / "nowhere"), tmp_path / "a.png") is None
    assert not list(tmp_path.iterdir())


def test_the_image_shown_is_of_the_middle_and_shows_the_region(across_run):
    shown = shown_image(Run.read(across_run))
    stamps_s = Run.read(across_run).images.stamps_s
    assert abs(shown.run_time_s - np.median(stamps_s)) < 0.5
    assert shown.region is not None
    assert shown.reason == ""
