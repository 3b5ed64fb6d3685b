"""Photographs of 16 bits that hold fewer are refused, wherever they would be learned or named."""

import cv2
import numpy as np
import pytest
from click.testing import CliRunner

from terrain.classification.training import train
from terrain.cli.main import cli
from terrain.errors import ImageError
from terrain.image_depth import bits_held, check_depth


@pytest.mark.parametrize(
    ("largest", "bits"),
    [(0, 8), (255, 8), (256, 10), (1023, 10), (4095, 12), (16383, 14), (16384, None)],
)
def test_bits_that_values_need(largest, bits):
    assert bits_held(largest) == bits


def photos(folder, **largest_of):
    """Three grey images of a terrain, with values up to some number; 8 bits up to 255."""
    rng = np.random.default_rng(3)
    for terrain, largest in largest_of.items():
        kind = np.uint8 if largest == 255 else np.uint16
        (folder / terrain).mkdir(parents=True)
        for number in range(3):
            pixels = rng.integers(0, largest + 1, (128, 128)).astype(kind)
            pixels[0, 0] = largest
            cv2.imwrite(str(folder / terrain / f"{number}.png"), pixels)
    return sorted(folder.glob("*/*"))


@pytest.mark.parametrize(
    ("largest_of", "folder", "factor"),
    [
        ({"grass": 4095, "sand": 4000}, "grass", 16),
        ({"grass": 255, "sand": 4095}, "sand", 16),
        ({"grass": 65535, "sand": 4095}, "sand", 16),
        ({"grass": 16000, "sand": 15000}, "grass", 4),
        ({"grass": 1023, "sand": 900}, "grass", 64),
    ],
)
def test_few_bits_are_refused(tmp_path, largest_of, folder, factor):
    with pytest.raises(ImageError, match=rf"{folder}: 3 images of 16 bits.* by {factor}, or"):
        check_depth(photos(tmp_path, **largest_of), ImageError)


@pytest.mark.parametrize(
    "largest_of", [{"grass": 255}, {"grass": 65535, "sand": 60000}, {"grass": 65535, "sand": 16000}]
)
def test_whole_bits_and_a_dark_terrain_are_not(tmp_path, largest_of):
    check_depth(photos(tmp_path, **largest_of), ImageError)


def test_files_that_are_no_images_are_left_to_their_reader(tmp_path):
    (tmp_path / "a.png").write_bytes(b"no image")
    check_depth([tmp_path / "a.png", tmp_path / "b.jpg"], ImageError)


def test_training_refuses_them(tmp_path):
    photos(tmp_path, grass=4095, sand=4095)
    with pytest.raises(ImageError, match="12-bit data: multiply the values by 16"):
        train(tmp_path, preset="chen2023")


def test_classify_refuses_them(tmp_path, model_file):
    files = photos(tmp_path, grass=4095)
    for given in ([tmp_path], files):
        answer = CliRunner().invoke(cli, ["classify", str(model_file), *map(str, given)])
        assert "12-bit data" in str(answer.exception)
