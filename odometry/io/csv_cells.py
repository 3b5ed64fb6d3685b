"""The cells of a CSV file, block by block: a long file needs no more memory than its numbers.

A text that a spreadsheet would compute as a formula is written with an apostrophe before it, and
read without it.
"""

import csv
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path

from odometry.errors import OdometryError
from odometry.io.input_file import opened_lines

BLOCK_ROWS = 1000  # more do not stay in the cache and take three times as long
Cells = list[tuple[str, ...]]  # of each column
Block = tuple[list[int], Cells]  # and the line of the file on which each row ends, header = 1
FORMULA = ("=", "+", "-", "@", "\t", "\r")  # with these a spreadsheet's formula begins


def quoted_text(text: str) -> str:
    """The text as a cell: with an apostrophe before it where it would be a formula, no number."""
    return f"'{text}" if _begins_as_formula(text) and not _is_number(text) else text


def unquoted_text(cell: str) -> str:
    """The text of a cell, without the apostrophe of `quoted_text`."""
    return cell[1:] if cell.startswith("'") and _begins_as_formula(cell) else cell


@contextmanager
def opened_csv(
    file: Path, error: type[OdometryError]
) -> Iterator[tuple[list[str], Iterator[Block]]]:
    """Open a CSV file: its header, and its rows in blocks; blank lines are left out.

    Parameters
    ----------
    file : Path
        Comma separated, UTF-8, one header line.
    error : child of OdometryError
        What is raised.

    Raises
    ------
    OdometryError
        Of the kind `error`, naming file and row: as `opened_lines`, a quote that does
        not end, a column named twice, or a row of another length than the header.
    """
    with opened_lines(file, error) as lines:
        rows = _rows(lines, file, error)
        _, header = next(rows, (1, []))
        header = [unquoted_text(name.strip()) for name in header]
        repeated = sorted({name for name in header if header.count(name) > 1})
        if repeated:
            raise error(f"{file}: row 1: the column {repeated[0]!r} is there twice")
        yield header, _blocks(rows, len(header), file, error)


def _rows(
    lines: Iterator[str], file: Path, error: type[OdometryError]
) -> Iterator[tuple[int, list[str]]]:
    reader = csv.reader(lines, strict=True)
    try:
        for row in reader:
            yield reader.line_num, row
    except csv.Error as problem:
        raise error(f"{file}: row {reader.line_num}: cannot be read as CSV: {problem}") from problem


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
