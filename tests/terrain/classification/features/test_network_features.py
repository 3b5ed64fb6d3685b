"""Features by an image network: a tiny one, whose layers are computed here by convolution."""

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.base import clone

from odometry.errors import ConfigError
from terrain.classification.features.network_features import Network, NetworkFeatures
from terrain.classification.features.onnx_graph import layers_of, part_leading_to
from terrain.errors import ImageError, NetworkError
from tests.terrain.classification.features.onnx_bytes import WEIGHTS, tiny_features, tiny_network

IMAGES = np.random.default_rng(3).integers(0, 256, (3, 16, 16, 3), dtype=np.uint8)
TINY = Network("tiny.onnx", tiny_network())


@pytest.mark.parametrize(
    ("layers", "tensors"),
    [
        ((), ("r1",)),  # what the stride makes smaller
        (("r1", "r2"), ("r1", "r2")),
        (("c2", "c1"), ("c2", "c1")),
        (("relu2",), ("r2",)),  # by the name of the node
    ],
)
@pytest.mark.parametrize("grey", [True, False])
def test_features_are_means_and_deviations_of_the_layers(layers, tensors, grey):
    images = IMAGES[..., 0] if grey else IMAGES
    found = NetworkFeatures(TINY, layers=layers).fit_transform(list(images))
    expected = [tiny_features(image, tensors) for image in images]
    np.testing.assert_allclose(found, expected, rtol=2e-5, atol=1e-5)


def test_what_a_network_gives_is_taken_where_it_is_a_map():
    part = Network("part.onnx", part_leading_to(TINY.data, ("r2",)))
    assert NetworkFeatures(part).read_network().layers_ == ("r1", "r2")
    assert NetworkFeatures(TINY).read_network().layers_ == ("r1",)
    flat = Network("flat.onnx", part_leading_to(part.data, ("r1",)))
    assert NetworkFeatures(flat).read_network().layers_ == ("r1",)


def test_the_network_sees_values_in_its_range():
    found = NetworkFeatures(TINY, input_range=(0.0, 255.0)).transform(IMAGES)
    expected = [tiny_features(image, low=0.0, high=255.0) for image in IMAGES]
    np.testing.assert_allclose(found, expected, rtol=2e-5, atol=1e-3)


def test_layers_before_the_head_take_patches_of_any_size():
    """The head asks for 16 x 16; it is left out. A stated size is no condition either."""
    image = np.random.default_rng(4).integers(0, 256, (40, 24), dtype=np.uint8)
    for size in ("side", 16):
        features = NetworkFeatures(Network("t", tiny_network(size)), layers=("r1", "r2"))
        np.testing.assert_allclose(
            features.transform([image])[0], tiny_features(image, ("r1", "r2")), rtol=2e-5, atol=1e-5
        )


def test_a_patch_does_not_depend_on_its_neighbours():
    features = NetworkFeatures(TINY).read_network()
    together = features.transform(IMAGES)
    alone = [features.transform([image])[0] for image in IMAGES[::-1]]
    np.testing.assert_array_equal(together, alone[::-1])


def test_a_file_a_clone_and_a_pickled_copy_give_the_same(tmp_path):
    (tmp_path / "tiny.onnx").write_bytes(TINY.data)
    features = NetworkFeatures(tmp_path / "tiny.onnx", layers=("r2",))
    expected = features.transform(IMAGES)
    copies = [clone(features), pickle.loads(pickle.dumps(features))]  # noqa: S301
    for copy in copies:
        np.testing.assert_array_equal(copy.transform(IMAGES), expected)
    (tmp_path / "tiny.onnx").unlink()
    np.testing.assert_array_equal(copies[1].transform(IMAGES), expected)


def test_names_tell_layer_quantity_and_channel():
    names = NetworkFeatures(TINY, layers=("r1", "r2")).read_network().get_feature_names_out()
    assert len(set(names)) == len(names) == 2 * (4 + 6)
    assert names[[0, 4, -1]].tolist() == ["r1_mean_0", "r1_deviation_0", "r2_deviation_5"]


def test_the_part_has_no_layer_and_no_weight_that_is_not_needed():
    part = part_leading_to(TINY.data, ("r1",))
    assert [layer.outputs for layer in layers_of(part)] == [("c1",), ("r1",)]
    assert WEIGHTS["W1"].tobytes() in part
    assert WEIGHTS["W2"].tobytes() not in part
    assert part_leading_to(part, ("r1",)) == part


def test_strides_are_read_in_both_ways_of_writing_them():
    for packed in (False, True):
        strides = [layer.stride for layer in layers_of(tiny_network(packed=packed))]
        assert strides == [1, 1, 4, 1, 1, 1]


@pytest.mark.parametrize(
    ("data", "settings_", "message"),
    [
        (b"", {}, "tiny.onnx: it holds no graph"),
        (b"no network", {}, "not an ONNX network"),
        (TINY.data[:200], {}, "cut off"),
        (tiny_network(elsewhere=True), {}, "weights lie in another file"),
        (TINY.data, {"layers": ("r3",)}, r"no layer 'r3'; its 6 layers: c1, r1, .*scores"),
        (TINY.data, {"layers": ("flat",)}, r"layer 'flat' gives \(1, \d+\), no map"),
    ],
)
def test_what_is_no_network_or_no_map_is_refused(data, settings_, message):
    with pytest.raises(NetworkError, match=message):
        NetworkFeatures(Network("tiny.onnx", data), **settings_).read_network()


def test_a_missing_file_and_a_range_the_wrong_way_round_are_refused(tmp_path):
    with pytest.raises(NetworkError, match=r"absent\.onnx"):
        NetworkFeatures(tmp_path / "absent.onnx").read_network()
    with pytest.raises(ConfigError, match="input_range"):
        NetworkFeatures(TINY, input_range=(1.0, -1.0)).read_network()


def test_an_image_that_the_network_cannot_take_is_named():
    features = NetworkFeatures(TINY).read_network()
    with pytest.raises(ImageError, match="image 1"):
        features.transform([IMAGES[0], IMAGES[0].astype(complex)])


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_a_damaged_file_is_refused_or_still_a_graph(data):
    damaged = bytearray(TINY.data[: data.draw(st.integers(0, len(TINY.data)))])
    if damaged:
        damaged[data.draw(st.integers(0, min(len(damaged), 120) - 1))] ^= data.draw(
            st.integers(1, 255)
        )
    try:
        part_leading_to(bytes(damaged), ("r1",))
    except NetworkError:
        return
    assert layers_of(bytes(damaged))
