"""The wire format of Protocol Buffers: the fields of a message, and a message from fields.

References
----------
Protocol Buffers, "Encoding". Strings and messages within a message are bytes here; numbers of fixed
width are passed over.
"""

from collections.abc import Iterator

from terrain.errors import NetworkError

VARINT, EIGHT_BYTES, CHUNK, FOUR_BYTES = 0, 1, 2, 5
FIXED_WIDTHS = {EIGHT_BYTES: 8, FOUR_BYTES: 4}
MOST_SHIFT = 70  # bits of a number; 64 are allowed

Field = tuple[int, bytes | int]


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
