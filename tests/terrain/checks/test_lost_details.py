"""Images that show fewer details of the same terrain from some time on, and what is no loss."""

import cv2
import numpy as np
import pytest

from odometry.checks.findings.finding import CheckReport
from terrain.believed import run_to_label
from terrain.checks.ground_steps import pairs_to_compare
from terrain.checks.lost_details import _stretches, lost_details
from terrain.checks.terrain_views import TerrainViews

SIZE, FROM_S, TO_S = (640, 480), 24.0, 40.0


class Changed:
    """The images of a run, some of which are changed."""

    def __init__(self, run, change, is_changed):
        stamps_s = run.images.stamps_s
        self._views = TerrainViews(run, SIZE)
        self._stamp_s = dict(zip(map(str, run.images["file"]), stamps_s, strict=True))
        self._change, self._is_changed = change, is_changed

    def grey(self, name):
        image = self._views.grey(name)
        if not self._is_changed(self._stamp_s[name]):
            return image
        return np.clip(self._change(image.astype(np.float32)), 0, 255).astype(np.uint8)


@pytest.fixture
def found(drive, camera):
    """Findings where images of the drive are changed, by default those between two times."""

    def of(change, is_changed=lambda stamp_s: FROM_S <= stamp_s < TO_S):
        return list(lost_details(drive, camera, Changed(drive, change, is_changed)))

    return of


def fog(image):
    return 0.4 * image + 110


@pytest.mark.parametrize(
    "change",
    [fog, lambda image: cv2.GaussianBlur(image, (0, 0), 2.0)],
)
def test_fog_and_a_lost_focus_are_found_from_their_first_to_their_last_image(found, change):
    (finding,) = found(change)
    ((begin_s, end_s),) = finding.spans_s
    assert begin_s == pytest.approx(FROM_S, abs=0.6)
    assert end_s == pytest.approx(TO_S, abs=0.6)
    assert finding.name == "images_lost_details"
    assert "of the details, or of the finest of them, that the image before them" in finding.seen


@pytest.mark.parametrize(
    "change",
    [
        lambda image: image,  # of terrains with other details: gravel, grass and gravel
        lambda image: 0.4 * image,
        lambda image: 255 * (image / 255) ** 0.6,
        lambda image: cv2.blur(image, (6, 1)),
    ],
)
def test_other_terrain_light_gamma_and_blur_by_motion_are_no_loss(found, change):
    assert not found(change)


def test_a_stretch_begins_with_a_loss_and_ends_before_the_details_are_back():
    assert list(_stretches([(3, 1.0), (10, -0.8), (12, -0.9), (20, 0.8)], 50)) == [(10, 19, -0.8)]
    assert list(_stretches([(10, -0.8)], 50)) == [(10, 49, -0.8)]
    assert not list(_stretches([(10, 0.8)], 50))  # what was before the first image is not known


def test_one_image_alone_is_no_stretch(found, drive, camera):
    for row in np.unique(pairs_to_compare(drive, camera)[:, 0])[5:8]:
        alone_s = drive.images.stamps_s[row]
        assert not found(fog, lambda stamp_s, alone_s=alone_s: stamp_s == alone_s)


def test_label_cuts_no_patches_of_such_images(found, drive):
    (finding,) = found(fog)
    kept = run_to_label(drive, CheckReport(drive.folder, (finding,)))
    ((begin_s, end_s),) = finding.spans_s
    times_s = kept.images.stamps_s - drive.odometry.stamps_s[0]
    assert len(times_s) > 20
    assert not ((begin_s <= times_s) & (times_s <= end_s)).any()
