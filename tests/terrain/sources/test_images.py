"""What the watcher does about bad images, and regions that are not to be classified."""

import dataclasses

import cv2
import numpy as np
import pytest

from odometry.recording.frames import Frame
from odometry.recording.run_terrains import Footing
from terrain.camera.camera import Camera
from terrain.classification.likeness.likeness import Likeness
from terrain.errors import CameraError
from terrain.image_labels.details_watch import DetailsWatch
from terrain.image_labels.image_labeller import RunLikeness
from terrain.region.region import RegionConfig
from terrain.sources.watcher import TerrainWatcher
from terrain.switch.switch import SwitchConfig
from tests.terrain.sources.watched import BRIGHT, DARK, ByBrightness, drive, estimate_at


def cut_short(image):
    """The first half of its PNG file."""
    data = cv2.imencode(".png", image)[1].tobytes()
    return data[: len(data) // 2]


@pytest.mark.parametrize("bad", [b"", b"no image", cut_short(DARK)], ids=["empty", "text", "cut"])
def test_an_image_that_cannot_be_read_is_a_row_and_the_run_goes_on(watch, bad, capfd):
    watched = watch([DARK, BRIGHT, bad, BRIGHT, BRIGHT])
    terrains = drive(watched)
    capfd.readouterr()  # the image library speaks of the damage on its own
    bad_one = watched.watcher.image_labels[2]
    assert bad_one.label == ""
    assert bad_one.reason == "the image cannot be read"
    assert np.isnan(bad_one.confidence)
    assert [s.label for s in watched.watcher.image_labels] == ["mud", "snow", "", "snow", "snow"]
    assert terrains[-1] == "snow"  # it breaks no row


def test_a_grey_image_among_coloured_ones_is_a_row_and_the_run_goes_on(watch):
    bright, dark = (np.repeat(image[..., None], 3, axis=2) for image in (BRIGHT, DARK))
    watched = watch([dark, bright, BRIGHT, bright, bright], ByBrightness(colour=True))
    assert drive(watched)[-1] == "snow"
    assert [s.label for s in watched.watcher.image_labels] == ["mud", "snow", "", "snow", "snow"]
    reason = "the image is grey, the model was trained with colour"
    assert watched.watcher.image_labels[2].reason == reason


def test_an_image_that_equals_the_one_before_shows_nothing_new(watch):
    frozen = cv2.imencode(".png", BRIGHT)[1].tobytes()
    watched = watch([DARK, frozen, frozen, frozen, DARK])
    drive(watched)
    labels = watched.watcher.image_labels
    assert [one.label for one in labels] == ["mud", "snow", "", "", "mud"]
    assert labels[3].reason == "the image is the one before"


def test_a_view_that_stays_while_the_robot_moves_has_no_label(watch):
    rng = np.random.default_rng(2)
    rough = [cv2.GaussianBlur(rng.normal(150, 400, (120, 160)), (0, 0), 2.0) for _ in range(2)]
    views = [*rough, *[rough[1] + rng.normal(0, 3, (120, 160)) for _ in range(3)], rough[0]]
    watched = watch([np.clip(view, 0, 255).astype(np.uint8) for view in views])
    drive(watched)
    labels = watched.watcher.image_labels
    assert [bool(one.label) for one in labels] == [True, True, False, False, False, True]
    assert labels[3].reason == "the image stays the same while the treads move"


def test_images_that_lost_details_of_the_terrain_have_no_label(watch, monkeypatch):
    given = {}

    def has_lost(_, image, pose):
        given[float(pose[0])] = image
        return int(image.flat[0]) in {2, 3}

    monkeypatch.setattr(DetailsWatch, "has_lost", has_lost)
    watched = watch([DARK, BRIGHT, BRIGHT, BRIGHT, DARK])
    drive(watched)
    labels = watched.watcher.image_labels
    assert [one.label for one in labels] == ["mud", "snow", "", "", "mud"]
    assert labels[3].reason.startswith("the image lost details of the terrain: fog,")
    assert np.ptp(list(given)) == pytest.approx(4 * 0.5)  # by the poses of the robot


def test_a_region_of_which_a_corner_is_outside_the_image_has_a_label(watch):
    """A left turn of 0.4 m radius: at every look-ahead a corner of the footprint is outside."""
    watched = watch([BRIGHT])
    frame = next(f for f in watched.run.frames() if f.image is not None)
    turning = dataclasses.replace(frame, tread_speeds_m_s=np.array([0.3125, 0.6875]))
    whole = watch_whole(watched)
    assert whole.look(turning, estimate_at(frame)).reason == "the region lies outside the image"
    image_label = watched.watcher.look(turning, estimate_at(frame))
    assert image_label.label == "snow"
    (shown,) = watched.classifier.shown
    assert min(shown.shape) >= watched.classifier.patch_size_px


def watch_whole(watched):
    """A watcher that labels a region only where the image shows all of it."""
    return TerrainWatcher(
        watched.run.robot,
        Camera.from_table(watched.run.settings["camera"]),
        watched.classifier,
        "mud",
        region=RegionConfig(least_share=1.0),
        switch=SwitchConfig(),
        folder=watched.folder,
    )


def test_a_file_that_vanished_is_a_row(watch):
    watched = watch([DARK, BRIGHT])
    (watched.folder / "1.png").unlink()
    drive(watched)
    assert [s.reason for s in watched.watcher.image_labels] == ["", "the image cannot be read"]


def test_images_of_another_size_than_the_cameras_are_an_error(watch):
    watched = watch([np.zeros((240, 320), np.uint8)] * 3)
    with pytest.raises(CameraError, match=r"0\.png: .*320x240.*160x120.*image_size"):
        drive(watched)


def test_one_image_of_another_size_is_a_row(watch):
    watched = watch([DARK, np.zeros((240, 320), np.uint8), DARK])
    drive(watched)
    assert [s.label for s in watched.watcher.image_labels] == ["mud", "", "mud"]
    assert watched.watcher.image_labels[1].reason == "the image is not of the camera's size"


@pytest.mark.parametrize(
    ("classifier", "reason"),
    [
        (ByBrightness(0.006, 81), "the region is smaller than a training patch"),
        (ByBrightness(None, 130), "the region is smaller than a training patch"),
        (ByBrightness(0.002, 32), "the image is too coarse there"),
    ],
)
def test_a_region_that_does_not_compare_with_the_patches_has_no_label(watch, classifier, reason):
    watched = watch([DARK], classifier)
    drive(watched)
    (image_label,) = watched.watcher.image_labels
    assert (image_label.label, image_label.reason) == ("", reason)
    assert classifier.shown == []


def test_half_a_region_may_be_too_small_where_the_whole_is_not(watch):
    """The whole is 80 by 68 pixels, each half 80 by 34."""
    watched = watch([DARK], ByBrightness(0.006, 40), per_tread=True)
    drive(watched)
    assert watched.watcher.image_labels[0].reason == "the region is smaller than a training patch"


@pytest.mark.parametrize(
    ("speeds", "reason"),
    [
        ((0.0, 0.0), "the robot is stationary"),
        ((np.nan, np.nan), "the tread speeds are not known"),
        ((-0.3, 0.3), "the region lies outside the image"),
        ((-0.3, -0.3), "the region lies outside the image"),
    ],
)
def test_where_there_is_no_region_there_is_a_reason(watch, speeds, reason):
    watched = watch([DARK])
    frame = next(f for f in watched.run.frames() if f.image is not None)
    frame = dataclasses.replace(frame, tread_speeds_m_s=np.array(speeds))
    watched.watcher.terrain(frame, estimate_at(frame, speeds=speeds))
    (image_label,) = watched.watcher.image_labels
    assert (image_label.label, image_label.reason, image_label.region) == ("", reason, None)


def test_a_frame_without_an_image_cannot_be_looked_at(watch):
    watched = watch([DARK])
    frame = Frame(0.0, np.array([0.5, 0.5]), 0, None, None)
    assert watched.watcher.terrain(frame, estimate_at(frame)) == Footing.of("mud")
    assert watched.watcher.image_labels == watched.watcher.in_force == []
    with pytest.raises(ValueError, match="no image"):
        watched.watcher.look(frame, estimate_at(frame))


class Doubting(ByBrightness):
    """Says that "mud" is doubtful."""

    def classify(self, images):
        return [
            dataclasses.replace(of, probability_right=0.9 if of.label == "snow" else 0.4)
            for of in super().classify(images)
        ]


@pytest.mark.parametrize(("beyond", "first"), [(0.9, "mud"), (1.1, "unknown")])
def test_doubtful_names_are_unknown_where_the_images_of_the_run_are_unlike(watch, beyond, first):
    watched = watch([DARK, BRIGHT, BRIGHT], Doubting())
    labels = labels_of_a_run(watched, Likeness(20, 0.5, 0.5, (), beyond=beyond))
    assert labels == [first, "snow", "snow"]


@pytest.mark.parametrize(
    ("light", "latest", "first"), [(0.8, 0.8, "mud"), (0.2, 0.8, "unknown"), (0.8, 0.2, "unknown")]
)
def test_names_of_another_light_are_unknown_where_they_depend_on_it(watch, light, latest, first):
    watched = watch([DARK, BRIGHT, BRIGHT])
    of_all, of_latest = (
        Likeness(20, 0.5, 0.5, (), beyond=1.1, light=each) for each in (light, latest)
    )
    assert labels_of_a_run(watched, of_all, of_latest) == [first, "snow", "snow"]


@pytest.mark.parametrize(("beyond", "is_evidence"), [(1.4, False), (1.6, True)])
def test_doubtful_names_are_evidence_of_no_name_where_images_are_far_from_training(
    watch, beyond, is_evidence
):
    watched = watch([DARK, BRIGHT, BRIGHT], Doubting())
    labels_of_a_run(watched, Likeness(20, 0.5, 0.5, (), beyond=beyond))
    of = [(each.label, each.is_evidence) for each in watched.watcher._switch.place_labels]
    assert of == [("unknown", is_evidence), ("snow", True), ("snow", True)]


def test_two_names_side_by_side_are_no_evidence_however_far_images_are_from_training(watch):
    half = DARK.copy()
    half[:, :80] = 200
    watched = watch([half, BRIGHT, BRIGHT], per_tread=True)
    labels_of_a_run(watched, Likeness(20, 0.5, 0.5, (), beyond=1.8))
    of = [each.is_evidence for each in watched.watcher._switch.place_labels]
    assert of == [False, True, True]


class GivenLikeness(RunLikeness):
    """Of a run whose images are as they are said to be."""

    def __init__(self, likeness, latest):
        super().__init__(ByBrightness())
        self.of_all, self.of_latest = likeness, latest

    likeness = property(lambda self: self.of_all)
    latest = property(lambda self: self.of_latest)
    weighed = staticmethod(lambda _, probabilities: probabilities)


def labels_of_a_run(watched, likeness, latest=None):
    watched.watcher.seen = watched.watcher._labeller.seen = GivenLikeness(likeness, latest)
    drive(watched)
    return [image_label.label for image_label in watched.watcher.image_labels]
