"""Photographs of one scene are held out together."""

from itertools import pairwise

import cv2
import numpy as np
import pytest

from terrain.classification.adaptation import adapt
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.photographs.patches import LabelledPhoto, find_photos, load_patches
from terrain.classification.photographs.scenes import scene_of_groups, with_scenes
from terrain.classification.training import train

SIDE = 64


@pytest.fixture
def folder(tmp_path, rng):
    """Of sand and mud two scenes each; one of sand is there as it is, turned, and saved again."""
    for name in ("mud/a", "mud/b", "sand/a", "sand/b"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        scene = 128 + 400 * cv2.GaussianBlur(rng.normal(size=(SIDE, 80)), (0, 0), 6)
        cv2.imwrite(f"{tmp_path / name}.png", np.clip(scene, 0, 255).astype(np.uint8))
    image = np.asarray(cv2.imread(f"{tmp_path / 'sand/b'}.png"))
    cv2.imwrite(f"{tmp_path / 'sand/c'}.png", np.rot90(image))
    cv2.imwrite(f"{tmp_path / 'sand/d'}.jpg", image)
    return tmp_path


def named(label, *groups):
    return [LabelledPhoto(f"{group}.jpg", label, group) for group in groups]


def test_scenes_are_chains_of_photographs_that_look_alike():
    photos = named("sand", *"abcdef")
    assert scene_of_groups(photos, [("d", "c"), ("b", "d"), ("f", "e")]) == {
        "c": "b",
        "d": "b",
        "f": "e",
    }


def test_a_terrain_of_one_scene_stays_as_it_is():
    photos = [*named("sand", *"abc"), *named("mud", *"de"), *named("tile", *"fgh")]
    alike = [*pairwise("abc"), ("d", "e"), ("f", "g")]
    assert scene_of_groups(photos, alike) == {"g": "f"}
    assert scene_of_groups([*photos, *named("mud", "i")], alike) == {"e": "d", "g": "f"}


def test_copies_are_held_out_with_their_photograph(folder):
    patches = with_scenes(load_patches(find_photos(folder), SIDE))
    scenes = dict(zip(patches.photos, patches.scenes, strict=True))
    assert len({scenes[folder / f"sand/{name}"] for name in ("b.png", "c.png", "d.jpg")}) == 1
    assert len(set(scenes.values())) == 4
    assert not patches.trained_on.photo_ids  # no manifest names any


def test_one_scene_with_two_labels_is_not_joined(folder):
    copy = folder / "mud/c.jpg"
    copy.write_bytes((folder / "sand/d.jpg").read_bytes())
    patches = with_scenes(load_patches(find_photos(folder), SIDE))
    scenes = dict(zip(patches.photos, patches.scenes, strict=True))
    assert scenes[copy] not in {scenes[folder / "sand/d.jpg"], scenes[folder / "sand/b.png"]}


class FittedError(Exception):
    """In place of the work of `fit`."""


@pytest.fixture
def given(monkeypatch):
    """What `fit` is given: groups, and the rest by name; it ends with `FittedError`."""
    seen = {}

    def fit(_self, _images, _labels, groups, **other):
        seen.update(other, groups=groups)
        raise FittedError

    monkeypatch.setattr(TerrainClassifier, "fit", fit)
    return seen


@pytest.mark.parametrize("augment", [False, True])
def test_train_holds_scenes_out(folder, given, augment):
    with pytest.raises(FittedError):
        train(folder, patch_size_px=SIDE, augment=augment)
    assert len(set(given["groups"])) == 4
    if augment:
        assert set(given["copies"].groups) == set(given["groups"])


def test_adapt_holds_scenes_out(folder, given):
    old = TerrainClassifier()
    old.patch_size_px, old.old_samples_, old.trained_on_ = SIDE, "samples", None
    old.colour_ = False
    with pytest.raises(FittedError):
        adapt(folder, old)
    assert len(set(given["groups"])) == 4
