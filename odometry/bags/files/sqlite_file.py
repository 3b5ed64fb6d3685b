"""Bag files of ROS 2 in SQLite (.db3), row by row.

Rows come in the order in which they were written. Where the file is cut or damaged, rows behind
the damage are searched for as well. Source: rosbag2_storage_sqlite3, schemas 1 to 4.
"""

import sqlite3
from collections.abc import Container, Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple
from urllib.parse import quote

from odometry.bags.files.damage import ZSTD_MAGIC, Losses, decompressed
from odometry.bags.files.topic import Connection, Message, ros2_name
from odometry.errors import BagError

LEAF = 0x0D  # 1.6: a leaf of a table
LARGEST_ROW = 2**30

MAGIC = b"SQLite format 3\0"
ROWS = "SELECT id, topic_id, timestamp, data FROM messages ORDER BY id"
SCHEMAS = {"ros2msg": "msg", "ros2idl": "idl"}


class _Pages(NamedTuple):
    """An open file, the size of its pages, and how much of one is used [bytes]."""

    stream: BinaryIO
    size: int
    usable: int


class Row(NamedTuple):
    """A row of the table of messages."""

    number: int
    topic: int
    received_ns: int
    data: bytes


def rows_of_pages(file: Path, topics: Container[int]) -> Iterator[Row]:
    """Rows in the order of the pages, those of the topics alone; damaged ones are left out."""
    with file.open("rb") as stream:
        header = stream.read(100)
        page = int.from_bytes(header[16:18], "big")  # 1.3.2
        page = 65536 if page == 1 else page
        pages = _Pages(stream, page, page - header[20])  # 1.3.4
        number = 1  # the first page holds the names of tables
        while True:
            stream.seek(number * page)
            content = stream.read(page)
            if len(content) < 8:
                return
            number += 1
            if content[0] == LEAF:
                yield from _rows_of_leaf(content, pages, topics)


def _rows_of_leaf(content: bytes, pages: _Pages, topics: Container[int]) -> Iterator[Row]:
    count = int.from_bytes(content[3:5], "big")
    for place in range(8, 8 + 2 * count, 2):
        cell = int.from_bytes(content[place : place + 2], "big")
        try:
            size, begin = _number(content, cell)
            row, begin = _number(content, begin)
            found = _row(row, _payload(content, begin, size, pages))
        except (IndexError, ValueError):
            continue
        if found.topic in topics:
            yield found


def _payload(content: bytes, begin: int, size: int, pages: _Pages) -> bytes:
    """Payload of a cell, with what lies on pages of its own (1.6: X, M and K of a leaf)."""
    if size > LARGEST_ROW:
        raise ValueError("a row that is too large")
    usable = pages.usable
    most = usable - 35
    least = (usable - 12) * 32 // 255 - 23
    part = least + (size - least) % (usable - 4)
    local = size if size <= most else part if part <= most else least
    pieces, missing = [content[begin : begin + local]], size - local
    following = int.from_bytes(content[begin + local : begin + local + 4], "big")
    while missing:
        if not following:
            raise ValueError("a row that goes on nowhere")
        pages.stream.seek((following - 1) * pages.size)
        overflow = pages.stream.read(usable)
        pieces.append(overflow[4 : 4 + min(missing, usable - 4)])
        if len(pieces[-1]) < min(missing, usable - 4):
            raise ValueError("a row that is cut")
        missing -= len(pieces[-1])
        following = int.from_bytes(overflow[:4], "big")
    return b"".join(pieces)


def _row(number: int, payload: bytes) -> Row:
    """A record of four columns (2.1): an empty one for the number, two integers, a blob."""
    end, place = _number(payload, 0)
    kinds = []
    while place < end:
        kind, place = _number(payload, place)
        kinds.append(kind)
    if len(kinds) != 4 or kinds[0] != 0 or kinds[3] < 12 or kinds[3] % 2:
        raise ValueError("no row of the table of messages")
    topic, place = _integer(payload, end, kinds[1])
    received_ns, place = _integer(payload, place, kinds[2])
    length = (kinds[3] - 12) // 2
    if len(payload) < place + length:
        raise ValueError("a row that is cut")
    return Row(number, topic, received_ns, payload[place : place + length])


def _integer(payload: bytes, place: int, kind: int) -> tuple[int, int]:
    """An integer column and the place behind it, by its kind (2.1: serial type codes)."""
    if kind in (8, 9):
        return kind - 8, place
    if not 1 <= kind <= 6:
        raise ValueError("no integer")
    length = (1, 2, 3, 4, 6, 8)[kind - 1]
    return int.from_bytes(payload[place : place + length], "big", signed=True), place + length


def _number(content: bytes, place: int) -> tuple[int, int]:
    """A number of variable length (1.6: varint) and the place behind it."""
    value = 0
    for step in range(8):
        byte = content[place + step]
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, place + step + 1
    return value << 8 | content[place + 8], place + 9


def sqlite_messages(file: Path, losses: Losses) -> Iterator[Message]:
    """Messages in the order of the file; what cannot be read is added to `losses`.

    Raises
    ------
    BagError
        If the file is no SQLite file, or cannot be read as a bag.
    """
    with file.open("rb") as stream:
        if stream.read(len(MAGIC)) != MAGIC:
            raise BagError(f"{file}: no SQLite file (it starts otherwise)")
    journal = file.with_name(file.name + "-wal")
    if journal.is_file() and journal.stat().st_size:
        losses.append(
            f"{file}: the content of {journal.name} is not read; write it into the bag first: "
            f"sqlite3 {file} 'PRAGMA wal_checkpoint'"
        )
    database = sqlite3.connect(f"file:{quote(str(file.resolve()))}?mode=ro&immutable=1", uri=True)
    losses += _missing_pages(file)
    database.text_factory = _text
    try:
        database.execute("PRAGMA writable_schema = ON")  # else a file that was cut is not opened
        connections = _connections(database, file)
        for _, number, received_ns, data in _rows(database, file, connections, losses):
            stamped = isinstance(received_ns, int) and received_ns >= 0
            if number not in connections or not stamped or not isinstance(data, bytes):
                losses.append(f"{file}: a message without a topic, a stamp or data")
                continue
            packed = data.startswith(ZSTD_MAGIC)  # no message starts so by itself
            content, problem = decompressed(data, "zstd" if packed else "")
            if problem:
                losses.append(f"{file}: a message of {connections[number].topic}: {problem}")
                continue
            yield Message(connections[number], received_ns, content)
    finally:
        database.close()


def _text(content: bytes) -> str:
    return content.decode(errors="replace")


def _missing_pages(file: Path) -> Iterator[str]:
    """Whether the file is as long as its header says (https://sqlite.org/fileformat.html, 1.3)."""
    with file.open("rb") as stream:
        header = stream.read(100)
    page, pages = int.from_bytes(header[16:18], "big"), int.from_bytes(header[28:32], "big")
    expected, size = (65536 if page == 1 else page) * pages, file.stat().st_size
    if size < expected:
        yield f"{file}: it is cut off: {size} bytes are there of {expected}"


def _rows(
    database: sqlite3.Connection, file: Path, topics: Container[int], losses: Losses
) -> Iterator[Row]:
    """Rows in their order; those that SQLite does not reach are searched page by page."""
    last = 0
    try:
        for row in database.execute(ROWS):
            yield Row(*row)
            last = row[0]
    except sqlite3.Error as problem:
        found = 0
        for one in rows_of_pages(file, topics):
            if one.number > last:
                found += 1
                yield one
        losses.append(
            f"{file}: some messages after the one numbered {last}: {problem}; {found} of them were "
            "found page by page"
        )


def _connections(database: sqlite3.Connection, file: Path) -> dict[int, Connection]:
    """Topics by their numbers."""
    try:
        topics = database.execute(
            "SELECT id, name, type, serialization_format FROM topics"
        ).fetchall()
    except sqlite3.Error as problem:
        raise BagError(f"{file}: its topics cannot be read: {problem}") from problem
    definitions = _definitions(database)
    return {
        number: Connection(name, ros2_name(kind), encoding, *definitions.get(kind, ("", "msg")))
        for number, *texts in topics
        if all(isinstance(text, str) for text in texts)
        for name, kind, encoding in [texts]
    }


def _definitions(database: sqlite3.Connection) -> dict[str, tuple[str, str]]:
    """Text and language of message definitions by type; none before schema 4 (ROS 2 Iron)."""
    try:
        rows = database.execute(
            "SELECT topic_type, encoded_message_definition, encoding FROM message_definitions"
        ).fetchall()
    except sqlite3.Error:
        return {}
    return {kind: (text, SCHEMAS[code]) for kind, text, code in rows if code in SCHEMAS}
