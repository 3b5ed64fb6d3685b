"""Images that show no terrain are unknown, and it is said why."""

import json
from copy import copy

import cv2
import numpy as np
import pytest
from click.testing import CliRunner

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.model_file import read_model, write_model
from terrain.classification.no_ground import (
    DARK,
    NOISE,
    OVEREXPOSED,
    SKY,
    SMOOTH,
    Showing,
    ShownGround,
    no_ground_note,
)
from terrain.classification.own_statistics import OwnStatisticsClassifier
from terrain.cli.verbs.classify import classify
from terrain.errors import ModelFileError
from terrain.image_labels.image_label import answered

SIZE = 64


def ground(rng, grain_px, spread, tint):
    """Texture whose strength varies from place to place, with a tint of R, G, B."""
    grey = cv2.GaussianBlur(rng.normal(0, 1, (SIZE, SIZE)), (0, 0), grain_px)
    strength = cv2.GaussianBlur(rng.normal(0, 1, (SIZE, SIZE)), (0, 0), 12)
    strength = 1 + 0.4 * strength / strength.std()
    grey = 120 + spread * strength * grey / grey.std() + rng.normal(0, 1, (SIZE, SIZE))
    return np.clip(grey[..., None] * tint, 0, 255).astype(np.uint8)


def photographs(seed, photos=15, each=3):
    rng = np.random.default_rng(seed)
    kinds = (("earth", 1.0, 20, (1.1, 1.0, 0.85)), ("slabs", 3.0, 6, (1.0, 1.0, 0.98)))
    images, labels, groups = [], [], []
    for name, grain_px, spread, tint in kinds:
        for photo in range(photos):
            some = spread * rng.uniform(0.5, 1.5)
            images += [ground(rng, grain_px, some, np.array(tint)) for _ in range(each)]
            labels += [name] * each
            groups += [f"{name} {photo}"] * each
    return images, np.array(labels), np.array(groups)


@pytest.fixture(scope="module")
def model():
    return TerrainClassifier().fit(*photographs(1))


def sky(rng):
    depth = np.linspace(0, 1, SIZE)[:, None, None]
    image = np.array([110, 150, 205]) * (1 - depth) + np.array([170, 190, 215]) * depth
    noise = cv2.GaussianBlur(rng.normal(0, 4, (SIZE, SIZE)), (0, 0), 1.5)
    return np.clip(image + noise[..., None], 0, 255).astype(np.uint8)


def of_grey(rng, level, noise):
    grey = rng.normal(level, noise, (SIZE, SIZE, 1)).repeat(3, axis=2)
    return np.clip(grey, 0, 255).astype(np.uint8)


EMPTY = {
    OVEREXPOSED: lambda rng: of_grey(rng, 255, 4),
    DARK: lambda rng: of_grey(rng, 1, 2),
    NOISE: lambda rng: of_grey(rng, 120, 30),
    SMOOTH: lambda rng: cv2.GaussianBlur(ground(rng, 1.0, 20, np.ones(3)), (0, 0), 9),
}


@pytest.mark.parametrize("why", EMPTY)
def test_what_shows_no_ground_is_unknown_at_any_distance(model, why, rng):
    near = copy(model)
    near.rejection_distance_ = np.inf
    answers = near.classify([EMPTY[why](rng) for _ in range(5)])
    assert {(answer.label, answer.reason) for answer in answers} == {("unknown", why)}
    assert near.is_unknown([EMPTY[why](rng)]).all()


def test_known_terrain_that_was_held_out_keeps_its_name(model):
    images, labels, _ = photographs(2)
    answers = model.classify(images)
    assert np.mean([bool(answer.reason) for answer in answers]) < 0.02
    named = np.array([answer.label for answer in answers])
    assert np.mean(named == labels) > 0.9
    assert not np.any((named != labels) & (named != "unknown"))


def shown(images, codes):
    return ShownGround.of(images, np.array(codes))


def test_a_smooth_blue_patch_is_sky_and_a_rough_or_grey_one_is_not(rng):
    images, labels, _ = photographs(1)
    ground = shown(images, np.unique(labels, return_inverse=True)[1])
    slabs = 1
    smooth = sky(rng)
    assert ground.lacks([smooth], slabs) == SKY
    grey = np.repeat(smooth.mean(axis=2, keepdims=True), 3, axis=2).astype(np.uint8)
    assert ground.lacks([grey], slabs) != SKY
    assert ground.lacks([smooth[..., 0]], slabs) != SKY
    shade = np.clip(images[-1] * [0.9, 1.0, 1.15], 0, 255).astype(np.uint8)
    assert Showing.of(shade).blueness > 0.05
    assert ground.lacks([shade], slabs) == ""


def test_terrain_without_colour_cannot_be_less_blue_than_a_sky(rng):
    images, labels, _ = photographs(1)
    grey = [image[..., 1] for image in images]
    ground = shown(grey, np.unique(labels, return_inverse=True)[1])
    assert ground.most_blue.tolist() == [1.0, 1.0]
    assert SKY not in {ground.lacks([sky(rng)], code) for code in (0, 1)}


def test_terrain_that_is_white_black_or_noise_in_training_stays_known(rng):
    snow = [of_grey(rng, 254, 3) for _ in range(10)]
    peat = [of_grey(rng, 2, 2) for _ in range(10)]
    grains = [of_grey(rng, 120, 30) for _ in range(10)]
    ground = shown([*snow, *peat, *grains], np.repeat([0, 1, 2], 10))
    for code, images in enumerate((snow, peat, grains)):
        assert ground.lacks([images[0]], code) == ""
    for other in (1, 2):
        assert ground.lacks([snow[0]], other) == OVEREXPOSED
    for other in (0, 2):
        assert ground.lacks([peat[0]], other) == DARK


def test_half_of_the_patches_may_show_none(model, rng):
    images, labels, _ = photographs(2)
    ground, code = model.shown_ground_, 1
    known, dark = images[-1], EMPTY[DARK](rng)
    assert labels[-1] == "slabs"
    assert ground.lacks([known, dark], code) == ""
    assert ground.lacks([known, dark, dark], code) == DARK


def test_octaves_of_noise_fall_and_those_of_a_coarser_texture_rise(rng):
    noise, coarse = of_grey(rng, 120, 20), ground(rng, 6.0, 20, np.ones(3))
    assert np.all(np.diff(Showing.of(noise).texture) < 0)
    assert np.all(np.diff(Showing.of(coarse).texture) > 0)
    twice = np.clip(120 + 2.0 * (noise.astype(float) - 120), 0, 255).astype(np.uint8)
    apart = Showing.of(twice).texture - Showing.of(noise).texture
    np.testing.assert_allclose(apart, np.log(4), atol=0.05)
    assert Showing.of(noise).is_noise
    assert not Showing.of(coarse).is_noise


def test_a_model_file_keeps_it_and_older_ones_do_not_check(model, rng, tmp_path):
    model.save(tmp_path / "a.model")
    dark = [EMPTY[DARK](rng)]
    assert TerrainClassifier.load(tmp_path / "a.model").classify(dark) == model.classify(dark)
    settings, arrays = read_model(tmp_path / "a.model")
    old = {name: of for name, of in arrays.items() if not name.startswith("shown_")}
    write_model(tmp_path / "old.model", settings, old)
    (answer,) = TerrainClassifier.load(tmp_path / "old.model").classify(dark)
    assert answer.reason == ""
    write_model(tmp_path / "bad.model", settings, arrays | {"shown_smooth": np.array([0.0])})
    with pytest.raises(ModelFileError, match="shapes"):
        TerrainClassifier.load(tmp_path / "bad.model")


def test_own_statistics_and_chen2023(model, rng):
    images, labels, groups = photographs(1, photos=5)
    dark = EMPTY[DARK](rng)
    assert OwnStatisticsClassifier(model).classify([dark])[0].reason == DARK
    paper = TerrainClassifier("chen2023").fit(images, labels, groups)
    assert paper.classify([dark])[0].reason == ""


def test_the_note_counts_and_is_silent_of_others():
    assert no_ground_note(["", "astride: mud on the left, snow on the right"]) is None
    note = no_ground_note([SKY, "", SKY, DARK])
    assert note.startswith("3 of 4 images show no terrain")
    assert "smooth and blue as a sky (2), black (1)" in note


def test_classify_says_so_of_each_image_and_of_all(model, rng, tmp_path):
    model.save(tmp_path / "a.model")
    files = [str(tmp_path / f"{i}.png") for i in range(2)]
    for file, image in zip(files, (EMPTY[DARK](rng), photographs(2)[0][-1]), strict=True):
        assert cv2.imwrite(file, image[..., ::-1])
    answer = CliRunner().invoke(classify, [str(tmp_path / "a.model"), *files])
    assert answer.exit_code == 0
    assert "Note: 1 of 2 images show no terrain and are unknown: black (1)" in answer.stderr
    rows = answer.stdout.splitlines()
    assert rows[1].split()[1:3] == ["unknown", "-"]
    assert "no terrain: black" in rows[1]
    assert rows[2].split()[1] == "slabs"
    assert 0.5 < float(rows[2].split()[2]) <= 1
    answer = CliRunner().invoke(classify, [str(tmp_path / "a.model"), *files, "--json"])
    assert [row["reason"] for row in json.loads(answer.stdout)] == ["no terrain: black", ""]


def test_the_label_of_a_region_says_why(model, rng):
    dark, known = model.classify([EMPTY[DARK](rng), photographs(2)[0][-1]])
    label = answered(0.0, "a.png", None, [dark])
    assert (label.label, label.reason) == ("unknown", DARK)
    assert answered(0.0, "a.png", None, [dark, dark]).reason == DARK
    astride = answered(0.0, "a.png", None, [dark, known])
    assert astride.reason == "astride: unknown on the left, slabs on the right"
