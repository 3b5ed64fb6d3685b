"""Points of the terrain that were marked in an image and measured from the robot."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.io.csv_columns import opened_csv
from terrain.errors import CalibrationError

COLUMNS = ("u", "v", "x", "y")


@dataclass(frozen=True, eq=False)
class MarkedPoints:
    """Pixels and the points of the terrain that they show.

    Attributes
    ----------
    pixels : (N, 2)
        u, v of the image as recorded; (0, 0) is the centre of the top left pixel.
    ground_m : (N, 2)
        x forward, y left of the robot's centre.
    lines : (N,)
        Of the file, header = 1.
    """

    pixels: FloatArray
    ground_m: FloatArray
    lines: IntArray


def read_marked_points(file: Path) -> MarkedPoints:
    """Read a CSV file with the columns u, v [px], x, y [m], in any order.

    Raises
    ------
    CalibrationError
        Naming file, row and column.
    """
    rows: list[list[float]] = []
    lines: list[int] = []
    with opened_csv(file, CalibrationError) as (header, blocks):
        missing = [name for name in COLUMNS if name not in header]
        if missing:
            raise CalibrationError(
                f"{file}: the column {missing[0]!r} is missing; expected u,v,x,y, the header has "
                f"{', '.join(header)}"
            )
        for block_lines, cells in blocks:
            columns = [cells[header.index(name)] for name in COLUMNS]
            for line, *texts in zip(block_lines, *columns, strict=True):
                named = zip(texts, COLUMNS, strict=True)
                rows.append([_number(text, file, line, name) for text, name in named])
                lines.append(line)
    values = np.array(rows, dtype=np.float64).reshape(-1, 4)
    return MarkedPoints(values[:, :2], values[:, 2:], np.array(lines, dtype=np.int64))


def _number(text: str, file: Path, line: int, name: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not abs(value) <= 1e6:
        raise CalibrationError(
            f"{file}: row {line}, column {name!r}: {text!r}, expected a finite number"
        )
    return value
