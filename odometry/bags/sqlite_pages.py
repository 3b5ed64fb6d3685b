"""Rows of the table of messages straight from the pages of a damaged SQLite file.

SQLite finds rows by a tree, whose branches lie anywhere in the file: where one is gone, so are
all rows below it. The leaves hold the rows whole, and are known by their first byte. Sections of
https://sqlite.org/fileformat.html are cited beside lines.
"""

from collections.abc import Container, Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

LEAF = 0x0D  # 1.6: a leaf of a table
LARGEST_ROW = 2**30


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
