"""The files that make up bags."""

import re
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from odometry.bags.files.damage import ZSTD_MAGIC, Losses, zstd_package
from odometry.bags.files.mcap_file import MAGIC as MCAP_MAGIC
from odometry.bags.files.mcap_file import mcap_messages
from odometry.bags.files.ros1_file import MAGIC as ROS1_MAGIC
from odometry.bags.files.ros1_file import ros1_messages
from odometry.bags.files.sqlite_file import MAGIC as SQLITE_MAGIC
from odometry.bags.files.sqlite_file import sqlite_messages
from odometry.bags.files.topic import Message
from odometry.errors import BagError
from odometry.io.files import naming_temporary

KINDS = {ROS1_MAGIC: "ros1", MCAP_MAGIC: "mcap", SQLITE_MAGIC: "sqlite3"}
ARCHIVES = {
    b"PK\x03\x04": "zip",
    b"\x1f\x8b": "gzip",
    b"BZh": "bzip2",
    b"\xfd7zXZ": "xz",
    b"7z\xbc\xaf": "7z",
    b"Rar!": "rar",
}
LONGEST_MAGIC = max(map(len, KINDS))
SUFFIXES = re.compile(r".*\.(?:bag|bag\.active|mcap|db3)(?:\.zstd|\.zst)?$", re.IGNORECASE)
TABLES = (".csv", ".tsv", ".txt", ".log")
OF_TABLES = (
    "A log of lines of numbers needs no import: rename its columns as in data/README.md (Run "
    "folder), and check names what is left to convert. Latitude and longitude become its "
    "positions: terrain-odometry import RUN --pose FILE"
)
LISTED = re.compile(
    r"^\s*- (?:path: )?[\"']?([^\s:\"']+\.(?:mcap|db3)(?:\.zstd)?)[\"']?\s*$", re.MULTILINE
)
METADATA_BYTES = 64 * 1024**2


@dataclass(frozen=True)
class BagFile:
    """One file of a bag.

    Attributes
    ----------
    path : Path
    kind : str
        "ros1", "mcap" or "sqlite3".
    compressed : bool
        Whether the whole file is compressed by zstd.
    """

    path: Path
    kind: str
    compressed: bool = False

    def messages(self, losses: Losses) -> Iterator[Message]:
        """Messages in the order of the file; what cannot be read is added to `losses`."""
        if not self.compressed:
            yield from _READERS[self.kind](self.path, losses)
            return
        zstd = zstd_package()
        with tempfile.TemporaryDirectory() as folder:
            plain = Path(folder) / self.path.stem
            try:
                with (
                    naming_temporary(),
                    zstd.open(self.path, "rb") as packed,
                    plain.open("wb") as unpacked,
                ):
                    shutil.copyfileobj(packed, unpacked, 1024**2)
            except (zstd.ZstdError, EOFError) as problem:
                losses.append(f"{self.path}: cannot be decompressed to its end: {problem}")
            yield from _READERS[self.kind](plain, losses)


_READERS = {"ros1": ros1_messages, "mcap": mcap_messages, "sqlite3": sqlite_messages}


def bag_files(paths: Sequence[Path], losses: Losses) -> list[BagFile]:
    """Files of bags, each a file or a folder of ROS 2, with or without metadata.yaml.

    Parameters
    ----------
    paths : of Path
        Several are taken as one recording.
    losses : Losses
        What cannot be read is added: files that are missing, empty or no bag.

    Raises
    ------
    BagError
        If a path is missing, or nothing of all of them is a bag.
    """
    found: list[BagFile] = []
    for path in dict.fromkeys(paths):
        if not path.exists():
            raise BagError(f"{path}: there is no such file or folder")
        for file in _in_folder(path, losses) if path.is_dir() else [path]:
            one = _bag_file(file, losses)
            if one is not None and one not in found:
                found.append(one)
    if not found:
        reason = f": {losses.lines[0]}" if losses.lines else ""
        raise BagError(f"{', '.join(map(str, paths))}: there is nothing to read{reason}")
    return found


def is_bag(path: Path) -> bool:
    """Whether a path may be a bag: a file that starts as one, or a folder that holds such files."""
    if path.is_dir():
        return any(map(is_bag, _named_as_bags(path)))
    try:
        return _kind(path)[0] != "" or bool(SUFFIXES.match(path.name) and path.is_file())
    except OSError:
        return False


def _in_folder(folder: Path, losses: Losses) -> list[Path]:
    files = _named_as_bags(folder)
    metadata = folder / "metadata.yaml"
    if metadata.is_file() and metadata.stat().st_size <= METADATA_BYTES:
        text = metadata.read_text(encoding="utf-8", errors="replace")
        there = {file.name for file in files}
        listed = dict.fromkeys(Path(name).name for name in LISTED.findall(text))
        losses += [
            f"{folder / name}: it is missing, and metadata.yaml lists it"
            for name in listed
            if name not in there
        ]
    if not files:
        words = f"{folder}: there is no .bag, .mcap or .db3 file in it"
        tables = any(file.suffix.lower() in TABLES for file in folder.iterdir())
        losses.append(f"{words}. {OF_TABLES}" if tables else words)
    return files


def _named_as_bags(folder: Path) -> list[Path]:
    """Files of a folder that are named as bags; a survey finds the order of their messages."""
    return sorted(file for file in folder.iterdir() if SUFFIXES.match(file.name) and file.is_file())


def _bag_file(file: Path, losses: Losses) -> BagFile | None:
    """What a file is; None, and a loss, where it is no bag."""
    try:
        if file.stat().st_size == 0:
            losses.append(f"{file}: the file is empty")
            return None
        kind, compressed = _kind(file)
    except OSError as problem:
        losses.append(f"{file}: cannot be read: {problem.strerror or problem}")
        return None
    if not kind:
        losses.append(f"{file}: {_no_bag(file)}")
        return None
    return BagFile(file, kind, compressed)


def _no_bag(file: Path) -> str:
    """What a file is that does not begin as a bag."""
    with file.open("rb") as stream:
        start = stream.read(512)
    packed = next((name for magic, name in ARCHIVES.items() if start.startswith(magic)), "")
    if start[257:262] == b"ustar":
        packed = "tar"
    if packed:
        return f"this is an archive ({packed}): unpack it, and import the bag that is in it"
    words = "this is no bag (neither ROS 1, nor MCAP, nor SQLite)"
    return f"{words}. {OF_TABLES}" if file.suffix.lower() in TABLES else words


def _kind(file: Path) -> tuple[str, bool]:
    """Kind of a file by its first bytes, empty where it is no bag; whether it is compressed."""
    with file.open("rb") as stream:
        start = stream.read(LONGEST_MAGIC)
    compressed = start.startswith(ZSTD_MAGIC)
    if compressed:
        zstd = zstd_package()
        try:
            with zstd.open(file, "rb") as packed:
                start = packed.read(LONGEST_MAGIC)
        except (zstd.ZstdError, EOFError):
            return "", True
    kinds = (kind for magic, kind in KINDS.items() if start.startswith(magic))
    return next(kinds, ""), compressed
