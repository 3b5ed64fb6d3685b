"""Details that come back over metres of terrain, and what is no return."""

import cv2
import numpy as np
import pytest

from terrain.image_labels import details_watch
from terrain.image_labels.details_watch import DetailsWatch
from terrain.image_labels.slow_return import LEARNT_M, SlowReturn
from terrain.image_labels.terrain_details import TileDetails
from tests.terrain.image_labels.test_still_image import PX_M, down
from tests.terrain.image_labels.test_still_image import seen as shown

STEP_M = 0.5
LOSS = -0.9
GOES = [0.16] * 6 + [0.0] * 8  # changes of contrast over 3 m, and over 4 m of steady images


@pytest.fixture(scope="module")
def image():
    noise = np.random.default_rng(4).normal(0, 1, (240, 320))
    return np.clip(120 + 200 * cv2.GaussianBlur(noise, (0, 0), 1.5), 0, 255).astype(np.uint8)


def returns(image, changes, latest=None, *, clear=8, drift=0.0, ahead_m=STEP_M):
    """Whether details are back after each of the changes, from clear images on."""
    slow, details = SlowReturn(), TileDetails.of(image)
    for _ in range(clear):
        slow.add_clear(details, drift, STEP_M)
    slow.begin(details, LOSS)
    lost = details if latest is None else TileDetails.of(latest)
    steps_m = np.broadcast_to(ahead_m, len(changes))
    return [slow.is_back(lost, one, ahead) for one, ahead in zip(changes, steps_m, strict=True)]


def test_details_that_rise_by_what_was_lost_are_back_once_they_are_steady(image):
    assert returns(image, GOES) == [False] * 11 + [True] * 3


@pytest.mark.parametrize(
    "changes",
    [
        [0.0] * 30,
        [0.02] * 60,
        [0.1] * 6 + [0.0] * 8,
        [-0.35, *GOES],
        [*GOES[:6], 0.0, 0.25, 0.0, 0.0, 0.0, 0.0],
        [0.8, 0.8, 0.0, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [*GOES[:6], 0.0, None, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ],
    ids=["none", "too slow", "half", "from deeper", "rises on", "falls", "not compared"],
)
def test_another_course_is_no_return(image, changes):
    assert not any(returns(image, changes))


def test_terrain_that_gains_details_on_its_way_is_no_return(image):
    nearer = 0.1  # of each change: in blur and fog more than in clear images
    assert not any(returns(image, [one + nearer for one in GOES]))
    assert returns(image, [one + nearer for one in GOES], drift=nearer)[-1]


def test_how_clear_images_change_must_be_known(image):
    assert not any(returns(image, GOES, clear=3))
    assert not any(returns(image, GOES, clear=0))


def test_only_images_of_a_robot_that_drives_ahead_are_followed(image):
    back = np.where(np.arange(len(GOES)) == 7, -STEP_M, STEP_M)
    assert not any(returns(image, GOES, ahead_m=back))


@pytest.mark.parametrize(
    "change",
    [
        lambda image: 0.5 * image + 60,
        lambda image: cv2.GaussianBlur(image, (0, 0), 1.0),
        lambda image: np.full_like(image, 120),
    ],
    ids=["veil", "blur", "nothing"],
)
def test_images_without_the_details_of_clear_ones_are_no_return(image, change):
    assert not any(returns(image, GOES, change(image.astype(np.float32)).astype(np.uint8)))


def test_the_focus_of_smooth_terrain_is_not_known(image):
    smooth = np.where(np.arange(320) < 32, image, 120 + image // 128).astype(np.uint8)
    assert not any(returns(smooth, GOES))


@pytest.fixture(scope="module")
def endless():
    """Greys (2000, 2000) of random terrain that goes on at the other side."""
    noise = np.pad(np.random.default_rng(4).normal(0, 1, (2000, 2000)), 8, mode="wrap")
    return 120 + 200 * cv2.GaussianBlur(noise, (0, 0), 1.5)[8:-8, 8:-8]


def lost(world, change, thick, step_px=50):
    """Whether each image of a drive lacks details, by how thick (0 to 1) a change is in it."""
    camera, found = down(50), []
    watch = DetailsWatch(camera)
    for row, share in enumerate(thick):
        image = shown(np.roll(world, -step_px * row, axis=1), camera, noise=2, seed=row)
        image = change(image.astype(np.float32), share) if share else image
        pose = np.array([row * step_px * PX_M, 0.0, 0.0])
        found.append(watch.has_lost(np.clip(image, 0, 255).astype(np.uint8), pose))
    return found


def fog(image, share):
    return (1 - 0.65 * share) * image + 0.65 * share * 170


def blur(image, share):
    return cv2.GaussianBlur(image, (0, 0), 2.5 * share)


@pytest.mark.parametrize("change", [fog, blur])
def test_labels_are_back_after_a_loss_that_ends_slowly_and_not_before(endless, change):
    clear, thick = [0.0] * 15, [1.0] * 10
    goes = np.linspace(1, 0, 18)[1:-1].tolist()
    found = lost(endless, change, [*clear, *thick, *goes, *[0.0] * 25])
    assert not any(found[:15])
    assert all(found[15:41])
    assert not found[-1]
    assert all(lost(endless, change, [*clear, *[1.0] * 51])[15:])


def test_clear_images_are_not_compared_any_more_once_it_is_known_how_they_change(
    endless, monkeypatch
):
    compared, compare = [], details_watch.change_of_details

    def counted(*given):
        compared.append(given)
        return compare(*given)

    monkeypatch.setattr(details_watch, "change_of_details", counted)
    assert not any(lost(endless, fog, [0.0] * 75))
    assert 0 <= len(compared) - round(LEARNT_M / (50 * PX_M)) <= 2
    assert lost(endless, fog, [*[0.0] * 60, *[1.0] * 3, 0.0]) == [*[False] * 60, *[True] * 3, False]


def test_fog_that_comes_over_images_close_together_is_noticed_then_as_well(endless):
    watch, camera, found = DetailsWatch(down(50)), down(50), []
    near_m = [0.02 * row for row in range(8)]
    for way_m, share in zip(
        [*np.arange(0.0, 12.0, 0.4), *(12.0 + np.array(near_m))],
        [*[0.0] * 30, *np.minimum(np.arange(8) / 6, 1.0)],
        strict=True,
    ):
        world = np.roll(endless, -round(way_m / PX_M), axis=1)
        image = fog(shown(world, camera).astype(np.float32), share).astype(np.uint8)
        found.append(watch.has_lost(image, np.array([way_m, 0.0, 0.0])))
    assert found[-1]
    assert not any(found[:32])


def test_what_clear_images_do_later_teaches_no_more(image):
    slow, details = SlowReturn(), TileDetails.of(image)
    for _ in range(20):
        slow.add_clear(details, 0.0, STEP_M)
    assert slow.knows_clear
    for _ in range(8):  # such as look like a loss in place
        slow.add_clear(details, -0.2, STEP_M)
    slow.begin(details, LOSS)
    assert [slow.is_back(details, one, STEP_M) for one in GOES][-1]
