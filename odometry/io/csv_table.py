"""Read and write one CSV file of a run folder, with errors that name row and column."""

import csv
import math
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray
from odometry.errors import RunFolderError
from odometry.io.files import atomic_write
from odometry.table import Table

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
    header, rows, lines = _read_cells(file)
    for name in required:
        if name not in header:
            raise RunFolderError(
                f"{file}: the column {name!r} is missing; the header has {', '.join(header)}"
            )
    if not rows:
        raise RunFolderError(f"{file}: there are no rows below the header")
    columns: dict[str, AnyArray] = {}
    for position, name in enumerate(header):
        cells = [row[position].strip() for row in rows]
        if name in NAME_COLUMNS:
            columns[name] = np.array(cells)
        elif name in NUMBER_COLUMNS:
            columns[name] = _numbers(cells, file, lines, name, may_miss=name not in complete)
        else:
            columns[name] = _numbers_or_names(cells)
    _check_not_back(columns["t"], file, lines)
    repeated = np.diff(columns["t"], prepend=-math.inf) == 0
    kept = {name: column[~repeated] for name, column in columns.items()}
    return Table(file, kept, np.array(lines)[~repeated], np.array(lines)[repeated])


def write_csv_table(file: Path, columns: Mapping[str, AnyArray], decimals: int = 9) -> None:
    """Write columns of equal length as CSV; NaN becomes an empty cell."""
    formatted = [_format(np.asarray(column), decimals) for column in columns.values()]
    lengths = {name: len(cells) for name, cells in zip(columns, formatted, strict=True)}
    if len(set(lengths.values())) != 1:
        raise RunFolderError(f"{file}: the columns differ in length: {lengths}")
    with atomic_write(file) as part, part.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*formatted, strict=True))


def _read_cells(file: Path) -> tuple[list[str], list[list[str]], list[int]]:
    rows: list[list[str]] = []
    lines: list[int] = []
    try:
        with file.open(newline="", encoding="utf-8-sig") as stream:
            reader = csv.reader(stream, strict=True)
            header = [name.strip() for name in next(reader, [])]
            for row in reader:
                if row:
                    rows.append(row)
                    lines.append(reader.line_num)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise RunFolderError(f"{file}: cannot be read as CSV: {error}") from error
    repeated = sorted({name for name in header if header.count(name) > 1})
    if repeated:
        raise RunFolderError(f"{file}: row 1: the column {repeated[0]!r} stands there twice")
    for line, row in zip(lines, rows, strict=True):
        if len(row) != len(header):
            raise RunFolderError(
                f"{file}: row {line}: {len(row)} cells, but the header has {len(header)} columns"
            )
    return header, rows, lines


def _numbers(
    cells: list[str], file: Path, lines: list[int], name: str, *, may_miss: bool
) -> AnyArray:
    values = np.empty(len(cells))
    for row, cell in enumerate(cells):
        try:
            value = float(cell) if cell else math.nan
        except ValueError:
            raise RunFolderError(
                f"{file}: row {lines[row]}, column {name!r}: {cell!r} is not a number"
            ) from None
        if math.isinf(value) or (math.isnan(value) and not may_miss):
            raise RunFolderError(
                f"{file}: row {lines[row]}, column {name!r}: {cell!r}, expected a finite number"
            )
        values[row] = value
    return values


def _numbers_or_names(cells: list[str]) -> AnyArray:
    try:
        return np.array([float(cell) if cell else math.nan for cell in cells])
    except ValueError:
        return np.array(cells)


def _check_not_back(stamps_s: AnyArray, file: Path, lines: list[int]) -> None:
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
        return [str(value) for value in column]
    return ["" if math.isnan(value) else f"{value:.{decimals}f}" for value in column]
