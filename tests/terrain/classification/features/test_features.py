import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from terrain.classification.features.copies import COLOUR_COPIES, GREY_COPIES
from terrain.classification.features.features import (
    FeatureSettings,
    feature_matrix,
    feature_names,
    patch_features,
)
from terrain.classification.features.filters import (
    Scales,
    gradient_magnitude,
    red_green,
    yellow_blue,
)
from terrain.classification.presets import PRESETS
from terrain.texture import sfta

GREY = PRESETS["default"].features
BANK = PRESETS["default"].colour_features
SFTA_ALONE = replace(GREY, grey_copies=tuple(GREY_COPIES), statistics=())


def features_of(image, settings):
    return patch_features([image], settings)[0]


def test_chen2023_is_sfta_of_the_grey_image_and_nothing_else(rng):
    image = rng.integers(0, 256, (40, 40, 3), dtype=np.uint8)
    for settings in (PRESETS["chen2023"].features, PRESETS["chen2023"].colour_features):
        np.testing.assert_array_equal(features_of(image, settings), sfta(image, n_thresholds=4))


def test_each_copy_gives_its_sfta_with_counts_by_area(rng):
    image = rng.integers(0, 256, (40, 40, 3), dtype=np.uint8)
    exact = features_of(image, replace(BANK, filtered_greys=256, statistics=()))
    blocks = exact.reshape(len(GREY_COPIES) + len(COLOUR_COPIES), 8, 3)
    grey = ((image @ np.array([30, 59, 11]) + 50) // 100).astype(np.float32)
    names = [*GREY_COPIES, *COLOUR_COPIES]
    for name, copy in (
        ("magnitude_1.4", gradient_magnitude(1.4)(Scales(grey))),
        ("red_green", red_green(image)),
        ("yellow_blue", yellow_blue(image)),
    ):
        expected = sfta(copy).reshape(8, 3) / [1, copy.size, 1]
        np.testing.assert_allclose(blocks[names.index(name)], expected, atol=1e-12)
    assert blocks[..., 1].min() >= 0
    assert blocks[..., 1].max() <= 1


def test_the_default_preset_begins_with_sfta_of_the_patch_at_three_scales(rng):
    image = np.kron(rng.integers(0, 256, (10, 12), dtype=np.uint8), np.ones((4, 4), np.uint8))
    features = features_of(image, replace(GREY, filtered_greys=256))
    for place, reduced in enumerate((image, image[::2, ::2], image[::4, ::4])):
        expected = sfta(reduced).reshape(8, 3) / [1, reduced.size, 1]
        found = features[24 * place : 24 * place + 24].reshape(8, 3)
        np.testing.assert_allclose(found, expected, atol=1e-12)


def test_counts_by_area_do_not_depend_on_the_size_of_the_patch(rng):
    tile = np.kron(rng.integers(0, 256, (16, 16), dtype=np.uint8), np.ones((4, 4), np.uint8))
    settings = FeatureSettings(("grey", "grey_4"), (), 3, counts_per_area=True)
    small, large = (features_of(image, settings) for image in (tile, np.tile(tile, (2, 2))))
    np.testing.assert_allclose(small[1::3], large[1::3], atol=1e-12)
    np.testing.assert_allclose(small[2::3], large[2::3], atol=1e-9)


def test_a_matrix_has_a_row_per_patch(rng):
    images = list(rng.integers(0, 256, (3, 24, 24), dtype=np.uint8))
    matrix = feature_matrix(images, GREY)
    assert matrix.shape == (3, 24 * 3 + 230 + 46)
    np.testing.assert_array_equal(matrix[2], features_of(images[2], GREY))
    assert np.isfinite(feature_matrix([np.zeros((24, 24), np.uint8)], GREY)).all()


def test_thresholds_of_filtered_copies_end_bins_of_four_greys_and_those_of_the_image_none(rng):
    image = rng.integers(0, 256, (40, 40), dtype=np.uint8)
    binned = features_of(image, SFTA_ALONE).reshape(len(GREY_COPIES), 8, 3)
    exact = features_of(image, replace(SFTA_ALONE, filtered_greys=256)).reshape(binned.shape)
    names = list(GREY_COPIES)
    np.testing.assert_array_equal(binned[names.index("grey")], exact[names.index("grey")])
    assert (binned != exact).any(axis=(1, 2)).sum() > 15
    copy = gradient_magnitude(1.4)(Scales(image))
    shares = {np.mean(copy > last) for last in range(3, 256, 4)}
    assert set(binned[names.index("magnitude_1.4"), :4, 1]) <= shares


def test_settings_of_version_0_9_ask_for_all_greys():
    table = asdict(GREY)
    del table["filtered_greys"]
    assert FeatureSettings.from_table(table) == replace(GREY, filtered_greys=256)
    with pytest.raises(ValueError, match="filtered_greys = 7"):
        FeatureSettings.from_table(table | {"filtered_greys": 7})


def test_settings_come_back_from_json_and_unknown_copies_are_refused():
    table = json.loads(json.dumps(asdict(BANK)))
    assert FeatureSettings.from_table(table) == BANK
    with pytest.raises(ValueError, match=r"does not know: .*wavelets"):
        FeatureSettings.from_table(table | {"grey_copies": ["grey", "wavelets"]})


@pytest.mark.parametrize("settings", [GREY, BANK], ids=["grey", "colour"])
def test_sfta_comes_first_and_every_feature_has_a_name(settings, rng):
    image = rng.integers(0, 256, (40, 56, 3), dtype=np.uint8)
    features, sfta_alone = (
        features_of(image, of) for of in (settings, replace(settings, statistics=()))
    )
    assert features[: len(sfta_alone)].tobytes() == sfta_alone.tobytes()
    names = feature_names(settings)
    assert len(names) == len(set(names)) == len(features)
    for group in ("joint", "gabor"):
        one = features_of(image, replace(settings, statistics=(group,)))[len(sfta_alone) :]
        places = [i for i, name in enumerate(names) if name.startswith(f"{group}_")]
        np.testing.assert_array_equal(features[places], one)


@pytest.mark.parametrize("settings", [GREY, BANK], ids=["grey", "colour"])
@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (2, 2), (3, 3), (4, 1), (5, 4), (13, 40)])
def test_features_of_small_and_flat_patches_are_finite(settings, shape, rng):
    flat = [np.full((*shape, 3), grey, np.uint8) for grey in (0, 90, 255)]
    patches = [*flat, rng.integers(0, 256, (*shape, 3), dtype=np.uint8)]
    matrix = feature_matrix(patches, settings)
    assert matrix.shape == (4, len(feature_names(settings)))
    assert np.isfinite(matrix).all()


@pytest.mark.parametrize("settings", [GREY, BANK], ids=["grey", "colour"])
def test_a_patch_has_the_same_bits_alone_and_among_others_with_any_number_of_threads(settings, rng):
    images = list(rng.integers(0, 256, (11, 40, 48, 3), dtype=np.uint8))
    together = feature_matrix(images, settings)
    alone = np.concatenate([patch_features([image], settings) for image in images])
    assert alone.tobytes() == together.tobytes()
    for threads in (1, 2):
        with threadpool_limits(threads):
            assert feature_matrix(images, settings).tobytes() == together.tobytes()


def test_models_of_older_versions_have_no_statistics_and_unknown_ones_are_refused():
    table = json.loads(json.dumps(asdict(GREY)))
    assert FeatureSettings.from_table(table) == GREY
    with pytest.raises(ValueError, match=r"statistics .* does not know: .*moods"):
        FeatureSettings.from_table(table | {"statistics": ["joint", "moods"]})
    del table["statistics"]
    assert FeatureSettings.from_table(table) == replace(GREY, statistics=())
