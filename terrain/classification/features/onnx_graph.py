"""The part of an ONNX network that leads to some of its layers, as a network of its own.

Only the messages that name nodes, tensors and outputs are read; weights are copied as they are.
A network that ends at the wanted layers computes no more than these, has no head that requires one
size of image, and gives the layers themselves with every version of OpenCV: 5.0 may give the
numbers of another layer for one that is not an output.

References
----------
ONNX, ``onnx.proto``: the field numbers below.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import prod

from terrain.errors import NetworkError

VARINT, EIGHT_BYTES, CHUNK, FOUR_BYTES = 0, 1, 2, 5
FIXED_WIDTHS = {EIGHT_BYTES: 8, FOUR_BYTES: 4}
MOST_SHIFT = 70  # bits of a number; 64 are allowed

Field = tuple[int, bytes | int]

MODEL_GRAPH = 7
NODE, GRAPH_NAME, INITIALIZER, INPUT, OUTPUT = 1, 2, 5, 11, 12  # of a graph
NODE_INPUT, NODE_OUTPUT, NODE_NAME, NODE_ATTRIBUTE = 1, 2, 3, 5
ATTRIBUTE_NAME, ATTRIBUTE_INTS = 1, 8
TENSOR_NAME, TENSOR_PLACE = 8, 14
VALUE_NAME, VALUE_TYPE = 1, 2
SHOWN = 12  # names of layers in an error


def fields_of(message: bytes) -> Iterator[Field]:
    """Give number and value of each field of a message.

    Raises
    ------
    NetworkError
        If the bytes are no message.
    """
    place = 0
    while place < len(message):
        key, place = _number_at(message, place)
        field, kind = key >> 3, key & 7
        if kind == VARINT:
            value, place = _number_at(message, place)
            yield field, value
            continue
        if kind == CHUNK:
            length, place = _number_at(message, place)
        elif kind in FIXED_WIDTHS:
            length = FIXED_WIDTHS[kind]
        else:
            raise NetworkError(f"byte {place} begins no field; not an ONNX network")
        if place + length > len(message):
            raise NetworkError("it ends within a field: cut off, or not an ONNX network")
        if kind == CHUNK:
            yield field, message[place : place + length]
        place += length


def chunks_of(message: bytes, wanted: int) -> list[bytes]:
    """The values of one field of a message that are bytes.

    Raises
    ------
    NetworkError
        If the bytes are no message.
    """
    return [v for field, v in fields_of(message) if field == wanted and isinstance(v, bytes)]


def texts_of(message: bytes, wanted: int) -> list[str]:
    """The values of one field of a message that are text."""
    return [value.decode("utf-8", "replace") for value in chunks_of(message, wanted)]


def numbers_of(message: bytes, wanted: int) -> list[int]:
    """The values of one repeated field of whole numbers, packed or not."""
    found: list[int] = []
    for field, value in fields_of(message):
        if field == wanted and isinstance(value, int):
            found.append(value)
        elif field == wanted and isinstance(value, bytes):
            place = 0
            while place < len(value):
                number, place = _number_at(value, place)
                found.append(number)
    return found


def as_field(field: int, value: bytes | int) -> bytes:
    """The bytes of one field."""
    if isinstance(value, int):
        return _as_number(field << 3 | VARINT) + _as_number(value)
    return _as_number(field << 3 | CHUNK) + _as_number(len(value)) + value


def _number_at(message: bytes, place: int) -> tuple[int, int]:
    value = shift = 0
    while place < len(message) and shift < MOST_SHIFT:
        byte = message[place]
        value, place, shift = value | (byte & 0x7F) << shift, place + 1, shift + 7
        if byte < 0x80:
            return value, place
    raise NetworkError("it ends within a number: cut off, or not an ONNX network")


def _as_number(number: int) -> bytes:
    encoded = bytearray()
    while number > 0x7F:
        encoded.append(number & 0x7F | 0x80)
        number >>= 7
    return bytes([*encoded, number])


FLOAT_OF_ANY_SHAPE = as_field(1, as_field(1, 1) + as_field(2, b""))


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
