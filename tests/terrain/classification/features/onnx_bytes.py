"""ONNX files written byte by byte, with no code of the packages, and what their layers give."""

import numpy as np
from scipy.signal import correlate

RNG = np.random.default_rng(5)
WEIGHTS = {
    "W1": RNG.normal(size=(4, 3, 3, 3)).astype(np.float32),
    "B1": RNG.normal(size=4).astype(np.float32),
    "W2": RNG.normal(size=(6, 4, 3, 3)).astype(np.float32) / 4,
    "B2": RNG.normal(size=6).astype(np.float32),
    "W3": RNG.normal(size=(5, 6 * 8 * 8)).astype(np.float32).T,
}


def number(value):
    """A varint."""
    groups = [value >> shift & 0x7F for shift in range(0, max(value.bit_length(), 1), 7)]
    return bytes([group | 0x80 for group in groups[:-1]] + groups[-1:])


def whole(field, value):
    return number(field << 3) + number(value)


def chunk(field, value):
    data = value.encode() if isinstance(value, str) else value
    return number(field << 3 | 2) + number(len(data)) + data


def tensor(name, array, *, elsewhere=False):
    dims = b"".join(whole(1, size) for size in array.shape)
    place = whole(14, 1) if elsewhere else b""
    return dims + whole(2, 1) + chunk(8, name) + chunk(9, array.tobytes()) + place


def node(operation, inputs, output, name, *, packed=False, **ints):
    def attribute(key, values):
        listed = chunk(8, b"".join(map(number, values))) if packed else None
        return chunk(1, key) + (listed or b"".join(whole(8, v) for v in values)) + whole(20, 7)

    named = b"".join(chunk(1, one) for one in inputs) + chunk(2, output) + chunk(3, name)
    return (
        named + chunk(4, operation) + b"".join(chunk(5, attribute(*item)) for item in ints.items())
    )


def value(name, dims):
    shape = b"".join(chunk(1, whole(1, d) if isinstance(d, int) else chunk(2, d)) for d in dims)
    return chunk(1, name) + chunk(2, chunk(1, whole(1, 1) + chunk(2, shape)))


def network(nodes, tensors, given, gives):
    graph = b"".join(chunk(1, one) for one in nodes) + chunk(2, "tiny")
    graph += b"".join(chunk(5, one) for one in tensors)
    graph += b"".join(chunk(11, one) for one in given) + b"".join(chunk(12, one) for one in gives)
    return (
        whole(1, 8) + chunk(2, "a test") + chunk(7, graph) + chunk(8, chunk(1, "") + whole(2, 13))
    )


def tiny_network(size="side", *, elsewhere=False, packed=False):
    """Convolution, ReLU, convolution of stride 2, ReLU, and a head for images of 16 x 16."""
    conv = {"kernel_shape": [3, 3], "pads": [1, 1, 1, 1]}
    nodes = [
        node("Conv", ["image", "W1", "B1"], "c1", "conv1", **conv),
        node("Relu", ["c1"], "r1", "relu1"),
        node("Conv", ["r1", "W2", "B2"], "c2", "conv2", packed=packed, strides=[2, 2], **conv),
        node("Relu", ["c2"], "r2", "relu2"),
        node("Flatten", ["r2"], "flat", "flatten"),
        node("MatMul", ["flat", "W3"], "scores", "head"),
    ]
    tensors = [tensor(name, array, elsewhere=elsewhere) for name, array in WEIGHTS.items()]
    image = value("image", [1, 3, size, size])
    return network(nodes, tensors, [image], [value("scores", [1, 5])])


def tiny_layers(image, low=-1.0, high=1.0):
    """What the layers of `tiny_network` give for an image (H, W) or (H, W, 3), by name."""
    channels = np.stack([image] * 3) if image.ndim == 2 else np.moveaxis(image, -1, 0)
    blob = low + channels * (high - low) / 255.0
    layers = {"c1": _convolved(blob, WEIGHTS["W1"], WEIGHTS["B1"])}
    layers["r1"] = np.maximum(layers["c1"], 0)
    layers["c2"] = _convolved(layers["r1"], WEIGHTS["W2"], WEIGHTS["B2"])[:, ::2, ::2]
    layers["r2"] = np.maximum(layers["c2"], 0)
    return layers


def tiny_features(image, names=("r1",), **values):
    """Means and deviations of the channels of layers."""
    layers = tiny_layers(image, **values)
    return np.concatenate(
        [part for n in names for part in (layers[n].mean((1, 2)), layers[n].std((1, 2)))]
    )


def _convolved(channels, weights, bias):
    padded = np.pad(channels, ((0, 0), (1, 1), (1, 1)))
    maps = [correlate(padded, kernel.astype(float), "valid")[0] for kernel in weights]
    return np.array(maps) + bias[:, None, None]
