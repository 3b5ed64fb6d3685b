"""Parts of images that stay while the terrain moves, drawn here, and drives without any."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from odometry.checks.findings.finding import CheckReport
from terrain.believed import run_to_label
from terrain.camera.camera import Camera
from terrain.camera.robot_outlines import covered
from terrain.checks.fixed_parts import FEWEST, fixed_parts, robot_in_images
from terrain.checks.image_motion import image_motion
from terrain.checks.terrain_views import TerrainViews
from terrain.config import Config
from terrain.run_options import RunOptions

SIZE = (640, 480)
SWAY_PX = 2.0


def bumper(image, rng):
    """A dark plate with bolts over the lowest sixth."""
    cv2.rectangle(image, (0, 200), (320, 240), 50, -1)
    for u in range(20, 320, 40):
        cv2.circle(image, (u, 220), 5, 130, -1)
    return image + rng.normal(0, 1.5, image.shape)


def smooth_plate(image, rng):
    """The same with nothing on it, and as bright as the terrain."""
    cv2.rectangle(image, (0, 200), (320, 240), 122, -1)
    return image + rng.normal(0, 0.2, image.shape)


def leg(image, rng):
    """A bright tube of a lidar's tripod, not at the border."""
    cv2.rectangle(image, (150, 120), (160, 190), 210, -1)
    return image + rng.normal(0, 1.5, image.shape)


def drops(image, _):
    """Three dark spots without an edge, before the terrain ahead."""
    spots = np.zeros_like(image)
    for place in ((110, 150), (160, 190), (205, 160)):
        cv2.circle(spots, place, 16, 1.0, -1)
    return image * (1 - 0.75 * cv2.GaussianBlur(spots, (0, 0), 3))


def shadow(image, _):
    """Of a robot that has the sun behind it."""
    outline = np.array([[100, 240], [110, 150], [190, 150], [200, 240]])
    return image * (1 - 0.55 * cv2.fillPoly(np.zeros_like(image), [outline], 1.0))


def verge(image, rng):
    """Dark terrain to the left of a smooth way, which the robot keeps to some pixels."""
    smooth = 120 + 0.3 * (image - 120)
    return smooth * np.where(np.arange(320) < 120 + SWAY_PX * rng.normal(), 0.5, 1.0)


def soft_verge(image, _):
    """Terrain that becomes darker to the left, without an edge."""
    return image * (0.35 + 0.65 / (1 + np.exp((100 - np.arange(320)) / 8)))


def frame(image, rng):
    """A hood round the whole image: the terrain within it is no part of the robot."""
    cv2.rectangle(image, (0, 0), (319, 239), 40, 30)
    for u in range(5, 320, 30):
        cv2.circle(image, (u, 233), 4, 130, -1)
    return image + rng.normal(0, 1.5, image.shape)


PARTS = {
    bumper: (slice(402, 480), slice(0, 640)),
    smooth_plate: (slice(402, 480), slice(0, 640)),
    leg: (slice(242, 380), slice(302, 320)),
    shadow: (slice(300, 480), slice(210, 390)),
}


class WithParts:
    """The images of a run with something drawn into them."""

    def __init__(self, run, draw):
        self._views, self._draw = TerrainViews(run, SIZE), draw
        self._rng = np.random.default_rng(4)

    def grey(self, name):
        image = self._draw(self._views.grey(name).astype(np.float32), self._rng)
        return np.clip(image, 0, 255).astype(np.uint8)


@pytest.mark.parametrize("draw", PARTS)
def test_what_stays_is_outlined_and_little_beside_it(drive, camera, draw):
    parts = fixed_parts(drive, camera, WithParts(drive, draw))
    robot = np.zeros((480, 640), bool)
    robot[PARTS[draw]] = True
    found = covered(parts.outlines, SIZE)
    assert (found & robot).sum() > 0.95 * robot.sum()
    beside = cv2.dilate(robot.astype(np.uint8), np.ones((69, 69))) > 0  # two squares of 16 px
    assert not (found & ~beside).any()
    (finding,) = robot_in_images(parts)
    assert (finding.name, finding.level) == ("robot_in_images", "note")
    mended = Camera.from_table(finding.mend(drive).settings["camera"])
    assert not mended.shows_terrain(np.argwhere(robot)[:, ::-1][::500]).any()


@pytest.mark.parametrize(
    "draw",
    [
        lambda image, _: image,
        lambda image, rng: 0.3 * image + 60 + rng.normal(0, 4, image.shape),
        lambda image, _: 0 * image + cv2.resize(image[:2, :2], (320, 240)),
        verge,
        soft_verge,
        lambda image, _: 100 + (image - 100) * np.clip((180 - np.arange(240)) / 180, 0, 1)[:, None],
    ],
    ids=[
        "as it is",
        "dim and noisy",
        "nothing but a smooth surface",
        "a verge",
        "a soft verge",
        "smooth where it is near",
    ],
)
def test_terrain_has_no_parts_that_stay(drive, camera, draw):
    assert fixed_parts(drive, camera, WithParts(drive, draw)) is None


def test_drops_are_found_from_when_they_come(drive, camera):
    images = WithParts(drive, lambda image, _: image)
    count = iter(range(100))
    images._draw = lambda image, rng: drops(image, rng) if next(count) > 20 else image
    found = covered(fixed_parts(drive, camera, images).outlines, SIZE)
    assert all(found[v, u] for u, v in ((220, 300), (320, 380), (410, 320)))
    assert found.mean() < 0.15


def test_a_bumper_before_dim_terrain_is_one(drive, camera):
    """The details at its border hardly jump; its bolts stay."""

    def dim(image, rng):
        return bumper(100 + 0.2 * image, rng)

    parts = fixed_parts(drive, camera, WithParts(drive, dim))
    assert covered(parts.outlines, SIZE)[PARTS[bumper]].mean() > 0.95


def test_terrain_within_a_frame_is_terrain(drive, camera):
    parts = fixed_parts(drive, camera, WithParts(drive, frame))
    found = covered(parts.outlines, SIZE)
    assert found[440:].mean() > 0.9
    assert found[150:380, 100:540].mean() == 0.0


def test_a_camera_that_is_frozen_is_no_robot(drive, camera):
    still = WithParts(drive, lambda image, _: image)
    first = still.grey(str(drive.images["file"][0]))
    noisy = WithParts(drive, lambda image, rng: first + rng.normal(0, 1, image.shape))
    assert fixed_parts(drive, camera, noisy) is None


def test_few_images_do_not_say(drive, camera):
    run = replace(drive, images=drive.images.rows(np.arange(FEWEST - 1)))
    assert fixed_parts(run, camera, WithParts(run, bumper)) is None
    assert fixed_parts(replace(drive, images=None), camera, WithParts(drive, bumper)) is None


def test_parts_that_are_stated_are_no_finding(drive, camera):
    found = fixed_parts(drive, camera, WithParts(drive, bumper))
    stated = replace(camera, robot_outlines=found.outlines)
    assert fixed_parts(drive, stated, WithParts(drive, bumper)) is None


def test_features_of_the_robot_are_not_compared(drive, camera):
    first, second = map(str, drive.images["file"][40:42])
    views = TerrainViews(drive, SIZE)
    half = np.array([[0, 240], [639, 240], [639, 479], [0, 479]], float)
    before, _ = views.same(camera, first, second)
    above, _ = views.same(replace(camera, robot_outlines=(half,)), first, second)
    assert before[:, 1].max() > 300
    assert above[:, 1].max() < 240


def test_the_check_says_it_and_goes_on(drive, camera, monkeypatch):
    grey, rng = TerrainViews.grey, np.random.default_rng(4)

    def with_bumper(self, name):
        image = bumper(grey(self, name).astype(np.float32), rng)
        return np.clip(image, 0, 255).astype(np.uint8)

    monkeypatch.setattr(TerrainViews, "grey", with_bumper)
    found, reason = image_motion(replace(drive, folder=drive.folder / "images" / ".."), camera)
    assert ([finding.name for finding in found], reason) == (["robot_in_images"], "")


def test_run_and_label_leave_the_parts_out_and_a_preset_does_not(drive, camera):
    findings = tuple(robot_in_images(fixed_parts(drive, camera, WithParts(drive, bumper))))
    report = CheckReport(drive.folder, findings)
    labelled = run_to_label(drive, report)
    assert len(labelled.settings["camera"]["robot_outlines"]) == 1
    options = RunOptions(Config(), model=Path("a.model"))
    ran, _, _ = options.believed(drive, report)
    assert ran.settings == labelled.settings
    assert replace(options, preset="chen2023").believed(drive, report)[0] is drive
    assert replace(options, vision=False).believed(drive, report)[0] is drive
    assert options.believed(drive, CheckReport(drive.folder, ()))[0] is drive
