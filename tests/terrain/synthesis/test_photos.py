"""Ground and patches never share a photograph."""

import cv2
import numpy as np
import pytest
import skimage.data

from terrain.errors import SynthesisError
from terrain.synthesis.photos import BUILT_IN, built_in_photos, photos_from_folder


def write_photos(folder, counts, shape=(40, 50, 3)):
    rng = np.random.default_rng(7)
    for terrain, count in counts.items():
        (folder / terrain).mkdir(parents=True)
        for i in range(count):
            image = rng.integers(0, 256, shape, dtype=np.uint8)
            cv2.imwrite(str(folder / terrain / f"{i}.png"), image)


def test_halves_of_the_built_in_photographs_are_disjoint():
    """Together, the left part and the areas are the whole photograph, each pixel once."""
    sets = built_in_photos()
    assert sets.terrains == BUILT_IN
    for terrain in BUILT_IN:
        whole = getattr(skimage.data, terrain)()
        (ground,) = sets.ground[terrain]
        areas = [photo.image for photo in sets.patches[terrain]]
        right = np.vstack([np.hstack(areas[i : i + 2]) for i in range(0, len(areas), 2)])
        np.testing.assert_array_equal(np.hstack([ground.image, right]), whole)
        assert len({photo.photo_id for photo in sets.patches[terrain]}) == 8
    assert "left half" in sets.origin


def test_folder_is_parted_by_photo_id(tmp_path):
    """Ten files of five photo_ids: no id is on both sides."""
    write_photos(tmp_path, {"sand": 10, "soil": 4})
    rows = [f"sand/{i}.png,looked-{i // 2}" for i in range(10)]
    (tmp_path / "manifest.csv").write_text("path,photo_id\n" + "\n".join(rows) + "\n")
    for seed in range(5):
        sets = photos_from_folder(tmp_path, np.random.default_rng(seed))
        ground, patches = (
            {int(photo.photo_id[5:-4]) // 2 for photo in part["sand"]}
            for part in (sets.ground, sets.patches)
        )
        assert len(ground) == 2
        assert len(patches) == 3
        assert not ground & patches
        assert sets.ground["soil"][0].image.shape == (40, 50, 3)


def test_one_grey_photograph_makes_all_grey(tmp_path):
    write_photos(tmp_path, {"sand": 2, "soil": 2})
    cv2.imwrite(str(tmp_path / "sand" / "1.png"), np.zeros((40, 50), np.uint8))
    sets = photos_from_folder(tmp_path, np.random.default_rng(0))
    everything = [*sets.ground.values(), *sets.patches.values()]
    assert {photo.image.ndim for own in everything for photo in own} == {2}


def test_one_photograph_is_too_few(tmp_path):
    write_photos(tmp_path, {"sand": 3, "soil": 1})
    with pytest.raises(SynthesisError, match=r"soil: 1 photo; at least 2"):
        photos_from_folder(tmp_path, np.random.default_rng(0))


def test_unreadable_folder_and_photograph(tmp_path):
    with pytest.raises(SynthesisError, match="is not a folder"):
        photos_from_folder(tmp_path / "nowhere", np.random.default_rng(0))
    write_photos(tmp_path, {"sand": 2})
    (tmp_path / "sand" / "1.png").write_bytes(b"not an image")
    with pytest.raises(SynthesisError, match=r"photographs: .*1\.png"):
        photos_from_folder(tmp_path, np.random.default_rng(0))
