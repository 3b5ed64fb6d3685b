"""Photographs of one terrain that are of another origin than all others."""

import numpy as np
import pytest
from PIL import ExifTags, Image

from terrain.classification.photographs.photo_origins import FEWEST, set_apart

PHOTOS = 8


@pytest.fixture
def photograph(tmp_path, rng):
    """Write one photograph and return its path."""
    pixels = rng.integers(0, 255, (40, 60, 3), dtype=np.uint8)

    def write(name, *, size=(60, 40), quality=90, camera="", suffix=".jpg", lens=None):
        exif = Image.Exif()
        if lens:
            exif[ExifTags.IFD.Exif] = lens
        if camera:
            exif[ExifTags.Base.Model] = camera
        path = tmp_path / f"{name}{suffix}"
        image = Image.fromarray(pixels).resize(size)
        image.save(path, **({"quality": quality, "exif": exif} if suffix == ".jpg" else {}))
        return path

    return write


def labelled(photograph, of_each, photos=PHOTOS):
    return {
        photograph(f"{terrain}{photo}", **of): terrain
        for terrain, of in of_each.items()
        for photo in range(photos)
    }


@pytest.mark.parametrize(
    ("of", "how"),
    [
        ({"camera": "phone"}, "camera: 8 of 8"),
        ({"quality": 60}, "JPEG compression: 8 of 8"),
        ({"size": (64, 40)}, "number of pixels: 8 of 8"),
        ({"camera": "phone", "quality": 60}, "camera: 8 of 8"),
        ({"lens": {ExifTags.Base.FocalLength: 9.0}}, "focal length: 8 of 8"),
        ({"lens": {ExifTags.Base.DigitalZoomRatio: 2.0}}, "focal length: 8 of 8"),
        ({"suffix": ".png"}, "file format: 8 of 8"),
    ],
)
def test_an_origin_of_its_own(photograph, of, how):
    found = set_apart(labelled(photograph, {"grass": {}, "gravel": of, "sand": {}}))
    assert found == {"gravel": how}


def test_two_terrains_by_two_cameras(photograph):
    of_each = {"grass": {"camera": "phone"}, "gravel": {"camera": "robot"}}
    assert set(set_apart(labelled(photograph, of_each))) == {"grass", "gravel"}


@pytest.mark.parametrize("of", [{}, {"size": (40, 60)}])
def test_one_camera_upright_or_not(photograph, of):
    assert set_apart(labelled(photograph, {"grass": {}, "gravel": of})) == {}


def test_one_photograph_of_each_origin_in_the_other_terrain_is_enough(photograph):
    photos = labelled(photograph, {"grass": {}, "gravel": {"quality": 60}})
    photos[photograph("one", quality=60)] = "grass"
    assert set_apart(photos) == {"grass": "JPEG compression: 8 of 9"}
    photos[photograph("other")] = "gravel"
    assert set_apart(photos) == {}


def test_crops_of_any_size_say_nothing(photograph):
    terrains = ("grass", "gravel")
    crops = {
        photograph(f"{of}{i}", size=(50 + i, 40)): of for of in terrains for i in range(PHOTOS)
    }
    for i in range(PHOTOS):
        crops[photograph(f"gravel{i}", size=(80 + i, 40))] = "gravel"
    assert set_apart(crops) == {}


def test_three_of_four_photographs_are_not_most(photograph):
    photos = labelled(photograph, {"grass": {}, "sand": {}, "gravel": {"quality": 60}}, photos=6)
    photos |= {photograph(f"other{i}"): "gravel" for i in range(2)}
    assert set_apart(photos) == {}


def test_few_photographs_say_nothing(photograph):
    of_each = {"grass": {}, "gravel": {"quality": 60}}
    assert set_apart(labelled(photograph, of_each, photos=FEWEST - 1)) == {}


def test_one_terrain_alone_and_files_that_cannot_be_read(photograph, tmp_path):
    photos = labelled(photograph, {"grass": {}})
    assert set_apart(photos) == {}
    broken = tmp_path / "broken.jpg"
    broken.write_bytes(b"no image")
    assert set_apart(photos | {broken: "grass"}) == {}


def test_files_without_compression_are_not_set_apart_by_it(photograph):
    photos = labelled(photograph, {"grass": {}, "gravel": {"suffix": ".png"}})
    assert set_apart(photos) == dict.fromkeys(("grass", "gravel"), "file format: 8 of 8")
    photos[photograph("one", suffix=".png")] = "grass"
    assert set_apart(photos) == {"grass": "file format: 8 of 9"}
    photos[photograph("other")] = "gravel"
    assert set_apart(photos) == {}


def test_damaged_tags_are_left_out_without_a_warning(photograph):
    photos = labelled(photograph, {"grass": {"camera": "a phone"}, "gravel": {}})
    for path in photos:
        content = path.read_bytes()
        path.write_bytes(content.replace(b"MM\x00*\x00\x00\x00\x08", b"MM\x00*\x00\x00\xff\x08"))
    assert set_apart(photos) == {}
