"""MCAP files, read from front to back: no index and no summary are needed.

The index at the end of a file is never used, so that a file that was cut off is read as any other;
where the end is there, topics are known even if their first announcement is damaged. Source:
https://mcap.dev/spec.
"""

import re
import struct
import zlib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, NamedTuple

from odometry.bags.files.damage import Losses, decompressed, windows
from odometry.bags.files.topic import Connection, Message, ros2_name
from odometry.errors import BagError

MAGIC = b"\x89MCAP0\r\n"
SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 0x03, 0x04, 0x05, 0x06, 0x0F
FOOTER, FOOTER_BYTES = 0x02, 37  # with the magic bytes behind it
RECORD = struct.Struct("<BQ")
MESSAGE_HEAD = struct.Struct("<HIQQ")  # channel, sequence, received, published
HEAD_BYTES = MESSAGE_HEAD.size
LATEST_NS = 2**63 - 1
CHUNK_HEAD = struct.Struct("<QQQI")  # first and last stamp, size and CRC of the content
LARGEST_RECORD = 2**31
CHUNK_MARK = re.compile(
    rb"\x06(?=.{4}\x00{4}.{28}(?:\x00{4}|\x04\x00{3}zstd|\x03\x00{3}lz4))", re.DOTALL
)
MARK_BYTES = 64  # more than CHUNK_MARK and a chunk's head
SCHEMAS = {"ros2msg": "msg", "ros1msg": "msg", "ros2idl": "idl", "omgidl": "idl"}


class _Schema(NamedTuple):
    name: str
    language: str
    text: str


class _Announced(NamedTuple):
    """What the records so far say of topics, by their numbers."""

    schemas: dict[int, _Schema]
    channels: dict[int, Connection]
    connections: dict[Connection, Connection]  # each once, however often it is announced


def mcap_messages(file: Path, losses: Losses) -> Iterator[Message]:
    """Messages in the order of the file; what cannot be read is added to `losses`.

    Raises
    ------
    BagError
        If the file is no MCAP file.
    """
    announced = _Announced({}, {}, {})
    size = file.stat().st_size
    with file.open("rb") as stream:
        if stream.read(len(MAGIC)) != MAGIC:
            raise BagError(f"{file}: no MCAP file (it starts otherwise)")
        _announce_all(stream, size, announced)
        stream.seek(len(MAGIC))
        while True:
            begin = stream.tell()
            head = stream.read(RECORD.size)
            if len(head) < RECORD.size:
                losses.append(f"{file}: it is cut off after {size} bytes: its end is missing")
                return
            kind, length = RECORD.unpack(head)
            if kind == DATA_END:
                return
            if not _plausible(kind, length, size - stream.tell()):
                found = _next_chunk(stream, begin + 1, size)
                losses.append(
                    f"{file}: {(found or size) - begin} bytes from byte {begin} on are no records"
                )
                if found is None:
                    return
                stream.seek(found)
                continue
            yield from _record(kind, stream.read(length), announced, file, losses)


def _announce_all(stream: BinaryIO, size: int, announced: _Announced) -> None:
    """Take in the topics as the end of the file announces them again, where it is there."""
    stream.seek(max(0, size - FOOTER_BYTES))
    footer = stream.read()
    if not footer.endswith(MAGIC) or footer[0] != FOOTER:
        return
    (summary,) = struct.unpack_from("<Q", footer, RECORD.size)
    stream.seek(summary or size)
    with suppress(struct.error, UnicodeDecodeError):
        while True:
            kind, length = RECORD.unpack(stream.read(RECORD.size))
            if kind not in (SCHEMA, CHANNEL) or length > size:
                return
            _announce(kind, memoryview(stream.read(length)), announced)


def _plausible(kind: int, length: int, left: int) -> bool:
    """Whether a record may have this head; a chunk may be longer than what is left of a file."""
    return kind > 0 and length <= LARGEST_RECORD and (length <= left or kind in (CHUNK, MESSAGE))


def _record(
    kind: int, data: bytes, announced: _Announced, file: Path, losses: Losses
) -> Iterator[Message]:
    if kind != CHUNK:
        records: Iterator[tuple[int, memoryview]] = iter([(kind, memoryview(data))])
    else:
        content, problem = _content(data)
        if problem:
            losses.append(f"{file}: a part of a chunk of {len(data)} bytes: {problem}")
        records = _inside(content, file, losses, whole=not problem)
    for inner, record in records:
        try:
            if inner == MESSAGE:
                number, _, received_ns, _ = MESSAGE_HEAD.unpack_from(record)
                connection = announced.channels[number]
                if received_ns <= LATEST_NS:
                    yield Message(connection, received_ns, record[HEAD_BYTES:])
                else:
                    losses.append(f"{file}: a message of {connection.topic} with no true stamp")
            elif inner in (SCHEMA, CHANNEL):
                _announce(inner, record, announced)
        except (struct.error, UnicodeDecodeError, KeyError):
            losses.append(f"{file}: a record of {len(record)} bytes that is not as the format says")


def _inside(
    content: bytes, file: Path, losses: Losses, *, whole: bool
) -> Iterator[tuple[int, memoryview]]:
    """Records of a chunk, kind and content, up to where it is cut or, said here, damaged."""
    view, position, end = memoryview(content), 0, len(content)
    while position + RECORD.size <= end:
        kind, length = RECORD.unpack_from(view, position)
        position += RECORD.size
        if kind == 0 or length > end - position:
            if whole:
                losses.append(f"{file}: {end - position} bytes at the end of a chunk of {end}")
            return
        yield kind, view[position : position + length]
        position += length


def _content(chunk: bytes) -> tuple[bytes, str]:
    """What a chunk holds, and what is wrong with it; nothing where its sum is another."""
    try:
        _, _, size, crc = CHUNK_HEAD.unpack_from(chunk)
        (length,) = struct.unpack_from("<I", chunk, CHUNK_HEAD.size)
        begin = CHUNK_HEAD.size + 4 + length
        compression = chunk[CHUNK_HEAD.size + 4 : begin].decode()
        (length,) = struct.unpack_from("<Q", chunk, begin)
    except (struct.error, UnicodeDecodeError):
        return b"", "its head is not as the format says"
    if size > LARGEST_RECORD:
        return b"", f"it says that it holds {size} bytes"
    content, problem = decompressed(chunk[begin + 8 : begin + 8 + length], compression)
    if problem or len(content) < size:
        return content, problem or "its end is missing"
    if crc and zlib.crc32(content) != crc:
        return b"", "its bytes are not those that were written (the check sum differs)"
    return content, ""


def _announce(kind: int, record: memoryview, announced: _Announced) -> None:
    (number,) = struct.unpack_from("<H", record)
    if kind == SCHEMA:
        name, language, text = _strings(record, 2, 3)
        announced.schemas[number] = _Schema(name, language, text)
        return
    (schema_number,) = struct.unpack_from("<H", record, 2)
    topic, encoding = _strings(record, 4, 2)
    schema = announced.schemas.get(schema_number, _Schema("", "", ""))
    known = schema.language in SCHEMAS
    text = schema.text if known else ""
    language = SCHEMAS.get(schema.language, "msg")
    found = Connection(topic, ros2_name(schema.name), encoding, text, language)
    announced.channels[number] = announced.connections.setdefault(found, found)


def _strings(record: memoryview, begin: int, count: int) -> list[str]:
    strings = []
    for _ in range(count):
        (length,) = struct.unpack_from("<I", record, begin)
        if begin + 4 + length > len(record):
            raise struct.error("a text that is longer than its record")
        strings.append(record[begin + 4 : begin + 4 + length].tobytes().decode())
        begin += 4 + length
    return strings


def _next_chunk(stream: BinaryIO, begin: int, size: int) -> int | None:
    """Start of the next chunk that seems complete; None where there is none."""
    for first, window in windows(stream, begin, MARK_BYTES):
        for mark in CHUNK_MARK.finditer(window):
            start = first + mark.start()
            _, length = RECORD.unpack_from(window, mark.start())
            begin_ns, end_ns, *_ = CHUNK_HEAD.unpack_from(window, mark.start() + RECORD.size)
            if start + RECORD.size + length <= size and begin_ns <= end_ns:
                return start
    return None
