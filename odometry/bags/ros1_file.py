"""Bag files of ROS 1 (version 2.0), read from front to back: no index is needed.

The index at the end of a file is never used, so that a file that was cut off, or whose recorder
was stopped, is read as any other. Source: https://wiki.ros.org/Bags/Format/2.0.
"""

import re
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from odometry.bags.compression import decompressed
from odometry.bags.connection import Connection, Message, ros2_name
from odometry.bags.errors import BagError

MAGIC = b"#ROSBAG V2.0\n"
MESSAGE, BAG_HEADER, CHUNK, CONNECTION = 2, 3, 5, 7
LONGEST_HEADER = 65536  # definitions stand in the data of a record
LARGEST_RECORD = 2**31
CHUNK_MARK = re.compile(rb"\x04\x00\x00\x00op=\x05")
SEARCHED = 4 * 1024**2  # bytes at a time, in search of a chunk
Header = dict[bytes, bytes]


class DamageError(ValueError):
    """A record is not as the format says."""


def ros1_messages(file: Path, losses: list[str]) -> Iterator[Message]:
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
                header, length = _record_start(stream)
                if header[b"op"][0] == BAG_HEADER:
                    losses += _unfinished(header, file, size)
                yield from _record(header, stream.read(length), connections, file, losses)
            except DamageError as problem:
                stream.seek(begin)
                found = _next_chunk(stream, begin + 1)
                lost = (found or size) - begin
                losses.append(f"{file}: {lost} bytes from byte {begin} on: {problem}")
                if found is None:
                    return
                stream.seek(found)


def _record_start(stream: BinaryIO) -> tuple[Header, int]:
    """Header of the record that starts here, and the length of its data."""
    header = _fields(_exactly(stream, _length(stream, LONGEST_HEADER)))
    if b"op" not in header:
        raise DamageError("a record without a kind")
    return header, _length(stream, LARGEST_RECORD)


def _unfinished(header: Header, file: Path, size: int) -> Iterator[str]:
    """Whether the file was closed, and is as long as it says."""
    if header.get(b"encryptor"):
        raise BagError(f"{file}: the bag is encrypted; decrypt it first")
    index = int.from_bytes(header.get(b"index_pos", b""), "little")
    if index == 0:
        yield f"{file}: its recorder was stopped before it closed the file; the end may be missing"
    elif index > size:
        yield f"{file}: it is cut off: {size} bytes are there of more than {index}"


def _record(
    header: Header,
    data: bytes,
    connections: dict[int, Connection],
    file: Path,
    losses: list[str],
) -> Iterator[Message]:
    kind = header[b"op"][0]
    if kind == CHUNK:
        compression = header.get(b"compression", b"none").decode(errors="replace")
        chunk, problem = decompressed(data, compression)
        if problem:
            losses.append(f"{file}: a part of a chunk of {len(data)} bytes: {problem}")
        yield from _inside(memoryview(chunk), connections, file, losses)
    elif kind == CONNECTION:
        _announce(header, data, connections)
    elif kind == MESSAGE:  # a bag without chunks
        yield _message(header, memoryview(data), connections)


def _inside(
    chunk: memoryview, connections: dict[int, Connection], file: Path, losses: list[str]
) -> Iterator[Message]:
    """Records of a chunk, up to its end or to where it is cut or damaged."""
    position, end = 0, len(chunk)
    try:
        while position < end:
            (length,) = struct.unpack_from("<I", chunk, position)
            header = _fields(chunk[position + 4 : position + 4 + length].tobytes())
            position += 4 + length
            (length,) = struct.unpack_from("<I", chunk, position)
            data = chunk[position + 4 : position + 4 + length]
            position += 4 + length
            if position > end:
                return  # cut; it is said where the file ends
            if header[b"op"] == b"\x02":
                yield _message(header, data, connections)
            elif header[b"op"] == b"\x07":
                _announce(header, data.tobytes(), connections)
    except (struct.error, KeyError, DamageError):
        losses.append(f"{file}: {end - position} bytes at the end of a chunk of {end}")


def _message(header: Header, data: memoryview, connections: dict[int, Connection]) -> Message:
    (number,) = struct.unpack("<I", header[b"conn"])
    seconds, nanoseconds = struct.unpack("<II", header[b"time"])
    if number not in connections:
        raise DamageError("a message of a topic that is announced nowhere before it")
    return Message(connections[number], seconds * 10**9 + nanoseconds, data)


def _announce(header: Header, data: bytes, connections: dict[int, Connection]) -> None:
    about = _fields(data)
    try:
        (number,) = struct.unpack("<I", header[b"conn"])
        topic, message_type = header[b"topic"].decode(), about[b"type"].decode()
    except (KeyError, struct.error, UnicodeDecodeError) as problem:
        raise DamageError("a topic without a name or a type") from problem
    definition = about.get(b"message_definition", b"").decode(errors="replace")
    connections.setdefault(number, Connection(topic, ros2_name(message_type), "ros1", definition))


def _fields(header: bytes) -> Header:
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


def _length(stream: BinaryIO, most: int) -> int:
    length = int.from_bytes(_exactly(stream, 4), "little")
    if length > most:
        raise DamageError(f"a record of {length} bytes, expected at most {most}")
    return length


def _exactly(stream: BinaryIO, count: int) -> bytes:
    data = stream.read(count)
    if len(data) < count:
        raise DamageError("the file ends within a record")
    return data


def _next_chunk(stream: BinaryIO, begin: int) -> int | None:
    """Where the next chunk that looks whole begins; None where there is none."""
    stream.seek(begin)
    kept = b""
    while piece := stream.read(SEARCHED):
        window = kept + piece
        first = stream.tell() - len(window)
        for mark in CHUNK_MARK.finditer(window):
            for back in range(4, 64):
                start = mark.start() - back
                if start >= 0 and _is_chunk(window[start : start + 256]):
                    return first + start
        kept = window[-512:]
    return None


def _is_chunk(window: bytes) -> bool:
    """Whether the header of a chunk starts here."""
    length = int.from_bytes(window[:4], "little")
    if not 20 <= length <= 128:
        return False
    try:
        header = _fields(window[4 : 4 + length])
    except DamageError:
        return False
    return header.get(b"op") == b"\x05" and {b"compression", b"size"} <= header.keys()
