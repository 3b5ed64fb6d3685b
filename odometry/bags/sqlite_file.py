"""Bag files of ROS 2 in SQLite (.db3), row by row.

Rows come in the order in which they were written. Where the file is cut or damaged, rows behind
the damage are searched for as well. Source: rosbag2_storage_sqlite3, schemas 1 to 4.
"""

import sqlite3
from collections.abc import Container, Iterator
from pathlib import Path
from urllib.parse import quote

from odometry.bags.damage import ZSTD_MAGIC, Losses, decompressed
from odometry.bags.sqlite_pages import Row, rows_of_pages
from odometry.bags.topic import Connection, Message, ros2_name
from odometry.errors import BagError

MAGIC = b"SQLite format 3\0"
ROWS = "SELECT id, topic_id, timestamp, data FROM messages ORDER BY id"
SCHEMAS = {"ros2msg": "msg", "ros2idl": "idl"}


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
