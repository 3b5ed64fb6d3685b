"""Read and write one CSV file of a run folder, with errors that name row and column."""

import csv
import math
from array import array
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray
from odometry.blocks import blocks_of
from odometry.errors import RunFolderError
from odometry.io.csv_columns import (
    NAME_COLUMNS,
    NUMBER_COLUMNS,
    names,
    numbers,
    numbers_or_names,
    opened_csv,
    quoted_text,
)
from odometry.io.files import atomic_write
from odometry.tables.table import Table


def read_csv_table(file: Path, required: Iterable[str], complete: Iterable[str] = ()) -> Table:
    """Read a CSV file whose columns are found by name, in any order.

    A row that repeats the stamp of the row before it is dropped; `Table.repeated` has it.

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
    lines, numeric = array("q"), {name: array("d") for name in NUMBER_COLUMNS}
    texts: dict[str, list[AnyArray]] = {}
    with opened_csv(file, RunFolderError) as (header, blocks):
        for name in required:
            if name not in header:
                raise RunFolderError(
                    f"{file}: the column {name!r} is missing; the header has {', '.join(header)}"
                )
        for block_lines, cells in blocks:
            lines.extend(block_lines)
            for name, column in zip(header, cells, strict=True):
                if name in NUMBER_COLUMNS:
                    may_miss = name not in complete
                    values = numbers(column, file, block_lines, name, may_miss=may_miss)
                    numeric[name].frombytes(values.tobytes())
                else:
                    texts.setdefault(name, []).append(names(column, file, block_lines, name))
    if not lines:
        raise RunFolderError(f"{file}: there are no rows below the header")
    columns = {
        name: np.frombuffer(numeric[name]) if name in NUMBER_COLUMNS else _whole(name, texts[name])
        for name in header
    }
    all_lines = np.frombuffer(lines, dtype=np.int64)
    _check_not_back(columns["t"], file, all_lines)
    return Table(file, columns, all_lines).without_repeated()


def write_csv_table(file: Path, columns: Mapping[str, AnyArray], decimals: int = 9) -> None:
    """Write columns of equal length as CSV; NaN becomes an empty cell, a formula a text."""
    arrays = {name: np.asarray(column) for name, column in columns.items()}
    lengths = {name: len(array) for name, array in arrays.items()}
    if len(set(lengths.values())) != 1:
        raise RunFolderError(f"{file}: the columns differ in length: {lengths}")
    blocks = (
        {name: array[rows] for name, array in arrays.items()}
        for rows in blocks_of(next(iter(lengths.values())))
    )
    write_csv_blocks(file, columns, blocks, decimals)


def write_csv_blocks(
    file: Path, names: Iterable[str], blocks: Iterable[Mapping[str, AnyArray]], decimals: int = 9
) -> None:
    """The same, of columns that come block by block."""
    names = list(names)
    with atomic_write(file) as part, part.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(map(quoted_text, names))
        for columns in blocks:
            cells = [_format(columns[name], decimals) for name in names]
            writer.writerows(zip(*cells, strict=True))


def _whole(name: str, parts: list[AnyArray]) -> AnyArray:
    column = np.concatenate(parts)
    return column if name in NAME_COLUMNS else numbers_or_names(column)


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
    pattern = f"%.{decimals}f"
    return ["" if math.isnan(value) else pattern % value for value in column.tolist()]
