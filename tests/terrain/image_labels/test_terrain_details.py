"""Images that lose details of the same terrain while a robot drives, and what is no loss."""

import cv2
import numpy as np
import pytest

from terrain.image_labels.details_watch import LOSSES, NEAR_M, DetailsWatch
from terrain.image_labels.terrain_details import (
    LOSS,
    WIDTH_PX,
    TileDetails,
    may_have_lost,
    reduced,
)
from terrain.image_labels.terrain_details import change_of_details as change_from
from tests.terrain.image_labels.test_still_image import SIZE, down
from tests.terrain.image_labels.test_still_image import seen as shown

LENGTH, STEP_M = 14, 0.13
WAY_M = STEP_M * np.arange(LENGTH)
FROM, TO = 5, 10  # images that are changed


@pytest.fixture(scope="module")
def rough():
    """Greys (2000, 2000) of random terrain around the origin."""
    noise = np.random.default_rng(4).normal(0, 1, (2000, 2000))
    return 120 + 200 * cv2.GaussianBlur(noise, (0, 0), 1.5)


def change_of_details(camera, before, after, step):
    return change_from(camera, TileDetails.of(before), after, step)


def fog(image):
    return 0.35 * image + 110


def blurred(size_px):
    return lambda image: cv2.GaussianBlur(image, (0, 0), size_px)


def lost(world, change, poses_m=WAY_M, begin=FROM, end=TO):
    """Whether each image of a drive lacks details, some of which are changed."""
    camera, found = down(50), []
    watch = DetailsWatch(camera)
    for row, x in enumerate(poses_m):
        pose = np.array([x, 0.0, 0.0])
        image = shown(world, camera, pose, noise=2, seed=row).astype(np.float32)
        image = change(image) if begin <= row < end else image
        found.append(watch.has_lost(np.clip(image, 0, 255).astype(np.uint8), pose))
    return found


@pytest.mark.parametrize("change", [fog, blurred(2.5)], ids=["fog", "another focus"])
def test_details_are_lost_from_the_first_to_the_last_image(rough, change):
    assert lost(rough, change) == [FROM <= row < TO for row in range(LENGTH)]


def test_a_little_blur_is_a_loss_of_the_focus_alone(rng):
    sizes_px = (1.0, 2.0, 4.0, 8.0)
    noise = rng.normal(0, 1, (4, 2000, 2000))
    parts = (cv2.GaussianBlur(n, (0, 0), of) * of for n, of in zip(noise, sizes_px, strict=True))
    world = 120 + 100 * sum(parts)
    found = lost(world, blurred(1.0))
    assert found == [FROM <= row < TO for row in range(LENGTH)]
    images = [shown(world, down(50)) for _ in range(2)]
    change = change_of_details(down(50), images[0], blurred(1.0)(images[1]), np.zeros(3))
    assert change[0] > LOSS > change[1]


@pytest.mark.parametrize(
    "change",
    [
        lambda image: image,
        lambda image: 0.4 * image,
        lambda image: 1.5 * image,
        lambda image: 255 * (image / 255) ** 0.5,
        lambda image: 255 * (image / 255) ** 1.5,
        lambda image: image * np.where(np.arange(240)[:, None] < 120, 0.45, 1.0),
        lambda image: cv2.blur(image, (5, 1)),
    ],
    ids=["as it is", "shade", "sun", "gamma 0.5", "gamma 1.5", "edge of a shadow", "motion"],
)
def test_light_gamma_and_motion_are_no_loss(rough, change):
    assert not any(lost(rough, change))


@pytest.mark.parametrize("contrast", [0.02, 0.1, 0.3])
def test_smooth_terrain_ahead_is_no_loss(rough, contrast):
    ahead = np.arange(2000) > 1250  # of the robot by 1 m and more, by columns: snow, ice, concrete
    world = 180 + np.where(ahead, contrast, 1.0) * (rough - 120)
    assert not any(lost(world, fog, begin=LENGTH))


def test_fog_that_comes_while_the_robot_stands_is_noticed(rough):
    poses_m = np.minimum(WAY_M, STEP_M * (FROM - 2))
    assert lost(rough, fog, poses_m) == [FROM <= row < TO for row in range(LENGTH)]


def test_fog_that_comes_over_some_images_close_together_is_noticed(rough):
    camera, watch, found = down(50), DetailsWatch(down(50)), []
    for row in range(8):
        pose = np.array([0.02 * row, 0.0, 0.0])
        thick = min(row / 6, 1.0)
        image = shown(rough, camera, pose).astype(np.float32)
        image = (1 - thick) * image + thick * fog(image)
        found.append(watch.has_lost(image.astype(np.uint8), pose))
    assert found[-1]
    assert not any(found[:3])


def test_fog_that_ends_over_some_images_near_its_begin_is_over(rough):
    camera, watch, found = down(50), DetailsWatch(down(50)), []
    for row, thick in enumerate([0, 0, 0, 1, 0.8, 0.6, 0.4, 0.2, 0, 0]):
        pose = np.array([0.06 * row, 0.0, 0.0])
        image = shown(rough, camera, pose, noise=2, seed=row).astype(np.float32)
        image = (1 - thick) * image + thick * fog(image)
        found.append(watch.has_lost(image.astype(np.uint8), pose))
    assert found[3]
    assert not any(found[:3] + found[-2:])


def test_the_image_before_a_loss_is_not_compared_far_from_it(rough):
    thins = {FROM + 5: 0.55, FROM + 6: 0.8}  # from 0.35: never by two thirds of it at once
    assert STEP_M * 5 > NEAR_M
    camera, watch, found = down(50), DetailsWatch(down(50)), []
    for row, x in enumerate(WAY_M):
        pose, share = np.array([x, 0.0, 0.0]), 1.0
        if row >= FROM:
            share = thins.get(min(row, max(thins)), 0.35)
        image = shown(rough, camera, pose, noise=2, seed=row).astype(np.float32)
        found.append(watch.has_lost((share * image + (1 - share) * 170).astype(np.uint8), pose))
    assert found == [row >= FROM for row in range(LENGTH)]


def test_fog_that_is_back_at_once_is_noticed_where_the_robot_stands(rough):
    poses_m = np.minimum(WAY_M, STEP_M * (LENGTH - 4))
    camera, watch, found = down(50), DetailsWatch(down(50)), []
    for row, x in enumerate(poses_m):
        pose, clear = np.array([x, 0.0, 0.0]), row < FROM or row == LENGTH - 3
        image = shown(rough, camera, pose, noise=2, seed=row).astype(np.float32)
        found.append(watch.has_lost((image if clear else fog(image)).astype(np.uint8), pose))
    assert found == [row >= FROM and row != LENGTH - 3 for row in range(LENGTH)]


def test_the_answer_holds_where_images_have_no_terrain_in_common(rough):
    poses_m = WAY_M + np.where(np.arange(LENGTH) > FROM, 3.0, 0.0)
    assert all(lost(rough, fog, poses_m, end=LENGTH)[FROM:])
    poses_m = WAY_M + np.where(np.arange(LENGTH) >= FROM, 3.0, 0.0)
    assert not any(lost(rough, fog, poses_m, end=LENGTH))  # it cannot be determined


def test_large_images_are_compared_at_the_width_of_small_ones(rough):
    camera, pose = down(50), np.zeros(3)
    image = cv2.resize(shown(rough, camera), (4 * SIZE[0], 4 * SIZE[1]))
    watch = DetailsWatch(camera)
    assert not watch.has_lost(reduced(image), pose)
    assert not watch.has_lost(shown(rough, camera), pose)
    assert watch.has_lost(reduced(np.stack([fog(image)] * 3, axis=-1).astype(np.uint8)), pose)
    assert SIZE[0] == WIDTH_PX


def test_smoother_terrain_ahead_is_no_change_and_fog_on_it_is(rough):
    ahead = np.arange(2000) > 1200
    world, camera = 120 + np.where(ahead, 0.15, 1.0) * (rough - 120), down(65)
    step = np.array([0.5, 0.0, 0.0])
    before, after = shown(world, camera), shown(world, camera, step)
    assert TileDetails.of(after).level - TileDetails.of(before).level < -np.log(2)
    assert change_of_details(camera, before, after, step) == pytest.approx([0, 0], abs=0.3)
    assert change_of_details(camera, before, fog(after), step)[0] < -np.log(2)


def test_coarse_details_beside_as_many_fine_ones_are_no_loss_of_the_focus(rng):
    fine = 120 + 12 * rng.normal(0, 1, (240, 320))
    coarse = 60 * cv2.GaussianBlur(rng.normal(0, 1, (240, 320)), (0, 0), 1.5)
    finest, *coarser = TileDetails.of(fine + coarse).octaves - TileDetails.of(fine).octaves
    assert np.median(finest - coarser[0]) < LOSSES[1]  # as many fine ones as before, relatively few
    assert change_of_details(down(50), fine, fine + coarse, np.zeros(3))[1] > 0.2 * LOSSES[1]


def test_more_light_on_noise_alone_cannot_be_compared(rng):
    dark, bright = (rng.normal(grey, 1, (240, 320)) for grey in (30, 220))
    assert change_of_details(down(50), dark, bright, np.zeros(3)) is None


def test_a_few_tiles_with_details_on_smooth_terrain_are_too_few(rng):
    before, after = (rng.normal(120, 0.3, (240, 320)) for _ in range(2))
    before[:64, :160] += rng.normal(0, 30, (64, 160))  # ten tiles: a shadow, an object
    assert change_of_details(down(50), before, after, np.zeros(3)) is None
    before[:, :256] += rng.normal(0, 30, (240, 256))
    assert change_of_details(down(50), before, after, np.zeros(3)) is not None


def test_what_shows_no_common_terrain_has_no_change(rng):
    image = rng.integers(0, 256, (240, 320)).astype(np.uint8)
    camera = down(50)
    assert change_of_details(camera, image, image[:, ::2], np.zeros(3)) is None
    assert change_of_details(camera, image, image, np.array([50.0, 0.0, 0.0])) is None


def may_lack(camera, *images):
    return may_have_lost(camera, *(TileDetails.of(image) for image in images))


def test_details_may_be_lost_where_an_image_shows_less_in_place(rough):
    camera = down(50)
    before, after = (shown(rough, camera, (x, 0, 0), noise=2) for x in (0.0, 0.3))
    assert not may_lack(camera, before, after)
    assert not may_lack(camera, before, 0.5 * after)
    assert may_lack(camera, before, fog(after))
    assert may_lack(camera, before, blurred(1.0)(after))
    assert may_lack(camera, before, np.where(np.arange(320) < 120, fog(after), after))
    assert may_lack(camera, before, after[:200])  # of another size
    assert may_lack(camera, np.full_like(before, 90), np.full_like(before, 90))  # of no details


def test_details_above_the_horizon_do_not_hide_a_loss(rough):
    camera = down(-15)
    image = shown(rough, camera)
    lower = np.arange(240)[:, None] >= 192
    assert may_lack(camera, image, np.where(lower, fog(image), image))
    assert not may_lack(camera, image, np.where(lower, image, fog(image)))
