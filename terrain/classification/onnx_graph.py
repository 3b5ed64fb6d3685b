"""The part of an ONNX network that leads to some of its layers, as a network of its own.

Only the messages that name nodes, tensors and outputs are read; weights are copied as they are.
A network that ends at the wanted layers computes no more than these, has no head that asks for one
size of image, and gives the layers themselves with every version of OpenCV: 5.0 may give the
numbers of another layer for one that is not an output.

References
----------
ONNX, ``onnx.proto``: the field numbers below.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod

from terrain.classification.wire_format import (
    as_field,
    chunks_of,
    fields_of,
    numbers_of,
    texts_of,
)
from terrain.errors import NetworkError

MODEL_GRAPH = 7
NODE, GRAPH_NAME, INITIALIZER, INPUT, OUTPUT = 1, 2, 5, 11, 12  # of a graph
NODE_INPUT, NODE_OUTPUT, NODE_NAME, NODE_ATTRIBUTE = 1, 2, 3, 5
ATTRIBUTE_NAME, ATTRIBUTE_INTS = 1, 8
TENSOR_NAME, TENSOR_PLACE = 8, 14
VALUE_NAME, VALUE_TYPE = 1, 2
FLOAT_OF_ANY_SHAPE = as_field(1, as_field(1, 1) + as_field(2, b""))
SHOWN = 12  # names of layers in an error


@dataclass(frozen=True)
class Layer:
    """One node: its name, the tensors that it takes and gives, and by how much it strides."""

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    stride: int


def layers_of(network: bytes) -> list[Layer]:
    """The nodes of a network, in the order in which they are computed.

    Raises
    ------
    NetworkError
        If it is no ONNX network.
    """
    return [_layer(node) for node in chunks_of(_graph(network), NODE)]


def before_halvings(layers: Sequence[Layer], most: int) -> tuple[str, ...]:
    """The first tensors that a stride makes smaller; the image itself is none of them."""
    made = {name for layer in layers for name in layer.outputs}
    smaller = [of.inputs[0] for of in layers if of.stride > 1 and of.inputs[0] in made]
    return tuple(dict.fromkeys(smaller))[:most]


def outputs_of(network: bytes) -> tuple[str, ...]:
    """The tensors that a network gives; NetworkError if it is none."""
    values = chunks_of(_graph(network), OUTPUT)
    return tuple(name for value in values for name in texts_of(value, VALUE_NAME))


def tensors_of(layers: Sequence[Layer], names: Sequence[str]) -> tuple[str, ...]:
    """The tensor that each name means: its own, or that of the node of this name.

    Raises
    ------
    NetworkError
        If there is no such layer.
    """
    by_name = {layer.name: layer.outputs[0] for layer in layers}
    by_name |= {name: name for layer in layers for name in layer.outputs}
    for name in names:
        if name not in by_name:
            known = [layer.outputs[0] for layer in layers]
            half = SHOWN // 2
            shown = known if len(known) <= SHOWN else [*known[:half], "...", *known[-half:]]
            raise NetworkError(
                f"there is no layer '{name}'; its {len(known)} layers: {', '.join(shown)}"
            )
    return tuple(by_name[name] for name in names)


def part_leading_to(network: bytes, tensors: Sequence[str]) -> bytes:
    """The ONNX network whose outputs are these tensors of another one.

    Raises
    ------
    NetworkError
        If it is no ONNX network, or its weights lie in other files.
    """
    graph = _graph(network)
    needed, nodes = set(tensors), []
    for node in reversed(chunks_of(graph, NODE)):
        layer = _layer(node)
        if needed & set(layer.outputs):
            needed |= set(layer.inputs)
            nodes.append(as_field(NODE, node))
    weights = [w for w in chunks_of(graph, INITIALIZER) if needed & set(texts_of(w, TENSOR_NAME))]
    if any(any(numbers_of(w, TENSOR_PLACE)) for w in weights):
        raise NetworkError("its weights lie in another file; save the network as one file")
    inputs = [v for v in chunks_of(graph, INPUT) if needed & set(texts_of(v, VALUE_NAME))]
    parts = [as_field(GRAPH_NAME, b"part"), *reversed(nodes)]
    parts += [as_field(INITIALIZER, tensor) for tensor in weights]
    parts += [as_field(INPUT, value) for value in inputs]
    parts += [
        as_field(
            OUTPUT, as_field(VALUE_NAME, name.encode()) + as_field(VALUE_TYPE, FLOAT_OF_ANY_SHAPE)
        )
        for name in tensors
    ]
    others = [as_field(*field) for field in fields_of(network) if field[0] != MODEL_GRAPH]
    return b"".join([*others, as_field(MODEL_GRAPH, b"".join(parts))])


def _graph(network: bytes) -> bytes:
    graphs = chunks_of(network, MODEL_GRAPH)
    if len(graphs) != 1 or not chunks_of(graphs[0], NODE):
        raise NetworkError("it holds no graph of layers; not an ONNX network")
    return graphs[0]


def _layer(node: bytes) -> Layer:
    names, inputs, outputs = (texts_of(node, f) for f in (NODE_NAME, NODE_INPUT, NODE_OUTPUT))
    if not outputs:
        raise NetworkError("one of its layers gives nothing; not an ONNX network")
    strides = [
        prod(numbers_of(attribute, ATTRIBUTE_INTS))
        for attribute in chunks_of(node, NODE_ATTRIBUTE)
        if "strides" in texts_of(attribute, ATTRIBUTE_NAME)
    ]
    return Layer("".join(names), tuple(inputs), tuple(outputs), max(strides, default=1))
