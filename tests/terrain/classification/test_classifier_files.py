"""Files and settings of a classifier that no training would make."""

import numpy as np
import pytest

from odometry.errors import ConfigError
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.model_file import read_model, write_model
from terrain.errors import ModelFileError
from tests.terrain.classification.test_classifier import features_of, grains, patches, stripes


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("patch_size_px", 10**9),
        ("n_neighbors", 10**9),
        ("rejection_distance", 1e300),
        ("metres_per_pixel", -1.0),
        ("classes", ["grass"]),
    ],
)
def test_settings_beyond_all_measure_are_refused(tmp_path, key, value):
    """No memory is taken because a file claims that it is needed."""
    rng = np.random.default_rng(0)
    images = [rng.integers(0, 60 + 60 * (i % 2), (16, 16), np.uint8) for i in range(8)]
    groups = [str(i // 2) for i in range(8)]
    TerrainClassifier("chen2023").fit(images, ["a", "b"] * 4, groups).save(tmp_path / "a.model")
    settings, arrays = read_model(tmp_path / "a.model")
    write_model(tmp_path / "b.model", settings | {key: value}, arrays)
    with pytest.raises(ModelFileError, match=r"b\.model: its settings or arrays do not fit"):
        TerrainClassifier.load(tmp_path / "b.model")


@pytest.mark.parametrize("scale", [np.nan, np.inf, 0.0, -1.0])
def test_a_scale_must_be_a_number_above_zero(rng, scale):
    with pytest.raises(ConfigError, match="metres_per_pixel"):
        TerrainClassifier(metres_per_pixel=scale).fit(*patches(rng, (grains, stripes)))


def test_a_file_of_version_0_9_gives_its_own_answers(tmp_path, rng):
    """It has neither Fourier features nor limits by number of patches nor a temperature."""
    classifier = TerrainClassifier().fit(*patches(rng, (grains, stripes)))
    classifier.save(tmp_path / "new.model")
    settings, arrays = read_model(tmp_path / "new.model")
    linear = arrays["discriminants"][: len(arrays["scaler_mean"])]
    scaled = ((features_of(grains(rng)) - arrays["scaler_mean"]) / arrays["scaler_scale"]).clip(
        -3, 3
    )
    older = {n: a for n, a in arrays.items() if n not in ("frequencies", "phases")}
    older["discriminants"] = linear
    for name in ("rejection_distances", "image_rejection_distances", "temperature"):
        del settings[name]
    write_model(tmp_path / "old.model", settings, older)
    loaded = TerrainClassifier.load(tmp_path / "old.model")
    assert loaded.temperature_ is None
    assert loaded.rejection_distances_ == (classifier.rejection_distance_,)
    space = loaded._neighbours.pipeline_[:-1].transform(
        arrays["scaler_mean"] + scaled * arrays["scaler_scale"]
    )
    np.testing.assert_allclose(space, scaled @ linear, rtol=1e-9)
