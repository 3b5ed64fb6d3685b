"""Photographs that are transparent in part: what lies there is no terrain."""

import numpy as np
import pytest
from PIL import Image

from terrain.classification.photographs.augmentation import Augmentation, load_copies
from terrain.classification.photographs.opaque import opaque
from terrain.classification.photographs.patches import find_photos, load_patches
from terrain.errors import PatchError

SIDE = 16


@pytest.fixture
def cut_out(tmp_path, rng):
    """Write a photograph (40, 64) of which the left `columns` are transparent, and black."""

    def write(columns, name="grass/a.png", alpha=0):
        pixels = rng.integers(1, 255, (40, 64, 4), dtype=np.uint8)
        pixels[..., 3] = 255
        pixels[:, :columns] = (0, 0, 0, alpha)
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        Image.fromarray(pixels).save(path)
        return path

    return write


def test_patches_with_transparent_pixels_are_left_out(tmp_path, cut_out):
    cut_out(33)
    loaded = load_patches(find_photos(tmp_path), SIDE)
    assert len(loaded.images) == 4 * 2  # of starts 0, 8, ..., 48 those from 40 on
    assert np.min(loaded.images) > 0


@pytest.mark.parametrize("alpha", [128, 255])
def test_what_is_hardly_transparent_is_shown(tmp_path, cut_out, alpha):
    assert opaque(cut_out(33, alpha=alpha)) is None
    assert len(load_patches(find_photos(tmp_path), SIDE).images) == 4 * 7


def test_where_nothing_shows_there_is_nothing_to_learn(tmp_path, cut_out):
    path = cut_out(64)
    with pytest.raises(PatchError, match=r"'grass': none of its 1 photographs .* and opaque there"):
        load_patches(find_photos(tmp_path), SIDE)
    cut_out(0, "grass/b.png")
    assert load_patches(find_photos(tmp_path), SIDE).too_small == [path]


def test_a_palette_may_have_a_transparent_colour(tmp_path):
    pixels = np.zeros((20, 20), np.uint8)
    pixels[5:] = 1
    image = Image.fromarray(pixels, "P")
    image.putpalette([0, 0, 0, 90, 120, 60])
    image.save(tmp_path / "a.png", transparency=0)
    np.testing.assert_array_equal(opaque(tmp_path / "a.png"), pixels == 1)


def test_other_files_are_opaque(tmp_path):
    (tmp_path / "broken.png").write_bytes(b"no image")
    assert opaque(tmp_path / "broken.png") is None
    Image.fromarray(np.zeros((20, 20), np.uint8)).save(tmp_path / "grey.jpg")
    assert opaque(tmp_path / "grey.jpg") is None


def test_copies_are_made_of_whole_photographs_alone(tmp_path, cut_out):
    cut_out(33)
    whole = cut_out(0, "grass/b.png")
    copies = load_copies(find_photos(tmp_path), SIDE, Augmentation(per_photo=3))
    assert copies.photos == [whole] * 3
