"""Labelled photographs that were not trained on: counts, accuracy, and what was trained on."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from sklearn.metrics import recall_score

from terrain.classification.answer import Classification
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.held_out import LabelledAnswer, answer_photos, held_out_score
from terrain.classification.photographs.patches import LabelledPhoto, find_photos
from terrain.classification.photographs.thumbnails import thumbnail_text
from terrain.classification.photographs.trained_on import TrainedOn, image_sum
from terrain.images import read_image


def answers(pairs):
    """One answer for each (true terrain, label, photo_id)."""
    return [
        LabelledAnswer(
            LabelledPhoto(Path(f"{i}.png"), true, group),
            Classification(label, 0.9, 1.0, {}),
            in_training=False,
            shares_photo_id=False,
        )
        for i, (true, label, group) in enumerate(pairs)
    ]


def test_counts_and_accuracy_are_those_of_scikit_learn(rng):
    names = ["grass", "sand", "ice"]
    true = rng.choice(["grass", "sand"], 80)
    said = np.where(rng.random(80) < 0.7, true, rng.choice([*names, "unknown"], 80))
    groups = [f"{name} {k // 8}" for k, name in enumerate(true)]
    score = held_out_score(names, answers(zip(true, said, groups, strict=True)))
    assert score.true == ("grass", "sand")
    assert score.labels == ("grass", "sand", "ice", "unknown")
    expected = [[((true == t) & (said == s)).sum() for s in score.labels] for t in score.true]
    assert score.counts.tolist() == expected
    recalls = [(said[true == t] == t).mean() for t in score.true]
    assert score.balanced_accuracy == pytest.approx(np.mean(recalls))
    named = said != "unknown"
    of_named = recall_score(true[named], said[named], labels=["grass", "sand"], average=None)
    assert score.of_named == pytest.approx(np.mean(of_named))
    low, high = score.interval
    assert low < score.balanced_accuracy < high


def test_a_terrain_that_the_model_does_not_know_is_counted_and_not_scored():
    pairs = [("grass", "grass", "a"), ("moss", "grass", "b"), ("moss", "unknown", "c")]
    score = held_out_score(["grass", "sand"], answers(pairs))
    assert score.true == ("grass", "moss")
    assert score.counts.tolist() == [[1, 0, 0], [1, 0, 1]]
    assert score.balanced_accuracy == 1.0
    foreign = held_out_score(["sand"], answers(pairs[2:]))
    assert (foreign.balanced_accuracy, foreign.interval, foreign.of_named) == (None, None, None)


def test_a_terrain_that_is_always_refused_has_no_accuracy_of_named():
    pairs = [("grass", "grass", "a"), ("sand", "unknown", "b")]
    score = held_out_score(["grass", "sand"], answers(pairs))
    assert score.balanced_accuracy == 0.5
    assert score.of_named is None


def test_images_of_the_training_set_are_known_under_any_name(training_patches, tmp_path):
    images, labels, groups = training_patches
    trained_on = TrainedOn(frozenset(map(image_sum, images)), frozenset({"gravel 3"}))
    model = TerrainClassifier().fit(images, labels, groups, trained_on=trained_on)
    model.save(tmp_path / "a.model")
    model = TerrainClassifier.load(tmp_path / "a.model")
    assert model.trained_on_ == trained_on
    folder = tmp_path / "photos/gravel"
    folder.mkdir(parents=True)
    turned = np.rot90(images[-1])
    for name, image in {"copy": images[-1], "turned": turned}.items():
        assert cv2.imwrite(str(folder / f"{name}.png"), image)
    (folder / "broken.png").write_bytes(b"no image")
    (tmp_path / "photos/manifest.csv").write_text(
        "path,photo_id\ngravel/copy.png,gravel 4\ngravel/turned.png,gravel 3\n"
    )
    found, unusable = answer_photos(model, find_photos(tmp_path / "photos"))
    assert [each.photo.path.stem for each in found] == ["copy", "turned"]
    assert [each.in_training for each in found] == [True, False]
    assert [each.shares_photo_id for each in found] == [False, True]
    assert list(unusable) == [folder / "broken.png"]
    (said,) = model.classify([read_image(folder / "copy.png")])
    assert found[0].answer == said


def test_training_photographs_that_were_saved_again_do_not_count_as_held_out(rng):
    photos = [cv2.resize(rng.integers(0, 255, (40, 60), np.uint8), (600, 400)) for _ in range(6)]
    trained_on = TrainedOn(thumbnails=frozenset(map(thumbnail_text, photos[:3])))
    assert TrainedOn.from_table(trained_on.to_table()) == trained_on
    for again in (
        cv2.imdecode(cv2.imencode(".jpg", photos[0], [cv2.IMWRITE_JPEG_QUALITY, 40])[1], 0),
        cv2.resize(photos[1], (420, 280), interpolation=cv2.INTER_AREA),
        np.repeat(cv2.convertScaleAbs(photos[2], alpha=0.8, beta=20)[..., None], 3, axis=2),
        np.ascontiguousarray(np.rot90(photos[0])),
        np.ascontiguousarray(np.fliplr(photos[1])),
    ):
        assert trained_on.holds(again)
    assert not any(map(trained_on.holds, photos[3:]))
    assert not TrainedOn(frozenset({"ab12"})).holds(photos[0])


def test_flat_images_look_like_none():
    flat = np.full((200, 200), 90, np.uint8)
    assert not TrainedOn(thumbnails=frozenset({thumbnail_text(flat)})).holds(flat)


def test_a_model_that_does_not_say_what_it_was_trained_on(training_patches, tmp_path):
    model = TerrainClassifier().fit(*training_patches)
    model.save(tmp_path / "a.model")
    assert TerrainClassifier.load(tmp_path / "a.model").trained_on_ is None


@pytest.mark.parametrize(
    "table",
    [
        {},
        {"image_sums": "abc", "photo_ids": []},
        {"image_sums": [1], "photo_ids": []},
        {"image_sums": [], "photo_ids": [], "thumbnails": ["ab"]},
        {"image_sums": [], "photo_ids": [], "thumbnails": ["x" * 1152]},
    ],
)
def test_damaged_lists_are_refused(table):
    with pytest.raises((KeyError, TypeError, ValueError)):
        TrainedOn.from_table(table)
