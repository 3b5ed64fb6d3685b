"""Stretches on which a camera is frozen or shows nothing, in a run that is good but for them."""

import shutil
from dataclasses import replace

import cv2
import numpy as np
import pytest

from odometry.recording.run import Run
from terrain.checks import image_motion as checked
from terrain.checks.image_motion import image_motion
from terrain.checks.image_stretches import BLANK, SHOWS, STAYS, ImageStretches, _lasting
from terrain.checks.unrelated_images import agrees
from tests.studies.recordings.check_image_motion import with_images

SIZE = (480, 640)


def frozen(image, seed):
    noise = np.random.default_rng(seed).normal(0, 4, image.shape)
    return image * (1 + 0.05 * np.sin(seed)) + noise


def covered(image, seed):
    return 120 + np.random.default_rng(seed).normal(0, 2, image.shape)


def noise_alone(image, seed):
    return np.random.default_rng(seed).normal(120, 40, image.shape)


@pytest.fixture
def changed(drive, tmp_path):
    """A copy of the drive whose images from some time on are made from the first of them."""

    def of(change, from_s):
        folder = tmp_path / "changed"
        shutil.copytree(drive.folder, folder)
        first = None
        for row in np.flatnonzero(drive.images.stamps_s >= from_s):
            file = folder / str(drive.images["file"][row])
            first = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE) if first is None else first
            cv2.imwrite(str(file), np.clip(change(first, int(row)), 0, 255).astype(np.uint8))
        return Run.read(folder)

    return of


@pytest.mark.parametrize(
    ("change", "name"),
    [(frozen, "images_frozen"), (covered, "images_blank"), (noise_alone, "images_blank")],
)
def test_a_stretch_is_the_only_finding_and_begins_when_it_does(changed, camera, change, name):
    middle_s = 12.0
    (finding,), skipped = image_motion(changed(change, middle_s), camera)
    assert finding.name == name
    ((begin_s, end_s),) = finding.spans_s
    assert middle_s - 0.1 <= begin_s <= middle_s + 2.0
    assert end_s > 24.0
    assert not skipped


def test_a_lag_is_found_by_the_images_before_the_lens_was_covered(changed, camera):
    run = changed(covered, 14.0)
    late = with_images(run, t=run.images.stamps_s + 1.0)
    findings, _ = image_motion(late, camera)
    assert [one.name for one in findings] == ["images_blank", "images_late"]
    assert "Subtract 1.0" in findings[1].remedy


@pytest.mark.parametrize("change", [frozen, noise_alone])
def test_a_whole_run_without_terrain_is_not_called_upside_down_or_mixed(changed, camera, change):
    findings, skipped = image_motion(changed(change, 0.0), camera)
    assert len(findings) == 1
    assert findings[0].name in {"images_frozen", "images_blank"}
    assert skipped


class Motion:
    """A motion in images of which the treads leave nothing unexplained, by a gain."""

    steps, plain_even_loss, plain_reversed_loss = range(20), 100.0, 90.0
    plain_losses = np.array([1.0])

    def __init__(self, gain, turn):
        self.plain_gains = gain, 0.01, turn, 0.05


@pytest.mark.parametrize(
    ("gain", "turn", "is_right"),
    [(1, 1, True), (0.02, 1, False), (1j, 1, False), (4, 1, False), (1, -1, False), (1, 0, False)],
)
def test_images_put_right_agree_by_size_direction_and_turn(gain, turn, is_right):
    assert agrees(Motion(gain, turn)) is is_right


@pytest.mark.parametrize(("explains", "words"), [(True, "Images are"), (False, "Cannot be")])
def test_mirrored_is_a_cause_where_images_mirrored_back_agree(
    drive, camera, monkeypatch, explains, words
):
    by_image = checked.ground_steps

    def mirrored(*given):
        steps = by_image(*given)
        return replace(steps, steps=steps.steps * [1, -1, -1])

    monkeypatch.setattr(checked, "ground_steps", mirrored)
    if not explains:
        monkeypatch.setattr(checked, "agrees", lambda _: False)
    (finding,), _ = image_motion(drive, camera)
    assert finding.name == "images_mirrored"
    assert finding.cause.startswith(words)


def test_one_or_two_pairs_are_no_stretch():
    kinds = np.array([STAYS, STAYS, SHOWS, BLANK, BLANK, BLANK, STAYS])
    assert _lasting(kinds).tolist() == [SHOWS] * 3 + [BLANK] * 3 + [SHOWS]


def test_images_between_the_good_pairs_are_left_out(drive):
    pairs = np.array([[0, 2], [4, 6], [8, 10], [12, 14], [16, 18], [20, 22]])
    kinds = np.array([SHOWS, STAYS, STAYS, STAYS, SHOWS, SHOWS])
    kept = ImageStretches(drive, pairs, kinds).others().images
    assert len(kept) == len(drive.images) - 13
    assert set(drive.images.stamps_s[3:16]).isdisjoint(kept.stamps_s)
