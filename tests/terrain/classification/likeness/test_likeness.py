"""Whether images look like the training photographs, whatever terrain they show."""

from copy import copy
from dataclasses import replace

import cv2
import numpy as np
import pytest
from click.testing import CliRunner

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.likeness.likeness import FEWEST_IMAGES, Likeness
from terrain.classification.likeness.look import look_of
from terrain.classification.likeness.training_look import TrainingLook
from terrain.classification.model_file import read_model, write_model
from terrain.cli.verbs.classify import classify
from terrain.errors import ModelFileError
from terrain.image_labels.image_labeller import WORTH_OF_UNLIKE, RunLikeness


def texture(rng, grain_px, size=64, spread=35):
    grey = cv2.GaussianBlur(rng.normal(0, 1, (size, size)), (0, 0), grain_px)
    return np.clip(120 + spread * grey / grey.std(), 0, 255).astype(np.uint8)


def photographs(seed, photos=20, each=3):
    """Two textures; the photographs of each differ in grain, light and contrast."""
    rng = np.random.default_rng(seed)
    images, codes, groups = [], [], []
    for code, grain_px in enumerate((0.8, 2.0)):
        for photo in range(photos):
            grain, spread = grain_px * rng.uniform(0.9, 1.1), rng.uniform(25, 40)
            bright = int(rng.integers(-20, 20))
            for _ in range(each):
                image = texture(rng, grain, spread=spread).astype(int) + bright
                images.append(np.clip(image, 0, 255).astype(np.uint8))
                codes.append(code)
                groups.append(f"{code} {photo}")
    return images, np.array(codes), np.array(groups)


@pytest.fixture(scope="module")
def training():
    return TrainingLook.of(*photographs(1))


def compared(training, images):
    return training.compared(np.array([look_of(image) for image in images]))


ALTERED = {
    "more blurred": lambda image: cv2.GaussianBlur(image, (0, 0), 2.5),
    "sharper or noisier": lambda image: np.clip(
        image + np.random.default_rng(0).normal(0, 15, image.shape), 0, 255
    ).astype(np.uint8),
    "darker": lambda image: image // 2,
    "brighter": lambda image: 255 - (255 - image) // 2,
    "finer": lambda image: cv2.resize(
        np.tile(image, (4, 4)), image.shape, interpolation=cv2.INTER_AREA
    ),
    "more compressed": lambda image: compressed(image, 8),
}


def compressed(image, quality):
    coded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
    return cv2.imdecode(coded, cv2.IMREAD_GRAYSCALE)


def test_unseen_photographs_of_the_same_camera_are_like_the_training(training):
    images, codes, _ = photographs(2)
    for some in (images, [i for i, c in zip(images, codes, strict=True) if c == 1]):
        likeness = compared(training, some)
        assert likeness.is_unlike is False
        assert likeness.note is None
        assert 0.3 < likeness.rank < 0.7


@pytest.mark.parametrize("how", ALTERED)
def test_altered_photographs_are_not_and_it_says_how(training, how):
    likeness = compared(training, [ALTERED[how](image) for image in photographs(2)[0]])
    assert likeness.is_unlike
    assert likeness.rank > 0.8
    assert how in likeness.how
    assert how in likeness.note


@pytest.mark.parametrize("count", [1, FEWEST_IMAGES - 1, FEWEST_IMAGES])
def test_few_images_are_compared_with_one_photograph(training, count):
    images = photographs(2)[0]
    blurred = [ALTERED["more blurred"](image) for image in images]
    assert compared(training, blurred[:count]).is_unlike is True
    starts = range(0, len(images), 3)
    alarms = [compared(training, images[i : i + min(count, 3)]).is_unlike for i in starts]
    assert np.mean(alarms) < 0.2  # limits of 20 photographs a terrain are narrow


def test_no_images_and_few_of_older_files_cannot_decide(training):
    assert compared(training, []).is_unlike is None
    older = replace(training, limits=replace(training.limits, photograph_limits=None))
    blurred = [ALTERED["more blurred"](image) for image in photographs(2)[0]]
    assert compared(older, blurred[: FEWEST_IMAGES - 1]).is_unlike is None
    assert compared(older, blurred[:FEWEST_IMAGES]).is_unlike is True


def test_one_image_is_judged_by_all_of_its_patches(classifier, training_patches):
    image = np.tile(training_patches[0][0], (2, 3))
    likeness = classifier.likeness([image // 3])
    assert (likeness.images, likeness.is_unlike) == (1, True)
    assert likeness.note.startswith("the image is unlike the training photographs")
    assert "The label may be wrong" in likeness.note
    corner = image.copy()
    size = classifier.patch_size_px
    corner[:size, :size] = 0
    assert classifier.likeness([corner]).rank > classifier.likeness([image]).rank


@pytest.mark.slow
def test_held_out_distances_have_an_even_rank_among_themselves():
    """Each patch against those of other photographs: what ranks of images are compared with."""
    images, codes, groups = photographs(1)
    looks = np.array([look_of(image) for image in images])
    ranks = []
    for group in np.unique(groups):
        rest = groups != group
        without = TrainingLook.of(
            [images[i] for i in np.flatnonzero(rest)], codes[rest], groups[rest]
        )
        ranks.append(without.compared(looks[~rest]).rank)
    assert np.mean(ranks) == pytest.approx(0.5, abs=0.06)


def test_a_look_follows_light_contrast_and_grain(rng):
    image = texture(rng, 1.5, size=128, spread=20)
    look = look_of(image)
    assert look[0] == pytest.approx(image.mean() / 255)
    assert look[1] == pytest.approx(np.log(image.std() + 1))
    np.testing.assert_allclose(look_of(image + np.uint8(40))[1:], look[1:], atol=1e-5)
    np.testing.assert_allclose(look_of(np.stack([image] * 3, axis=-1)), look, atol=1e-6)
    twice = look_of(cv2.resize(image, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC))
    np.testing.assert_allclose(twice[4:6], look[3:5], atol=0.1)  # an octave up
    assert np.isfinite(look_of(np.zeros((3, 2), np.uint8))).all()


def test_a_large_training_set_keeps_a_spread_of_its_patches():
    looks = np.random.default_rng(0).integers(0, 255, (240, 8, 8), dtype=np.uint8)
    groups = np.repeat(np.arange(4), 60)
    kept = TrainingLook.of(list(looks), groups % 2, groups)
    assert len(kept.looks) == 48
    assert np.bincount(kept.codes).tolist() == [24, 24]


def test_a_model_file_keeps_the_look_and_older_ones_say_nothing(classifier, tmp_path):
    classifier.save(tmp_path / "a.model")
    loaded = TerrainClassifier.load(tmp_path / "a.model")
    images = photographs(2, photos=3)[0]
    assert loaded.likeness(images) == classifier.likeness(images)
    settings, arrays = read_model(tmp_path / "a.model")
    old = {name: array for name, array in arrays.items() if not name.startswith("look_")}
    write_model(tmp_path / "old.model", settings, old)
    assert TerrainClassifier.load(tmp_path / "old.model").likeness(images) is None
    write_model(tmp_path / "bad.model", settings, arrays | {"look_codes": np.array([0])})
    with pytest.raises(ModelFileError, match="looks"):
        TerrainClassifier.load(tmp_path / "bad.model")


def test_a_classifier_of_features_says_nothing():
    features = np.random.default_rng(0).normal(size=(40, 5)) + np.repeat([0, 3], 20)[:, None]
    model = TerrainClassifier().fit(features, np.repeat(["mud", "snow"], 20))
    assert model.likeness([np.zeros((64, 64), np.uint8)]) is None


def test_labels_of_unlike_images_count_less(classifier, training_patches):
    """By a model without a learned confidence; that of others has fallen already."""
    given = {"boards": 0.9, "gravel": 0.1}
    (before := copy(classifier)).confidence_ = None
    like, unlike, learned = (RunLikeness(of) for of in (before, before, classifier))
    for image in training_patches[0][::7]:
        like.add([image])
        unlike.add([image // 3])
        learned.add([image // 3])
    assert learned.likeness.is_unlike
    assert learned.weighed("boards", given) == given
    assert like.likeness.is_unlike is False
    assert like.weighed("boards", given) == given
    assert unlike.likeness.is_unlike
    less = unlike.weighed("boards", given)
    assert sum(less.values()) == pytest.approx(1)
    assert less["boards"] == pytest.approx(WORTH_OF_UNLIKE * 0.9 + (1 - WORTH_OF_UNLIKE) / 2)
    assert unlike.weighed("unknown", {}) == {}
    assert unlike.weighed("boards", {})["boards"] == pytest.approx(0.65)


def test_the_last_images_show_a_light_that_changed(classifier, training_patches):
    run = RunLikeness(classifier)
    for image in [*training_patches[0][::7], *[dark // 3 for dark in training_patches[0][:10]]]:
        run.add([image])
    assert run.latest.images == 10
    assert run.latest.light == pytest.approx(1 / 3, rel=0.2)
    assert run.latest.is_unlike
    assert run.likeness.light == pytest.approx((1 / 3) ** (10 / run.likeness.images), rel=0.1)


@pytest.mark.parametrize("power", [0.4, 2.5])
def test_another_exposure_is_noticed_among_textures_alike(training, power):
    """Also where ranks among all alone would not show it."""
    table = np.rint(255 * (np.arange(256) / 255) ** power).astype(np.uint8)
    images = photographs(2)[0]
    assert abs(compared(training, images).exposure - 0.5) < 0.2
    exposure = compared(training, [table[image] for image in images]).exposure
    assert exposure == pytest.approx(float(power < 1), abs=0.05)
    only = Likeness(20, 0.6, 0.6, ("brighter",), exposure)
    assert only.is_unlike
    assert f"{100 * exposure:.0f} % of those of similar texture are darker" in only.note


@pytest.mark.parametrize("light", [0.25, 0.5, 1.3])
def test_the_light_is_measured_among_textures_alike(training, light):
    """Noise of rounding, and terrain that is darker than that of training, leave a fifth."""
    images = photographs(2)[0]
    assert compared(training, images).light == pytest.approx(1.0, rel=0.1)
    relit = [np.clip(np.rint(light * image), 0, 255).astype(np.uint8) for image in images]
    assert compared(training, relit).light == pytest.approx(light, rel=0.2)


def test_compression_sets_most_of_the_finest_octave_to_nothing():
    images = photographs(2)[0]
    usual = [np.mean([look_of(compressed(i, q))[-1] for i in images]) for q in (95, 30, 10)]
    assert usual[0] > usual[1] > usual[2]


def test_looks_of_older_files_have_no_compression(training):
    arrays = training.arrays() | {"look_points": training.looks[:, :6]}
    old = TrainingLook.from_arrays(arrays, 2)
    images = photographs(2)[0]
    assert compared(old, images).is_unlike is False
    assert compared(old, [ALTERED["more blurred"](image) for image in images]).is_unlike


def test_classify_prints_the_note_on_a_single_image(classifier, training_patches, tmp_path):
    classifier.save(tmp_path / "a.model")
    image = np.tile(training_patches[0][0], (2, 3))
    for name, shown in (("own", image), ("dark", image // 3)):
        cv2.imwrite(str(tmp_path / f"{name}.png"), shown)
        files = [str(tmp_path / "a.model"), str(tmp_path / f"{name}.png")]
        answer = CliRunner().invoke(classify, files)
        assert answer.exit_code == 0
        assert ("Note: the image is unlike" in answer.stderr) is (name == "dark")
