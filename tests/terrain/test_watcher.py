"""The watcher on a run of a few frames: what it looks at, and what it does about bad images."""

import dataclasses
from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from odometry.estimation.estimate import Estimate
from odometry.footing import Footing
from odometry.frames import Frame
from odometry.run import Run
from terrain.camera import Camera
from terrain.classification.classifier import Classification
from terrain.errors import CameraError
from terrain.region import RegionConfig
from terrain.switch import SwitchConfig
from terrain.watcher import TerrainWatcher

BRIGHT, DARK = np.full((120, 160), 200, np.uint8), np.full((120, 160), 50, np.uint8)


class ByBrightness:
    """Stands in for a trained classifier: bright ground is "snow"; keeps what it was shown."""

    def __init__(self, metres_per_pixel=0.006, patch_size_px=32, colour=False):
        self.metres_per_pixel, self.patch_size_px = metres_per_pixel, patch_size_px
        self.colour_ = colour
        self.shown = []

    def classify(self, images):
        self.shown += images
        bright = [float(image.mean()) > 128 for image in images]
        return [
            Classification("snow" if is_so else "mud", 0.9 if is_so else 0.7, 0.1, {})
            for is_so in bright
        ]


@pytest.fixture
def watch(tmp_path, world):
    """A watcher over a run whose images, one a second, are given; and its classifier."""

    def make(images, classifier=None, per_tread=False, **settings):
        folder = tmp_path / "run"
        folder.mkdir()
        world.write_toml(folder / "run.toml", robot=world.robot, camera=world.camera)
        stamps_s = np.arange(0.0, len(images) + 1.0, 0.5)
        speeds = np.full(len(stamps_s), world.speed_m_s)
        world.write_csv(
            folder / "odometry.csv", "t,v_left,v_right", zip(stamps_s, speeds, speeds, strict=True)
        )
        rows = ["t,file"]
        for k, image in enumerate(images):
            file = folder / f"{k}.png"
            file.write_bytes(
                image if isinstance(image, bytes) else cv2.imencode(".png", image)[1].tobytes()
            )
            rows.append(f"{k + 0.4},{file.name}")
        (folder / "images.csv").write_text("\n".join(rows) + "\n")
        run = Run.read(folder)
        classifier = classifier or ByBrightness()
        watcher = TerrainWatcher(
            run,
            Camera.from_table(world.camera),
            classifier,
            "mud",
            region=RegionConfig(per_tread=per_tread, **settings),
            switch=SwitchConfig(),
        )
        return SimpleNamespace(run=run, watcher=watcher, classifier=classifier, folder=folder)

    return make


def estimate_at(frame, icrs=(0.15, -0.15, 0.0), speeds=(0.5, 0.5), pose=(0.0, 0.0, 0.0)):
    """Belief at a frame of a robot that drives straight on at 0.5 m/s."""
    return Estimate(
        frame.stamp_s,
        np.array([*pose, *icrs, 0.0, 1.0, 1.0]),
        1e-6 * np.eye(9),
        np.array(speeds),
        "mud",
    )


def drive(watched, corrected=lambda stamp_s: (0.5 * stamp_s, 0.0, 0.0)):
    """Terrain in force at each frame; the estimate that goes in is that of the frame before."""
    frames = list(watched.run.frames())
    estimates = [estimate_at(frame, pose=corrected(frame.stamp_s)) for frame in frames]
    return [
        watched.watcher.terrain(frame, estimate).terrain
        for frame, estimate in zip(frames, estimates[:1] + estimates, strict=False)
    ]


def test_every_image_has_a_sighting_and_the_terrain_after_it(watch):
    watched = watch([DARK, BRIGHT, BRIGHT, BRIGHT, BRIGHT])
    drive(watched)
    sightings = watched.watcher.sightings
    assert [s.label for s in sightings] == ["mud", "snow", "snow", "snow", "snow"]
    assert [s.image for s in sightings] == [f"{k}.png" for k in range(5)]
    assert [s.confidence for s in sightings] == [0.7, 0.9, 0.9, 0.9, 0.9]
    assert [s.stamp_s for s in sightings] == [0.4, 1.4, 2.4, 3.4, 4.4]
    # places at 0.77 m and 1.27 m: the edge between them, at 1.02 m, is passed at 2.04 s
    assert watched.watcher.in_force == ["mud", "mud", "snow", "snow", "snow"]


def jumps_about(stamp_s):
    """Poses as a bad receiver corrects them: off by metres, another way every second."""
    return (0.5 * stamp_s + 40.0 * (int(stamp_s) % 2), -7.0 * int(stamp_s), 2.0 * int(stamp_s))


@pytest.mark.parametrize("corrected", [lambda stamp_s: (0.5 * stamp_s, 0.0, 0.0), jumps_about])
def test_the_place_counts_along_the_driven_path(watch, corrected):
    """The estimate is that of the frame before, and what corrects its pose moves no place."""
    watched = watch([DARK, BRIGHT, BRIGHT, BRIGHT, BRIGHT])
    drive(watched, corrected)
    (event,) = watched.watcher.events
    assert event.sight.place == pytest.approx(
        [0.5 * event.sight.stamp_s + event.sight.distance_ahead_m, 0.0], abs=1e-9
    )
    assert event.stamp_s == 2.4  # the second label, a little after the edge
    assert event.waited_s == pytest.approx(2.4 - 1.4)
    assert event.waited_m == pytest.approx(0.5 * (2.4 - 1.4))


@pytest.mark.parametrize(("gap_ends_s", "terrain"), [(0.0, "snow"), (2.0, "mud")])
def test_over_a_gap_of_odometry_places_are_forgotten(watch, gap_ends_s, terrain):
    """Snow is seen before the gap and after it; one label alone brings nothing into force."""
    watched = watch([DARK, BRIGHT, BRIGHT])
    frames = list(watched.run.frames())
    frames = [dataclasses.replace(f, in_gap=1.4 < f.stamp_s <= gap_ends_s) for f in frames]
    estimates = [estimate_at(frame) for frame in frames]
    pairs = zip(frames, estimates[:1] + estimates, strict=False)
    footings = [watched.watcher.terrain(frame, estimate) for frame, estimate in pairs]
    assert footings[-1].terrain == terrain


def test_the_region_follows_the_speeds_commanded_from_the_image_on(watch):
    """Straight until now; from this frame on a turn to the left about the believed ICRs."""
    watched = watch([DARK])
    frame = next(f for f in watched.run.frames() if f.image is not None)
    turning = dataclasses.replace(frame, tread_speeds_m_s=np.array([0.48, 0.52]))
    icrs = (0.3, -0.2, 0.05)
    region = watched.watcher.look(turning, estimate_at(frame, icrs=icrs)).region
    omega = 0.04 / 0.5
    assert region.pose_ahead[2] == pytest.approx(omega * region.ahead_s)
    assert region.distance_ahead_m == pytest.approx(0.5 * region.ahead_s)
    v_x, v_y = (0.52 * 0.3 + 0.48 * 0.2) / 0.5, -0.05 * omega
    chord = np.hypot(v_x, v_y) * 2 * np.sin(omega * region.ahead_s / 2) / omega
    assert np.hypot(*region.pose_ahead[:2]) == pytest.approx(chord)


def test_the_region_follows_the_effects_of_the_terrain(watch):
    """Effects slow both treads to a half and turn the robot at 0.1 rad/s."""
    watched = watch([DARK])
    frame = next(f for f in watched.run.frames() if f.image is not None)
    plain = watched.watcher.look(frame, estimate_at(frame)).region
    bent = dataclasses.replace(
        estimate_at(frame),
        added_speeds_m_s=np.array([-0.25, -0.25]),
        added_twist=np.array([0.0, 0.0, 0.1]),
    )
    region = watched.watcher.look(frame, bent).region
    assert region.pose_ahead[2] == pytest.approx(0.1 * region.ahead_s)
    path_m = 0.25 * region.ahead_s
    assert np.hypot(*region.pose_ahead[:2]) == pytest.approx(path_m, rel=0.01)
    assert path_m == pytest.approx(0.5 * plain.ahead_s, rel=0.1)


def test_the_classifier_is_shown_the_metric_scale_it_was_trained_at(watch):
    """Twice the metres to a pixel, half the pixels; 1.2 times 0.4 m by 0.34 m of ground."""
    coarse, fine = ByBrightness(0.012, 16), ByBrightness(0.006, 32)
    watched = watch([DARK], fine)
    drive(watched)
    other = TerrainWatcher(
        watched.run,
        Camera.from_table(watched.run.settings["camera"]),
        coarse,
        "mud",
        region=RegionConfig(),
        switch=SwitchConfig(),
    )
    drive(SimpleNamespace(run=watched.run, watcher=other))
    assert fine.shown[0].shape == (80, 68)  # 0.48 m and 0.408 m
    assert coarse.shown[0].shape == (40, 34)


def test_without_a_metric_scale_the_classifier_is_shown_pixels_of_the_raw_image(watch, world):
    """Pixels tell their own place; those that show the region's ground are in the crop."""
    v, u = np.indices((120, 160)).astype(np.uint8)
    classifier = ByBrightness(None, 16)
    watched = watch([np.stack([v, v, u], axis=-1)], classifier)  # OpenCV writes blue first
    drive(watched)
    (crop,), (sighting,) = classifier.shown, watched.watcher.sightings
    assert (np.diff(crop[..., 0].astype(int), axis=1) == 1).all()
    assert (np.diff(crop[..., 1].astype(int), axis=0) == 1).all()
    box = sighting.region.rectangle
    x, y = np.moveaxis(world.ground_seen(world.camera), -1, 0)
    inside = (x >= box.x_min) & (x <= box.x_max) & (y >= box.y_min) & (y <= box.y_max)
    rows, columns = np.nonzero(inside)
    seen = [crop[0, 0, 1], crop[-1, -1, 1], crop[0, 0, 0], crop[-1, -1, 0]]
    wanted = [rows.min(), rows.max(), columns.min(), columns.max()]
    np.testing.assert_allclose(np.array(seen, int), wanted, atol=2)


def test_a_robot_astride_an_edge_is_seen_as_such(watch):
    """The left of the image is bright."""
    half = DARK.copy()
    half[:, :80] = 200
    watched = watch([BRIGHT, half, half, DARK], per_tread=True)
    drive(watched)
    assert [(s.label, s.left, s.right) for s in watched.watcher.sightings] == [
        ("snow", "snow", "snow"),
        ("unknown", "snow", "mud"),
        ("unknown", "snow", "mud"),
        ("mud", "mud", "mud"),
    ]
    assert watched.watcher.sightings[1].reason == "astride: snow on the left, mud on the right"
    assert watched.watcher.sightings[1].confidence == 0.7  # of the less certain
    assert set(watched.watcher.in_force) == {"mud"}


def cut_short(image):
    """The first half of its PNG file."""
    data = cv2.imencode(".png", image)[1].tobytes()
    return data[: len(data) // 2]


@pytest.mark.parametrize("bad", [b"", b"no image", cut_short(DARK)], ids=["empty", "text", "cut"])
def test_an_image_that_cannot_be_read_is_a_row_and_the_run_goes_on(watch, bad, capfd):
    watched = watch([DARK, BRIGHT, bad, BRIGHT, BRIGHT])
    terrains = drive(watched)
    capfd.readouterr()  # the image library speaks of the damage on its own
    bad_one = watched.watcher.sightings[2]
    assert bad_one.label == ""
    assert bad_one.reason == "the image cannot be read"
    assert np.isnan(bad_one.confidence)
    assert [s.label for s in watched.watcher.sightings] == ["mud", "snow", "", "snow", "snow"]
    assert terrains[-1] == "snow"  # it breaks no row


def test_a_grey_image_among_coloured_ones_is_a_row_and_the_run_goes_on(watch):
    bright, dark = (np.repeat(image[..., None], 3, axis=2) for image in (BRIGHT, DARK))
    watched = watch([dark, bright, BRIGHT, bright, bright], ByBrightness(colour=True))
    assert drive(watched)[-1] == "snow"
    assert [s.label for s in watched.watcher.sightings] == ["mud", "snow", "", "snow", "snow"]
    reason = "the image is grey, the model was trained with colour"
    assert watched.watcher.sightings[2].reason == reason


def test_a_region_of_which_a_corner_is_outside_the_image_has_a_label(watch):
    """A left turn of 0.4 m radius: at every look-ahead a corner of the footprint is outside."""
    watched = watch([BRIGHT])
    frame = next(f for f in watched.run.frames() if f.image is not None)
    turning = dataclasses.replace(frame, tread_speeds_m_s=np.array([0.3125, 0.6875]))
    whole = watch_whole(watched)
    assert whole.look(turning, estimate_at(frame)).reason == "the region lies outside the image"
    sighting = watched.watcher.look(turning, estimate_at(frame))
    assert sighting.label == "snow"
    (shown,) = watched.classifier.shown
    assert min(shown.shape) >= watched.classifier.patch_size_px


def watch_whole(watched):
    """A watcher that labels a region only where the image shows all of it."""
    return TerrainWatcher(
        watched.run,
        Camera.from_table(watched.run.settings["camera"]),
        watched.classifier,
        "mud",
        region=RegionConfig(least_share=1.0),
        switch=SwitchConfig(),
    )


def test_a_file_that_vanished_is_a_row(watch):
    watched = watch([DARK, BRIGHT])
    (watched.folder / "1.png").unlink()
    drive(watched)
    assert [s.reason for s in watched.watcher.sightings] == ["", "the image cannot be read"]


def test_images_of_another_size_than_the_cameras_are_an_error(watch):
    watched = watch([np.zeros((240, 320), np.uint8)] * 3)
    with pytest.raises(CameraError, match=r"0\.png: .*320x240.*160x120.*image_size"):
        drive(watched)


def test_one_image_of_another_size_is_a_row(watch):
    watched = watch([DARK, np.zeros((240, 320), np.uint8), DARK])
    drive(watched)
    assert [s.label for s in watched.watcher.sightings] == ["mud", "", "mud"]
    assert watched.watcher.sightings[1].reason == "the image is not of the camera's size"


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
    (sighting,) = watched.watcher.sightings
    assert (sighting.label, sighting.reason) == ("", reason)
    assert classifier.shown == []


def test_half_a_region_may_be_too_small_where_the_whole_is_not(watch):
    """The whole is 80 by 68 pixels, each half 80 by 34."""
    watched = watch([DARK], ByBrightness(0.006, 40), per_tread=True)
    drive(watched)
    assert watched.watcher.sightings[0].reason == "the region is smaller than a training patch"


@pytest.mark.parametrize(
    ("speeds", "reason"),
    [
        ((0.0, 0.0), "the robot stands"),
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
    (sighting,) = watched.watcher.sightings
    assert (sighting.label, sighting.reason, sighting.region) == ("", reason, None)


def test_a_frame_without_an_image_cannot_be_looked_at(watch):
    watched = watch([DARK])
    frame = Frame(0.0, np.array([0.5, 0.5]), 0, None, None)
    assert watched.watcher.terrain(frame, estimate_at(frame)) == Footing.of("mud")
    assert watched.watcher.sightings == watched.watcher.in_force == []
    with pytest.raises(ValueError, match="no image"):
        watched.watcher.look(frame, estimate_at(frame))
