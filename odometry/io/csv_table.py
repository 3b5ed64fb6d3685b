"""Read and write one CSV file of a run folder, with errors that name row and column."""

import csv
import math
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray
from odometry.errors import RunFolderError
from odometry.io.csv_columns import (
    NAME_COLUMNS,
    NUMBER_COLUMNS,
    Cells,
    names,
    numbers,
    numbers_or_names,
    opened_csv,
    quoted_text,
)
from odometry.io.files import atomic_write
from odometry.table import Table

ROWS = 4096  # whose cells are texts at a time


def read_csv_table(file: Path, required: Iterable[str], complete: Iterable[str] = ()) -> Table:
    """Read a CSV file whose columns are found by name, in any order.

    A row that repeats the stamp of the row before it is dropped; `Table.repeated_lines` has it.

    Parameters
    ----------
    file : Path
        Comma separated, UTF-8, one header line.
    required : names of columns
        Must be there.
    complete : names of columns
        Must have a finite number in every row; elsewhere an empty cell or `nan` is NaN.

    Raises
    ------
    RunFolderError
        Naming file, row (the line of the file, header = 1) and column.
    """
    complete = frozenset(complete)
    parts: list[dict[str, AnyArray]] = []
    lines: list[AnyArray] = []
    with opened_csv(file, RunFolderError) as (header, blocks):
        for name in required:
            if name not in header:
                raise RunFolderError(
                    f"{file}: the column {name!r} is missing; the header has {', '.join(header)}"
                )
        for block_lines, cells in blocks:
            parts.append(_block_columns(header, cells, file, block_lines, complete))
            lines.append(np.array(block_lines))
    if not parts:
        raise RunFolderError(f"{file}: there are no rows below the header")
    columns = {name: _whole(name, [part.pop(name) for part in parts]) for name in header}
    all_lines = np.concatenate(lines)
    _check_not_back(columns["t"], file, all_lines)
    repeated = np.diff(columns["t"], prepend=-math.inf) == 0
    if repeated.any():
        columns = {name: column[~repeated] for name, column in columns.items()}
    return Table(file, columns, all_lines[~repeated], all_lines[repeated])


def write_csv_table(file: Path, columns: Mapping[str, AnyArray], decimals: int = 9) -> None:
    """Write columns of equal length as CSV; NaN becomes an empty cell, a formula a text."""
    arrays = [np.asarray(column) for column in columns.values()]
    lengths = {name: len(array) for name, array in zip(columns, arrays, strict=True)}
    if len(set(lengths.values())) != 1:
        raise RunFolderError(f"{file}: the columns differ in length: {lengths}")
    with atomic_write(file) as part, part.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(map(quoted_text, columns))
        for start in range(0, max(lengths.values(), default=0), ROWS):
            cells = [_format(array[start : start + ROWS], decimals) for array in arrays]
            writer.writerows(zip(*cells, strict=True))


def _block_columns(
    header: list[str], cells: Cells, file: Path, lines: list[int], complete: frozenset[str]
) -> dict[str, AnyArray]:
    """Numbers of the columns that are known to hold them, texts of the others."""
    return {
        name: numbers(column, file, lines, name, may_miss=name not in complete)
        if name in NUMBER_COLUMNS
        else names(column, file, lines, name)
        for name, column in zip(header, cells, strict=True)
    }


def _whole(name: str, parts: list[AnyArray]) -> AnyArray:
    column = np.concatenate(parts)
    return column if name in NUMBER_COLUMNS | NAME_COLUMNS else numbers_or_names(column)


def _check_not_back(stamps_s: AnyArray, file: Path, lines: AnyArray) -> None:
    backwards = np.flatnonzero(np.diff(stamps_s) < 0)
    if backwards.size:
        row = int(backwards[0])
        raise RunFolderError(
            f"{file}: row {lines[row + 1]}, column 't': {float(stamps_s[row + 1])!r} after "
            f"{float(stamps_s[row])!r}; stamps may not go back ({backwards.size} of "
            f"{len(stamps_s)} rows do)"
        )


def _format(column: AnyArray, decimals: int) -> list[str]:
    if column.dtype.kind != "f":
        return [quoted_text(str(value)) for value in column]
    return ["" if math.isnan(value) else f"{value:.{decimals}f}" for value in column]
