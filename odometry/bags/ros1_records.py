"""Records of bag files of ROS 1 (https://wiki.ros.org/Bags/Format/2.0)."""

import struct
from typing import BinaryIO

from odometry.bags.connection import Connection, Message, ros2_name

LONGEST_HEADER = 65536  # definitions stand in the data of a record
LARGEST_RECORD = 2**31
Header = dict[bytes, bytes]


class DamageError(ValueError):
    """A record is not as the format says."""


def record_start(stream: BinaryIO) -> tuple[Header, int]:
    """Header of the record that starts here, and the length of its data."""
    header = fields_of(exactly(stream, length_at(stream, LONGEST_HEADER)))
    if len(header.get(b"op", b"")) != 1:
        raise DamageError("a record without a kind")
    return header, length_at(stream, LARGEST_RECORD)


def message_of(header: Header, data: memoryview, connections: dict[int, Connection]) -> Message:
    """The message of a record."""
    try:
        (number,) = struct.unpack("<I", header[b"conn"])
        seconds, nanoseconds = struct.unpack("<II", header[b"time"])
    except (KeyError, struct.error) as problem:
        raise DamageError("a message without a topic or a time") from problem
    if number not in connections:
        raise DamageError("a message of a topic that is announced nowhere before it")
    return Message(connections[number], seconds * 10**9 + nanoseconds, data)


def announce(header: Header, data: bytes, connections: dict[int, Connection]) -> None:
    """Add the topic that a record announces; the first announcement stays."""
    about = fields_of(data)
    try:
        (number,) = struct.unpack("<I", header[b"conn"])
        topic, message_type = header[b"topic"].decode(), about[b"type"].decode()
    except (KeyError, struct.error, UnicodeDecodeError) as problem:
        raise DamageError("a topic without a name or a type") from problem
    definition = about.get(b"message_definition", b"").decode(errors="replace")
    connections.setdefault(number, Connection(topic, ros2_name(message_type), "ros1", definition))


def fields_of(header: bytes) -> Header:
    """Fields of a header: each a length, a name, an equals sign and a value."""
    fields: Header = {}
    position, end = 0, len(header)
    while position < end:
        if position + 4 > end:
            raise DamageError("a header that is not as the format says")
        length = int.from_bytes(header[position : position + 4], "little")
        name, equals, value = header[position + 4 : position + 4 + length].partition(b"=")
        position += 4 + length
        if not equals or position > end:
            raise DamageError("a header that is not as the format says")
        fields[name] = value
    return fields


def length_at(stream: BinaryIO, most: int) -> int:
    """A length of four bytes."""
    length = int.from_bytes(exactly(stream, 4), "little")
    if length > most:
        raise DamageError(f"a record of {length} bytes, expected at most {most}")
    return length


def exactly(stream: BinaryIO, count: int) -> bytes:
    """So many bytes, or a DamageError."""
    data = stream.read(count)
    if len(data) < count:
        raise DamageError("the file ends within a record")
    return data
