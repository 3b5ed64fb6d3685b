from collections import Counter
from dataclasses import replace

import cv2
import numpy as np
import pytest

from odometry.errors import ConfigError
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.neighbours.validation import Samples, cross_validate
from terrain.classification.photographs.augmentation import Augmentation, altered, load_copies
from terrain.classification.photographs.patches import find_photos
from terrain.classification.presets import PlainNeighbours
from terrain.classification.training import train

STILL = Augmentation(1, 1.0, blur_px=0, contrast=1, brightness=0, noise=0, jpeg_quality=100)


@pytest.fixture
def folder(tmp_path, rng):
    for name, sizes in {"mud": (32, 80), "snow": (40, 64)}.items():
        (tmp_path / name).mkdir()
        for size in sizes:
            image = rng.integers(0, 200, (size, size, 3), dtype=np.uint8)
            cv2.imwrite(str(tmp_path / name / f"{size}.png"), image)
    return tmp_path


def test_the_same_photographs_give_the_same_copies_whatever_their_names(folder):
    photos = find_photos(folder)
    first = load_copies(photos, 32, Augmentation())
    again = load_copies(photos[::-1], 32, Augmentation())
    other = load_copies(photos, 32, Augmentation(seed=1))
    by_photo = [
        {str(photo): image for photo, image in zip(of.photos, of.images, strict=True)}
        for of in (first, again, other)
    ]
    for name, image in by_photo[0].items():
        np.testing.assert_array_equal(image, by_photo[1][name])
        assert not np.array_equal(image, by_photo[2][name])


def test_a_photograph_has_as_many_copies_as_patches_at_the_most(folder):
    copies = load_copies(find_photos(folder), 32, Augmentation(per_photo=5))
    assert Counter(path.parent.name + path.stem for path in copies.photos) == {
        "mud32": 1, "mud80": 5, "snow40": 1, "snow64": 5,
    }  # fmt: skip
    assert {image.shape for image in copies.images} == {(32, 32, 3)}
    assert {(p.parent.name, str(p)) for p in copies.photos} == set(
        zip(copies.labels, copies.groups, strict=True)
    )


def test_nothing_to_alter_leaves_the_patch(rng):
    image = np.full((32, 32), 90, np.uint8)
    image[:, 16:] = 160
    off = altered(image, 32, STILL, rng).astype(int) - image
    assert abs(off).max() <= 2  # JPEG


def test_each_setting_does_what_it_says(rng):
    image = rng.integers(60, 190, (256, 256), dtype=np.uint8)

    def drawn(**change):
        settings = replace(STILL, **change)
        return np.array([altered(image, 32, settings, rng) for _ in range(60)], float)

    plain = drawn()
    assert drawn(brightness=40.0).mean(axis=(1, 2)).std() > 3 * plain.mean(axis=(1, 2)).std()
    assert drawn(blur_px=3.0).std(axis=(1, 2)).min() < 0.5 * plain.std(axis=(1, 2)).min()
    assert drawn(contrast=1.7).std(axis=(1, 2)).std() > 3 * plain.std(axis=(1, 2)).std()
    flat = np.full((32, 32), 128, np.uint8)
    noisy = [altered(flat, 32, replace(STILL, noise=30.0), rng).std() for _ in range(60)]
    assert np.mean(noisy) == pytest.approx(10.0, abs=4.0)  # of 30 times the square of a share
    assert max(noisy) < 31


def test_the_side_of_a_crop_is_log_uniform(rng):
    """On a ramp the difference across a patch is the side of the crop."""
    ramp = np.tile(np.arange(256, dtype=np.uint8), (256, 1))
    settings = replace(STILL, largest_crop=8.0)
    drawn = [altered(ramp, 32, settings, rng).astype(float) for _ in range(200)]
    times = np.array([(patch[:, -4:].mean() - patch[:, :4].mean()) / 28 for patch in drawn])
    assert times.min() > 0.9
    assert times.max() < 8.1
    np.testing.assert_allclose(
        np.quantile(np.log(times), [0.25, 0.5, 0.75]),
        np.log(8) * np.array([0.25, 0.5, 0.75]),
        atol=0.25,
    )


def test_copies_are_learned_from_with_their_photograph_and_never_judged(rng):
    folds = []

    class Recorded(PlainNeighbours):
        def fit(self, features, codes, copies=0, shares=None):
            folds.append((features[:, 0].astype(int).tolist(), codes.tolist()))
            assert copies == len(codes) // 3
            return super().fit(features, codes, copies, shares)

    codes, groups = np.repeat([0, 1], 20), np.arange(40) // 2
    samples = Samples(np.column_stack([groups, rng.normal(size=40)]), codes, groups)
    copies = Samples(samples.features[::2], codes[::2], groups[::2])
    found = cross_validate(Recorded, (1,), samples, copies)
    assert found.rows.tolist() == list(range(40))
    for seen, codes_seen in folds:
        left_out = set(groups.tolist()) - set(seen)
        assert left_out  # with all that is made of them
        assert Counter(seen) == dict.fromkeys(set(groups.tolist()) - left_out, 3)
        assert codes_seen == [int(group >= 10) for group in seen]


@pytest.mark.slow
def test_training_is_repeatable_and_can_do_without_copies(tmp_path, rng):
    for name, low in {"dark": 0, "light": 110}.items():
        (tmp_path / name).mkdir()
        for i in range(4):
            image = rng.integers(low, low + 120, (32, 32), dtype=np.uint8)
            cv2.imwrite(str(tmp_path / name / f"{i}.png"), image)
    bytes_by_name = {}
    for name, augment in {"a": True, "b": True, "none": False}.items():
        made = train(tmp_path, patch_size_px=16, augment=augment)
        made.classifier.save(tmp_path / name)
        bytes_by_name[name] = (tmp_path / name).read_bytes()
        assert len(made.patches.images) == 8 * 9
    assert bytes_by_name["a"] == bytes_by_name["b"] != bytes_by_name["none"]


def test_the_published_preset_learns_from_the_photographs_alone(rng):
    images = list(rng.integers(0, 256, (8, 16, 16), dtype=np.uint8))
    copies = load_copies([], 16, Augmentation())
    with pytest.raises(ConfigError, match="chen2023"):
        TerrainClassifier("chen2023").fit(images, ["a", "b"] * 4, copies=copies)
