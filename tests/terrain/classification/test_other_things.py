"""Images of things are unknown, and terrain keeps its name."""

from copy import copy

import numpy as np
import pytest
import skimage.data

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.model_file import read_model, write_model
from terrain.classification.other_things import (
    NO_LIMIT,
    PHOTOGRAPHS,
    SQUARES,
    THINGS,
    OtherThings,
    squares_of,
)
from terrain.classification.own_statistics import OwnStatisticsClassifier
from terrain.errors import ModelFileError
from tests.terrain.classification.test_no_ground import photographs

FEATURES, EACH = 6, 400
AWAY = np.eye(FEATURES)[0]


def places(rng, middle, count=EACH):
    return rng.normal(0, 1, (count, FEATURES)) + middle


@pytest.fixture(scope="module")
def learned():
    rng = np.random.default_rng(4)
    sideways = 3 * np.eye(FEATURES)[1]
    terrain = np.concatenate([places(rng, -sideways), places(rng, sideways)])
    codes, groups = np.repeat([0, 1], EACH), np.arange(2 * EACH) // 8
    return OtherThings.of(terrain, codes, groups, places(rng, 6 * AWAY, 100))


@pytest.mark.parametrize("size_px", [32, 128, 700])
def test_squares_are_of_every_photograph_and_always_the_same(size_px):
    squares = squares_of(PHOTOGRAPHS, size_px)
    assert {square.shape for square in squares} == {(size_px, size_px, 3)}
    assert len(squares) == SQUARES * len(PHOTOGRAPHS)
    again = squares_of.__wrapped__(PHOTOGRAPHS, size_px)
    assert all(np.array_equal(a, b) for a, b in zip(squares, again, strict=True))


def test_the_direction_is_that_from_terrain_to_things(learned):
    # covariances are the identity within terrains, but for their distance along the second axis
    cosine = learned.direction @ AWAY / np.linalg.norm(learned.direction)
    assert cosine > 0.99


def test_one_in_a_hundred_of_new_terrain_lies_beyond_and_things_do(learned, rng):
    new = places(rng, -3 * np.eye(FEATURES)[1], 20_000)
    assert np.mean([learned.include(row[None], 0) for row in new]) == pytest.approx(0.01, abs=0.007)
    assert all(learned.include(row[None], 0) for row in places(rng, 8 * AWAY, 100))


def test_the_mean_of_several_patches_has_nearer_limits(learned):
    assert np.all(np.diff(learned.limits, axis=1) <= 0)
    assert learned.limits[0, 2] < learned.limits[0, 0]
    doubtful = 2.0 * AWAY  # one patch may be of terrain, eight of one image are not
    assert not learned.include(doubtful[None], 0)
    assert learned.include(np.tile(doubtful, (8, 1)), 0)
    one_of_eight = np.vstack([8 * AWAY, np.tile(-AWAY, (7, 1))])
    assert learned.include(one_of_eight[:1], 0)
    assert not learned.include(one_of_eight, 0)


@pytest.mark.slow
def test_terrain_that_resembles_things_loses_one_image_in_twenty_at_the_most(rng):
    rare = places(rng, 4 * AWAY, 100)
    terrain = np.concatenate([places(rng, 0 * AWAY, 20_000), rare])
    codes, groups = np.repeat([0, 1], [20_000, 100]), np.arange(20_100) // 4
    found = OtherThings.of(terrain, codes, groups, places(rng, 8 * AWAY, 100))
    new = places(rng, 4 * AWAY, 5000)
    refused = {code: np.mean([found.include(row[None], code) for row in new]) for code in (0, 1)}
    assert refused[0] > 0.5  # where it is taken for the other terrain
    assert refused[1] < 0.1


def test_too_few_images_limit_nothing(rng):
    terrain = np.concatenate([places(rng, 0 * AWAY, 18), places(rng, AWAY, 18)])
    codes, groups = np.repeat([0, 1], 18), np.arange(36) // 2
    found = OtherThings.of(terrain, codes, groups, places(rng, 6 * AWAY, 100))
    assert np.all(found.limits >= NO_LIMIT)
    assert not found.include(1e6 * AWAY[None], 0)


@pytest.mark.slow
def test_a_thing_is_unknown_at_any_distance_and_it_is_said_why(model):
    near = copy(model)
    near.rejection_distance_ = np.inf
    near.shown_ground_ = None
    (answer,) = near.classify([skimage.data.astronaut()])
    assert (answer.label, answer.reason) == ("unknown", THINGS)
    images, labels, _ = photographs(2)
    assert [of.label for of in near.classify(images)].count("unknown") <= 0.03 * len(labels)


def test_a_model_file_keeps_it_and_older_ones_do_not_check(model, tmp_path):
    thing = [skimage.data.astronaut()]
    model.save(tmp_path / "a.model")
    assert TerrainClassifier.load(tmp_path / "a.model").classify(thing) == model.classify(thing)
    settings, arrays = read_model(tmp_path / "a.model")
    old = {name: of for name, of in arrays.items() if not name.startswith("things_")}
    write_model(tmp_path / "old.model", settings, old)
    assert TerrainClassifier.load(tmp_path / "old.model").other_things_ is None
    for name in ("things_direction", "things_limits"):
        write_model(tmp_path / "bad.model", settings, arrays | {name: arrays[name][:-1]})
        with pytest.raises(ModelFileError, match=r"shapes|direction"):
            TerrainClassifier.load(tmp_path / "bad.model")


def test_own_statistics_and_chen2023(model):
    images, labels, groups = photographs(1, photos=5)
    own = OwnStatisticsClassifier(model)
    own.classify(images)
    assert own.classify([skimage.data.astronaut()])[0].reason == THINGS
    paper = TerrainClassifier("chen2023").fit(images, labels, groups)
    assert paper.other_things_ is None
