"""The watcher on a run of a few frames: what it looks at."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from terrain.camera.camera import Camera
from terrain.region.region import RegionConfig
from terrain.sources.watcher import TerrainWatcher
from terrain.switch.switch import SwitchConfig
from tests.terrain.sources.watched import BRIGHT, DARK, ByBrightness, drive, estimate_at


def test_every_image_has_a_sighting_and_the_terrain_after_it(watch):
    watched = watch([DARK, BRIGHT, BRIGHT, BRIGHT, BRIGHT])
    drive(watched)
    image_labels = watched.watcher.image_labels
    assert [s.label for s in image_labels] == ["mud", "snow", "snow", "snow", "snow"]
    assert [s.image for s in image_labels] == [f"{k}.png" for k in range(5)]
    assert [s.confidence for s in image_labels] == [0.7, 0.9, 0.9, 0.9, 0.9]
    assert [s.stamp_s for s in image_labels] == [0.4, 1.4, 2.4, 3.4, 4.4]
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
    assert event.first_label.place == pytest.approx(
        [0.5 * event.first_label.stamp_s + event.first_label.distance_ahead_m, 0.0], abs=1e-9
    )
    assert event.stamp_s == 2.4  # the second label, a little after the edge
    assert event.waited_s == pytest.approx(2.4 - 1.4)
    assert event.waited_m == pytest.approx(0.5 * (2.4 - 1.4))


@pytest.mark.parametrize(("gap_ends_s", "terrain"), [(0.0, "snow"), (3.0, "mud")])
def test_over_a_gap_of_odometry_places_are_forgotten(watch, gap_ends_s, terrain):
    """Images show snow before the gap and mud after it."""
    watched = watch([BRIGHT, BRIGHT, BRIGHT, DARK])
    frames = list(watched.run.frames())
    frames = [dataclasses.replace(f, in_gap=2.4 < f.stamp_s <= gap_ends_s) for f in frames]
    estimates = [estimate_at(frame) for frame in frames]
    pairs = zip(frames, estimates[:1] + estimates, strict=False)
    footings = [watched.watcher.terrain(frame, estimate) for frame, estimate in pairs]
    assert footings[-1].terrain == terrain


def test_the_region_follows_the_speeds_commanded_from_the_image_on(watch):
    """Straight until now; from this frame on a turn to the left about the estimated ICRs."""
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


def test_the_region_follows_the_slip_believed(watch):
    """Equal tread speeds, of which the right one keeps less: the robot will turn right."""
    watched = watch([DARK])
    frame = next(f for f in watched.run.frames() if f.image is not None)
    straight = estimate_at(frame)
    slipping = dataclasses.replace(straight, mean=np.append(straight.mean[:7], [0.9, 0.87]))
    region = watched.watcher.look(frame, slipping).region
    assert region.pose_ahead[2] == pytest.approx(0.5 * (0.87 - 0.9) / 0.3 * region.ahead_s)
    assert region.distance_ahead_m == pytest.approx(0.5 * region.ahead_s)  # of the wheels


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_place_is_reached_from_the_corners_of_its_region_on(watch, scale):
    """A slow robot, so that its labels suffice long before it is there."""
    watched = watch([BRIGHT] * 9, footprint_scale=scale)
    speed_m_s = np.full(2, 0.1)
    for frame in watched.run.frames():
        slow = dataclasses.replace(frame, tread_speeds_m_s=speed_m_s)
        watched.watcher.terrain(slow, estimate_at(frame, speeds=speed_m_s))
    (event,) = watched.watcher.events
    away_m = event.first_label.place[0] - 0.1 * event.stamp_s
    corner_m = scale * np.hypot(0.4, 0.34) / 2
    assert 0.7 * corner_m < away_m < corner_m


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
        watched.run.robot,
        Camera.from_table(watched.run.settings["camera"]),
        coarse,
        "mud",
        region=RegionConfig(),
        switch=SwitchConfig(),
        folder=watched.folder,
    )
    drive(SimpleNamespace(run=watched.run, watcher=other))
    assert fine.shown[0].shape == (80, 68)  # 0.48 m and 0.408 m
    assert coarse.shown[0].shape == (40, 34)


def test_without_a_metric_scale_the_classifier_is_shown_pixels_of_the_raw_image(watch, world):
    """Pixels encode their own place; those that show the region's ground are in the crop."""
    v, u = np.indices((120, 160)).astype(np.uint8)
    classifier = ByBrightness(None, 16)
    watched = watch([np.stack([v, v, u], axis=-1)], classifier)  # OpenCV writes blue first
    drive(watched)
    (crop,), (image_label,) = classifier.shown, watched.watcher.image_labels
    assert (np.diff(crop[..., 0].astype(int), axis=1) == 1).all()
    assert (np.diff(crop[..., 1].astype(int), axis=0) == 1).all()
    box = image_label.region.rectangle
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
    assert [(s.label, s.left, s.right) for s in watched.watcher.image_labels] == [
        ("snow", "snow", "snow"),
        ("unknown", "snow", "mud"),
        ("unknown", "snow", "mud"),
        ("mud", "mud", "mud"),
    ]
    assert watched.watcher.image_labels[1].reason == "astride: snow on the left, mud on the right"
    assert watched.watcher.image_labels[1].confidence == 0.7  # of the less certain
    assert set(watched.watcher.in_force) == {"mud"}


class UnknownIfDark(ByBrightness):
    """Says that dark images resemble no terrain."""

    def classify(self, images):
        return [
            dataclasses.replace(of, label="unknown") if of.label == "mud" else of
            for of in super().classify(images)
        ]


class FeltNothing:
    """A source by feel that names terrains which the camera does not know."""

    def between(self, *_):
        return iter(())

    def beside(self, seen):
        return {**seen, "ice": 0.5}


@pytest.mark.parametrize("felt", [None, FeltNothing()])
def test_an_image_that_resembles_no_terrain_says_nothing_beside_feel(watch, felt):
    """It may be of a terrain that feel alone knows."""
    watched = watch([DARK, BRIGHT], UnknownIfDark())
    watched.watcher._felt = felt
    drive(watched)
    of = [(each.label, each.is_evidence) for each in watched.watcher._switch.place_labels]
    assert of == [("unknown", felt is None), ("snow", True)]
