"""Columns of a CSV file as arrays: numbers, names, and what else is there."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import RunFolderError
from odometry.io.csv_cells import unquoted_text

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
    cells: Sequence[str], file: Path, lines: Sequence[int], name: str, *, may_miss: bool
) -> FloatArray:
    """Numbers (N,) of the cells of one column; an empty one is NaN where it `may_miss`.

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
