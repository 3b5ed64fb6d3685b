"""Text of one row of numbers a line, as trajectory files have them; errors name row and column."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.io.files import opened_lines

BLOCK_ROWS = 1000
Words = list[tuple[int, list[str]]]  # row of the file, and its words


@dataclass(frozen=True)
class Column:
    """One column: its name, its largest size, and how a word of it becomes a number."""

    name: str
    largest: float
    parse: Callable[[str], float] = float


def read_rows(
    file: Path, columns: tuple[Column, ...], separator: str | None = None, *, more: bool = False
) -> tuple[IntArray, FloatArray]:
    """Read the rows of a file; empty lines and those that start with # are left out.

    Parameters
    ----------
    file : Path
    columns : tuple of Column
        In the order of the file.
    separator : str, optional
        Between numbers; white space where None.
    more : bool
        Whether rows may have further columns, which are left out.

    Returns
    -------
    (N,), (N, C)
        Row of the file, and numbers, of each row.

    Raises
    ------
    TrajectoryError
        If the file cannot be read or has no such row; naming row and column where there are not
        as many numbers, or one that is not finite or too large.
    """
    with opened_lines(file, TrajectoryError) as texts:
        words = (
            (row, text.strip().split(separator))
            for row, text in enumerate(texts, 1)
            if _has_values(text)
        )
        parts = list(_parts(words, columns, file, more=more))
    if not parts:
        raise TrajectoryError(f"{file}: there is no pose in it")
    rows, table = (np.concatenate(part) for part in zip(*parts, strict=True))
    return rows, table


def require_increasing(stamps_s: FloatArray, rows: IntArray, file: Path) -> None:
    """Raise TrajectoryError, naming the row, unless stamps (N,) increase strictly."""
    back = np.flatnonzero(np.diff(stamps_s) <= 0)
    if back.size:
        before, after = float(stamps_s[back[0]]), float(stamps_s[back[0] + 1])
        raise TrajectoryError(
            f"{file}: row {rows[back[0] + 1]}: stamp {after!r} after {before!r}; stamps must "
            "increase strictly"
        )


def _has_values(text: str) -> bool:
    return bool(text.strip()) and not text.startswith("#")


def _parts(
    words: Iterator[tuple[int, list[str]]],
    columns: tuple[Column, ...],
    file: Path,
    *,
    more: bool,
) -> Iterator[tuple[IntArray, FloatArray]]:
    while block := list(islice(words, BLOCK_ROWS)):
        for row, of_row in block:
            if len(of_row) < len(columns) or (len(of_row) > len(columns) and not more):
                names = " ".join(column.name for column in columns)
                raise TrajectoryError(
                    f"{file}: row {row}: {len(of_row)} numbers, expected {len(columns)}: {names}"
                )
        yield np.array([row for row, _ in block]), _numbers(block, columns, file)


def _numbers(block: Words, columns: tuple[Column, ...], file: Path) -> FloatArray:
    """Numbers (N, C) of a block of rows, checked."""
    parses = [column.parse for column in columns]
    try:
        table = np.array(
            [
                [parse(word) for parse, word in zip(parses, words, strict=False)]
                for _, words in block
            ],
            dtype=np.float64,
        )
    except ValueError:
        _refuse_words(block, columns, file)
        raise
    wrong = ~(np.abs(table) <= [column.largest for column in columns])
    if wrong.any():
        first, place = np.argwhere(wrong)[0]
        row, words = block[first]
        raise TrajectoryError(
            f"{file}: row {row}, {columns[place].name}: {words[place]!r}, expected a finite "
            f"number, at most {columns[place].largest:g} in size"
        )
    return table


def _refuse_words(block: Words, columns: tuple[Column, ...], file: Path) -> None:
    for row, words in block:
        for column, word in zip(columns, words, strict=False):
            try:
                column.parse(word)
            except ValueError:
                raise TrajectoryError(
                    f"{file}: row {row}, {column.name}: {word!r} is not a number"
                ) from None


LENGTH_TOLERANCE = 0.01  # of a quaternion: files with three digits pass, mixed columns rarely do


def poses_of(
    positions_m: FloatArray, quaternions_wxyz: FloatArray, rows: IntArray, file: Path
) -> FloatArray:
    """Poses (N, 4, 4) of positions (N, 3) and quaternions (N, 4) that stand in rows (N,) of a file.

    Quaternions that are all zero are of a program that has positions alone: no rotation.

    Raises
    ------
    TrajectoryError
        Naming the row, if a quaternion is not of length 1.
    """
    if not quaternions_wxyz.any():
        quaternions_wxyz = np.tile([1.0, 0.0, 0.0, 0.0], (len(rows), 1))
    lengths = np.linalg.norm(quaternions_wxyz, axis=1)
    off = np.flatnonzero(np.abs(lengths - 1) > LENGTH_TOLERANCE)
    if off.size:
        raise TrajectoryError(
            f"{file}: row {rows[off[0]]}: a quaternion of length {lengths[off[0]]:.6g}, expected 1"
        )
    return se3.pose(positions_m, se3.rotation_from_quaternion_wxyz(quaternions_wxyz))
