"""Bag files of ROS 1 (version 2.0), read from front to back: no index is needed.

The index at the end of a file is never used, so that a file that was cut off, or whose recorder
was stopped, is read as any other. Source: https://wiki.ros.org/Bags/Format/2.0.
"""

import re
import struct
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from odometry.bags.files.damage import Losses, decompressed, windows
from odometry.bags.files.topic import Connection, Message, ros2_name
from odometry.errors import BagError

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


MAGIC = b"#ROSBAG V2.0\n"
MESSAGE, BAG_HEADER, CHUNK, CONNECTION = 2, 3, 5, 7
CHUNK_MARK = re.compile(rb"\x04\x00\x00\x00op=\x05")
MARK_BYTES = 512  # more than the header of a chunk


def ros1_messages(file: Path, losses: Losses) -> Iterator[Message]:
    """Messages in the order of the file; what cannot be read is added to `losses`.

    Raises
    ------
    BagError
        If the file is no bag of this version, or is encrypted.
    """
    connections: dict[int, Connection] = {}
    size = file.stat().st_size
    with file.open("rb") as stream:
        if stream.read(len(MAGIC)) != MAGIC:
            raise BagError(f"{file}: no bag file of ROS 1, version 2.0 (it starts otherwise)")
        while (begin := stream.tell()) < size:
            try:
                header, length = record_start(stream)
                if header[b"op"][0] == BAG_HEADER:
                    losses += _unfinished(header, file, size)
                    connections |= _indexed(header, file, size)
                yield from _record(header, stream.read(length), connections, file, losses)
            except DamageError as problem:
                stream.seek(begin)
                found = _next_chunk(stream, begin + 1)
                lost = (found or size) - begin
                losses.append(f"{file}: {lost} bytes from byte {begin} on: {problem}")
                if found is None:
                    return
                stream.seek(found)


def _unfinished(header: Header, file: Path, size: int) -> Iterator[str]:
    """Whether the file was closed, and is as long as it says."""
    if header.get(b"encryptor"):
        raise BagError(f"{file}: the bag is encrypted; decrypt it first")
    index = int.from_bytes(header.get(b"index_pos", b""), "little")
    if index == 0:
        yield f"{file}: its recorder was stopped before it closed the file; the end may be missing"
    elif index > size:
        yield f"{file}: it is cut off: {size} bytes are there of more than {index}"


def _indexed(header: Header, file: Path, size: int) -> dict[int, Connection]:
    """Topics as the end of the file announces them again, where it is there."""
    found: dict[int, Connection] = {}
    index = int.from_bytes(header.get(b"index_pos", b""), "little")
    with file.open("rb") as stream:
        stream.seek(index or size)
        with suppress(DamageError):
            while stream.tell() < size:
                record, length = record_start(stream)
                if record[b"op"][0] != CONNECTION:
                    break
                announce(record, stream.read(length), found)
    return found


def _record(
    header: Header,
    data: bytes,
    connections: dict[int, Connection],
    file: Path,
    losses: Losses,
) -> Iterator[Message]:
    kind = header[b"op"][0]
    if kind == CHUNK:
        compression = header.get(b"compression", b"none").decode(errors="replace")
        chunk, problem = decompressed(data, compression)
        if problem:
            losses.append(f"{file}: a part of a chunk of {len(data)} bytes: {problem}")
        yield from _inside(memoryview(chunk), connections, file, losses, whole=not problem)
    elif kind == CONNECTION:
        announce(header, data, connections)
    elif kind == MESSAGE:  # a bag without chunks
        yield message_of(header, memoryview(data), connections)


def _inside(
    chunk: memoryview,
    connections: dict[int, Connection],
    file: Path,
    losses: Losses,
    *,
    whole: bool,
) -> Iterator[Message]:
    """Records of a chunk, up to where it is cut or, said here, damaged."""
    position, end, begin = 0, len(chunk), 0
    try:
        while position < end:
            begin = position
            (length,) = struct.unpack_from("<I", chunk, position)
            header = fields_of(chunk[position + 4 : position + 4 + length].tobytes())
            position += 4 + length
            (length,) = struct.unpack_from("<I", chunk, position)
            data = chunk[position + 4 : position + 4 + length]
            position += 4 + length
            if position <= end and header[b"op"] == b"\x02":
                yield message_of(header, data, connections)
            elif position <= end and header[b"op"] == b"\x07":
                announce(header, data.tobytes(), connections)
    except (struct.error, KeyError, DamageError):
        position = end + 1
    if position > end and whole:
        losses.append(f"{file}: {max(0, end - begin)} bytes at the end of a chunk of {end}")


def _next_chunk(stream: BinaryIO, begin: int) -> int | None:
    """Start of the next chunk that seems complete; None where there is none."""
    for first, window in windows(stream, begin, MARK_BYTES):
        for mark in CHUNK_MARK.finditer(window):
            for back in range(4, 64):
                start = mark.start() - back
                if start >= 0 and _is_chunk(window[start : start + 256]):
                    return first + start
    return None


def _is_chunk(window: bytes) -> bool:
    """Whether the header of a chunk starts here."""
    length = int.from_bytes(window[:4], "little")
    if not 20 <= length <= 128:
        return False
    try:
        header = fields_of(window[4 : 4 + length])
    except DamageError:
        return False
    return header.get(b"op") == b"\x05" and {b"compression", b"size"} <= header.keys()
