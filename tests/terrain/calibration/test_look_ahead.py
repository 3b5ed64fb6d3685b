"""What the image shows and how large a metre is, by hand; a pitch that shows the region."""

import numpy as np
import pytest

from odometry.recording.run import Robot
from terrain.calibration.look_ahead import (
    look_ahead,
    metre_px,
    nearest_seen_m,
    pitched,
    suggest_pitch,
)
from terrain.camera.camera import Camera
from terrain.region.region import NoRegion

ROBOT = Robot(track_width=0.4, length=0.5, width=0.5)
MATRIX = [[400.0, 0.0, 319.5], [0.0, 400.0, 239.5], [0.0, 0.0, 1.0]]


def camera(pitch_deg, z=0.6):
    mount = [0.1, 0.0, z, 0.0, np.radians(pitch_deg), 0.0]
    return Camera.from_mount((640, 480), MATRIX, [], mount)


def test_a_metre_straight_below():
    """f / h pixels, both ways."""
    np.testing.assert_allclose(metre_px(camera(90), np.array([0.1, 0.0])), 400 / 0.6, rtol=1e-5)


def test_a_metre_under_a_level_camera():
    """At the distance d: across f / d, along f h / d^2."""
    across, along = metre_px(camera(0), np.array([2.1, 0.0]))
    assert across == pytest.approx(400 / 2, rel=1e-4)
    assert along == pytest.approx(400 * 0.6 / 4, rel=1e-3)


def test_the_nearest_terrain_in_sight():
    """The lowest row looks atan(239.5 / 400) below the axis."""
    assert nearest_seen_m(camera(0)) == pytest.approx(0.1 + 0.6 * 400 / 239.5, abs=0.011)
    assert nearest_seen_m(camera(-40)) is None


def test_a_camera_that_sees_it_whole():
    ahead = look_ahead(camera(35), ROBOT)
    assert ahead.whole
    assert ahead.region.rectangle.x_min > 0


def test_a_part_only():
    """A camera straight above the robot's front shows a part of each footprint."""
    narrow = Camera.from_mount(
        (640, 480), [[900.0, 0, 319.5], [0, 900.0, 239.5], [0, 0, 1]], [], [0.3, 0, 0.8, 0, 1.4, 0]
    )
    assert not look_ahead(narrow, ROBOT).whole


def test_a_pitch_is_suggested_where_the_region_is_missed():
    up = camera(-25)
    assert look_ahead(up, ROBOT) == NoRegion("the region lies outside the image")
    found = suggest_pitch(up, ROBOT)
    for pitch_deg in (found.least_deg, found.suggested_deg, found.most_deg):
        assert look_ahead(pitched(up, pitch_deg), ROBOT).whole
    assert found.suggested_deg == found.least_deg + 3
    steep = suggest_pitch(camera(80), ROBOT)
    assert steep.suggested_deg == steep.most_deg - 3


def test_no_pitch_will_do():
    low = Camera.from_mount((64, 480), [[900.0, 0, 31.5], [0, 400.0, 239.5], [0, 0, 1]], [],
                            [0.3, 0, 0.1, 0, 0.2, 0])  # fmt: skip
    assert suggest_pitch(low, ROBOT) is None


def test_a_homography_has_no_pitch():
    seen = camera(30)
    flat = Camera.from_homography((640, 480), MATRIX, [], seen.ground_to_image)
    with pytest.raises(ValueError, match="mount"):
        suggest_pitch(flat, ROBOT)
