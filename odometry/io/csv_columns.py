"""Columns of a CSV file as arrays, read block by block: numbers, names, and what else is there.

A text that a spreadsheet would compute as a formula is written with an apostrophe before it, and
read without it.
"""

import csv
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import OdometryError, RunFolderError
from odometry.io.files import opened_lines

BLOCK_ROWS = 1000  # more do not stay in the cache and take three times as long
Cells = list[tuple[str, ...]]  # of each column
Block = tuple[list[int], Cells]  # and the line of the file on which each row ends, header = 1
# with these, or their full-width forms, a spreadsheet's formula begins (OWASP, CSV injection)
FORMULA = tuple("=+-@\uff1d\uff0b\uff0d\uff20\t\r\n")


def quoted_text(text: str) -> str:
    """The text as a cell: with an apostrophe before it where it would be a formula, no number."""
    return f"'{text}" if _begins_as_formula(text) and not _is_number(text) else text


def unquoted_text(cell: str) -> str:
    """The text of a cell, without the apostrophe of `quoted_text`."""
    return cell[1:] if cell.startswith("'") and _begins_as_formula(cell) else cell


@contextmanager
def opened_csv(
    file: Path,
    error: type[OdometryError],
    separator: str = ",",
    before: int = 0,
    names: Sequence[str] = (),
) -> Iterator[tuple[list[str], Iterator[Block]]]:
    """Open a CSV file: its header, and its rows in blocks; blank lines are left out.

    Parameters
    ----------
    file : Path
        UTF-8, one header line.
    error : child of OdometryError
        What is raised.
    separator : str
        Between cells.
    before : int
        Lines above the header, which are left out.
    names : sequence of str
        Of the columns of a file without a header.

    Raises
    ------
    OdometryError
        Of the kind `error`, naming file and row: as `opened_lines`, a quote that does
        not end, a column named twice, or a row of another length than the header.
    """
    with opened_lines(file, error) as lines:
        rows = _rows(islice(lines, before, None), file, error, separator, before)
        _, header = (1, list(names)) if names else next(rows, (1, []))
        header = [unquoted_text(name.strip()) for name in header]
        repeated = sorted({name for name in header if header.count(name) > 1})
        if repeated:
            raise error(f"{file}: row 1: the column {repeated[0]!r} is there twice")
        yield header, _blocks(rows, len(header), file, error)


def _rows(
    lines: Iterator[str], file: Path, error: type[OdometryError], separator: str, before: int
) -> Iterator[tuple[int, list[str]]]:
    reader = csv.reader(lines, strict=True, delimiter=separator)
    try:
        for row in reader:
            yield before + reader.line_num, row
    except csv.Error as problem:
        row_number = before + reader.line_num
        raise error(f"{file}: row {row_number}: cannot be read as CSV: {problem}") from problem


def _blocks(
    rows: Iterator[tuple[int, list[str]]], width: int, file: Path, error: type[OdometryError]
) -> Iterator[Block]:
    filled = ((line, row) for line, row in rows if row)
    while block := list(islice(filled, BLOCK_ROWS)):
        for line, row in block:
            if len(row) != width:
                raise error(
                    f"{file}: row {line}: {len(row)} cells, but the header has {width} columns"
                )
        yield [line for line, _ in block], list(zip(*(row for _, row in block), strict=True))


def _begins_as_formula(text: str) -> bool:
    """Behind apostrophes too, so that a text which has its own is read as it was."""
    return text.lstrip("'").startswith(FORMULA)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


NAME_COLUMNS = frozenset({"file", "terrain"})
NUMBER_COLUMNS = frozenset(
    [
        "t",
        "v_left",
        "v_right",
        "roll",
        "pitch",
        "gyro_x",
        "gyro_y",
        "gyro_z",
        "accel_x",
        "accel_y",
        "accel_z",
        "current_left",
        "current_right",
        "x",
        "y",
        "yaw",
        "z",
        "window",
        "vx",
        "vy",
        "wz",
        "y_left",
        "y_right",
        "x_icr",
    ]
)
LARGEST = 1e6  # of speeds, angles and the like, in any unit that was meant
LARGEST_BY_NAME = {
    "t": 1e19,  # nanoseconds since 1970 are 1.8e18
    "x": 1e11,  # UTM in millimetres is 1e10
    "y": 1e11,
    "z": 1e11,
    "window": 1e12,
}
LONGEST_NAME = 1000  # characters; an array of names has room for the longest in every row


def numbers(
    cells: Sequence[str],
    file: Path,
    lines: Sequence[int],
    name: str,
    *,
    may_miss: bool,
    largest: float | None = None,
) -> FloatArray:
    """Numbers (N,) of the cells of one column; an empty one is NaN where it `may_miss`.

    The largest that is accepted is that of the column's name where `largest` is None.

    Raises
    ------
    RunFolderError
        Naming file, row and column of the first cell that is no finite number, or one too large.
    """
    try:
        values = np.fromiter(map(float, cells), np.float64, len(cells))
    except ValueError:
        values = np.array(
            [_number(cell, file, row, name) for cell, row in zip(cells, lines, strict=True)]
        )
    if largest is None:
        largest = LARGEST_BY_NAME.get(name, LARGEST)
    wrong = ~(np.abs(values) <= largest) & ~(may_miss & np.isnan(values))
    if wrong.any():
        first = int(np.argmax(wrong))
        size = "" if not math.isfinite(values[first]) else f", at most {largest:g} in size"
        raise RunFolderError(
            f"{file}: row {lines[first]}, column {name!r}: {cells[first].strip()!r}, "
            f"expected a finite number{size}"
        )
    return values


def names(cells: Sequence[str], file: Path, lines: Sequence[int], name: str) -> AnyArray:
    """Names (N,) of str, without spaces around them; RunFolderError where one is too long."""
    stripped = [unquoted_text(cell.strip()) for cell in cells]
    for cell, line in zip(stripped, lines, strict=True):
        if len(cell) > LONGEST_NAME:
            raise RunFolderError(
                f"{file}: row {line}, column {name!r}: {len(cell)} characters, "
                f"expected at most {LONGEST_NAME}"
            )
    return np.array(stripped)


def numbers_or_names(texts: AnyArray) -> AnyArray:
    """Numbers (N,) where all texts (N,) are one or empty, else the texts."""
    try:
        return np.array([float(text) if text else math.nan for text in texts.tolist()])
    except ValueError:
        return texts


def _number(cell: str, file: Path, line: int, name: str) -> float:
    text = cell.strip()
    try:
        return float(text) if text else math.nan
    except ValueError:
        raise RunFolderError(
            f"{file}: row {line}, column {name!r}: {text!r} is not a number"
        ) from None
