import json
from dataclasses import fields, replace

import numpy as np
import pytest

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.features.features import FeatureSettings
from terrain.classification.model_file import read_model, write_model
from terrain.classification.model_settings import ATTRIBUTES, ModelSettings
from terrain.classification.photographs.trained_on import TrainedOn

SETTINGS = ModelSettings(
    preset="default",
    colour=True,
    metres_per_pixel=0.01,
    rejected_share=0.1,
    patch_size_px=32,
    classes=("grass", "sand"),
    n_neighbors=9,
    rejection_distance=4.0,
    features=FeatureSettings(("grey",), ("red_green",), 4, True, filtered_greys=64),
    trained_on=TrainedOn(frozenset({"ab12"}), frozenset({"first"})),
    rejection_distances=(4.0, 3.0, 2.0, 1.5, 1.0),
    temperature=1.5,
    one_patch=True,
    image_rejection_distances=(4.0, 2.5, 2.0, 1.0, 0.5),
    noticed_share=0.75,
)
NEW_IN = {
    "0.5": ["trained_on"],
    "0.10": ["rejection_distances", "temperature"],
    "0.12": ["one_patch"],
    "0.13": ["image_rejection_distances"],
    "0.34": ["noticed_share"],
}


def as_read(settings):
    """The table of a file: lists for tuples, and nothing but JSON."""
    return json.loads(json.dumps(settings.to_table()))


def test_what_is_written_is_read():
    assert ModelSettings.from_table(as_read(SETTINGS)) == SETTINGS
    fewest = replace(
        SETTINGS,
        metres_per_pixel=None,
        trained_on=None,
        temperature=None,
        image_rejection_distances=None,
        noticed_share=None,
    )
    assert ModelSettings.from_table(as_read(fewest)) == fewest
    assert ModelSettings.from_table(as_read(replace(SETTINGS, metres_per_pixel=1)))


@pytest.mark.parametrize("version", NEW_IN)
def test_files_of_older_versions_are_read(version):
    versions = list(NEW_IN)
    absent = [name for new in versions[versions.index(version) :] for name in NEW_IN[new]]
    table = {name: value for name, value in as_read(SETTINGS).items() if name not in absent}
    read = ModelSettings.from_table(table)
    defaults = {of.name: of.default for of in fields(ModelSettings)}
    defaults["rejection_distances"] = (SETTINGS.rejection_distance,)
    assert read == replace(SETTINGS, **{name: defaults[name] for name in absent})


@pytest.mark.parametrize("missing", ["preset", "classes", "rejection_distance", "features"])
def test_what_every_version_has_must_be_there(missing):
    table = as_read(SETTINGS)
    del table[missing]
    with pytest.raises((KeyError, TypeError), match=missing):
        ModelSettings.from_table(table)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("preset", 1),
        ("colour", 1),
        ("one_patch", 1),
        ("metres_per_pixel", True),
        ("metres_per_pixel", 0.0),
        ("metres_per_pixel", float("inf")),
        ("rejected_share", 0.0),
        ("rejected_share", 1.0),
        ("rejected_share", None),
        ("patch_size_px", 32.0),
        ("patch_size_px", 0),
        ("n_neighbors", True),
        ("n_neighbors", 10_001),
        ("classes", "grass"),
        ("classes", ["grass", 1]),
        ("rejection_distance", -1.0),
        ("rejection_distance", float("nan")),
        ("rejection_distances", []),
        ("rejection_distances", [1.0, 2.0]),
        ("rejection_distances", ["1.0"]),
        ("rejection_distances", None),
        ("temperature", 0.05),
        ("image_rejection_distances", []),
        ("image_rejection_distances", [1.0] * 4 + [1e13]),
        ("noticed_share", 1.5),
        ("noticed_share", "0.5"),
    ],
)
def test_another_kind_or_range_is_refused(name, value):
    with pytest.raises((TypeError, ValueError), match=f"{name.split('_')[0]}|not supported"):
        ModelSettings.from_table(as_read(SETTINGS) | {name: value})


@pytest.mark.parametrize(
    ("preset", "colour"), [("default", True), ("fast", False), ("chen2023", False)]
)
def test_a_loaded_classifier_has_every_setting_and_is_saved_in_the_same_bytes(
    tmp_path, rng, preset, colour
):
    images = [rng.integers(0, 90 + 80 * (i % 2), (16, 16, 3), np.uint8) for i in range(24)]
    made = TerrainClassifier(
        preset, colour=colour, metres_per_pixel=0.02, rejected_share=0.1, n_neighbors=3
    ).fit(images, ["a", "b"] * 12, [str(i // 2) for i in range(24)], trained_on=SETTINGS.trained_on)
    made.save(tmp_path / "a.model")
    loaded = TerrainClassifier.load(tmp_path / "a.model")
    for attribute in ATTRIBUTES.values():
        np.testing.assert_array_equal(getattr(loaded, attribute), getattr(made, attribute))
    assert loaded.colour is colour
    loaded.save(tmp_path / "b.model")
    assert (tmp_path / "b.model").read_bytes() == (tmp_path / "a.model").read_bytes()


def test_keys_of_files_stay(tmp_path, rng):
    """Other versions read them."""
    images = [rng.integers(0, 90 + 80 * (i % 2), (16, 16), np.uint8) for i in range(12)]
    model = TerrainClassifier("chen2023").fit(
        images, ["a", "b"] * 6, [str(i // 2) for i in range(12)]
    )
    model.save(tmp_path / "a.model")
    settings, arrays = read_model(tmp_path / "a.model")
    assert sorted(settings) == [
        "classes",
        "colour",
        "features",
        "image_rejection_distances",
        "metres_per_pixel",
        "n_neighbors",
        "noticed_share",
        "one_patch",
        "patch_size_px",
        "preset",
        "rejected_share",
        "rejection_distance",
        "rejection_distances",
        "temperature",
        "trained_on",
    ]
    write_model(tmp_path / "later.model", settings | {"of_a_later_version": 1}, arrays)
    assert TerrainClassifier.load(tmp_path / "later.model").predict(images).tolist()
