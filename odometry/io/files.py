"""Files: input read within bounds of size, output whole or absent."""

import errno
import io
import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, TextIO

from odometry.errors import OdometryError, OutputError

TABLE_BYTES = 4 * 1024**3  # ten million rows of a dozen columns have about 1.5 GB
LINE_CHARACTERS = 65536  # a row of numbers has a few hundred

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # disk, quota, or a file of the largest size
NOT_WRITTEN = (*FULL, errno.EIO, errno.EROFS)  # or a disk that fails or may not be written to


@contextmanager
def opened(file: Path, error: type[OdometryError], most_bytes: int, why: str) -> Iterator[BinaryIO]:
    """Open a regular file for reading; pipes and devices, which may never end, are not opened.

    Parameters
    ----------
    file : Path
    error : child of OdometryError
        What is raised.
    most_bytes : int
        A larger file is refused.
    why : str
        What such a file usually has, for the message.

    Raises
    ------
    OdometryError
        Of the kind `error`, naming the file: missing, no regular file, or too large.
    """
    _check_regular(file, error, most_bytes, why)
    try:
        with Path(file).open("rb") as stream:
            yield stream
    except OSError as problem:
        raise error(f"{file}: cannot be read: {problem.strerror or problem}") from problem


def read_bytes(file: Path, error: type[OdometryError], most_bytes: int, why: str) -> bytes:
    """The content of a file; raises as `opened`."""
    with opened(file, error, most_bytes, why) as stream:
        size = os.fstat(stream.fileno()).st_size  # reading more would allocate more
        return stream.read(min(size, most_bytes))


@contextmanager
def opened_lines(file: Path, error: type[OdometryError]) -> Iterator[Iterator[str]]:
    """Open a table as text: its lines, ends included; a byte order mark is left out.

    Raises
    ------
    OdometryError
        Of the kind `error`, naming file and row: as `opened`, bytes that are not UTF-8 text, or a
        line of LINE_CHARACTERS or more.
    """
    with (
        opened(file, error, TABLE_BYTES, "ten million rows have about 1.5e9") as stream,
        io.TextIOWrapper(stream, encoding="utf-8-sig", newline="") as text,
    ):
        yield _lines(text, file, error)


def _lines(text: TextIO, file: Path, error: type[OdometryError]) -> Iterator[str]:
    row = 0
    try:
        while line := text.readline(LINE_CHARACTERS):
            row += 1
            if len(line) == LINE_CHARACTERS:
                raise error(
                    f"{file}: row {row} has {LINE_CHARACTERS} characters or more; is it a table?"
                )
            if "\0" in line:
                raise error(f"{file}: row {row} holds a NUL byte; expected text")
            yield line
    except UnicodeDecodeError as problem:
        byte = problem.object[problem.start]
        raise error(
            f"{file}: cannot be read as utf-8 text: byte {byte:#04x} below row {row}"
        ) from problem


def _check_regular(file: Path, error: type[OdometryError], most_bytes: int, why: str) -> None:
    try:
        status = Path(file).stat()
    except OSError as problem:
        raise error(f"{file}: cannot be read: {problem.strerror or problem}") from problem
    except ValueError as problem:  # a NUL in the name
        raise error(f"{str(file)!r}: cannot be read: {problem}") from problem
    if not stat.S_ISREG(status.st_mode):
        raise error(f"{file}: {_kind(status.st_mode)}, expected a regular file")
    if status.st_size > most_bytes:
        raise error(f"{file}: {status.st_size} bytes, expected at most {most_bytes}: {why}")


def _kind(mode: int) -> str:
    for is_kind, word in (
        (stat.S_ISDIR, "a folder"),
        (stat.S_ISFIFO, "a pipe"),
        (stat.S_ISCHR, "a device"),
        (stat.S_ISBLK, "a device"),
    ):
        if is_kind(mode):
            return word
    return "a socket or the like"


def leads_out(folder: Path, name: str) -> bool:
    """Whether `folder / name` lies outside of the folder, by `..` or by symbolic links.

    The folder itself may be reached through a symbolic link.
    """
    return not Path(os.path.realpath(folder / name)).is_relative_to(os.path.realpath(folder))


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """Give a temporary path beside `path`; rename it to `path` if the block succeeds.

    Parameters
    ----------
    path : Path
        The file to be made. Its folder is made if it is missing.

    Yields
    ------
    Path
        Where to write. It keeps the suffix of `path`, so that libraries which choose a
        format by suffix work. It is removed if the block raises.

    Raises
    ------
    OutputError
        Naming `path`, if the disk is full or fails while it is written.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield temporary
        temporary.replace(path)
    except OSError as error:
        if error.errno not in NOT_WRITTEN:
            raise
        raise OutputError(f"cannot write {path}: {error.strerror}") from error
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def naming_full(place: Path) -> Iterator[None]:
    """Name in the message the file that does not fit, or `place` where the error names none.

    Raises
    ------
    OutputError
        If the disk is full, or the largest size of a file is reached.
    """
    try:
        yield
    except OSError as error:
        if error.errno not in FULL:
            raise
        file = error.filename or place
        raise OutputError(f"cannot write to {file}: {error.strerror}") from error


@contextmanager
def naming_temporary() -> Iterator[None]:
    """`naming_full` of the folder of temporary files, which may lie on another disk.

    Raises
    ------
    OutputError
        As `naming_full`.
    """
    folder = tempfile.gettempdir()
    try:
        with naming_full(Path(folder)):
            yield
    except OutputError as error:
        raise OutputError(
            f"{error} (temporary files; set TMPDIR to a folder with more room)"
        ) from error


def check_writable(folder: Path) -> None:
    """Find out before long work, and without making anything, whether a folder can be made.

    Raises
    ------
    OutputError
        If a part of the path is not a folder, or is one that may not be written to.
    """
    there = next(path for path in (folder, *folder.resolve().parents) if path.exists())
    if not there.is_dir():
        raise OutputError(f"cannot write to {folder}: {there} is not a folder")
    if not os.access(there, os.W_OK | os.X_OK):
        raise OutputError(f"cannot write to {folder}: {there} may not be written to")
