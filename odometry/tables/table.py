"""A time-stamped table: the columns of one CSV file of a run folder, and cells that are missing."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.errors import RunFolderError, TrajectoryError
from odometry.installed import extra_module


@dataclass(frozen=True)
class Table:
    """Columns of equal length, found by name; the first is `t`.

    Attributes
    ----------
    file : Path
        Where the table was read from, for error messages.
    columns : Mapping[str, array (N,)]
        Numbers as float64, names as str. Not measured is NaN, or an empty name.
    lines : (N,)
        Line number of each row in the file, header = 1.
    repeated : Table or None
        Rows that were dropped: each repeated the stamp of the row before it.
    """

    file: Path
    columns: Mapping[str, AnyArray]
    lines: IntArray
    repeated: "Table | None" = None

    def __len__(self) -> int:
        return len(self.columns["t"])

    def __contains__(self, name: str) -> bool:
        return name in self.columns

    def __getitem__(self, name: str) -> AnyArray:
        if name not in self.columns:
            raise RunFolderError(
                f"{self.file}: there is no column {name!r}; it has {', '.join(self.columns)}"
            )
        return self.columns[name]

    @property
    def stamps_s(self) -> FloatArray:
        """Stamps (N,) in seconds, strictly increasing."""
        return self["t"]

    @property
    def repeated_lines(self) -> IntArray:
        """Lines (R,) of the rows that were dropped."""
        return np.empty(0, dtype=np.int64) if self.repeated is None else self.repeated.lines

    def stack(self, *names: str) -> FloatArray:
        """The named columns side by side, (N, len(names))."""
        return np.stack([self[name] for name in names], axis=-1)

    def rows(self, chosen: slice | IntArray) -> "Table":
        """The same table with only the chosen rows, and the dropped rows that repeated them."""
        columns = {name: column[chosen] for name, column in self.columns.items()}
        lines, repeated = self.lines[chosen], self.repeated
        if repeated is not None:
            repeats_of = self.lines[np.searchsorted(self.lines, repeated.lines) - 1]
            repeated = repeated.rows(np.flatnonzero(np.isin(repeats_of, lines)))
        return replace(self, columns=columns, lines=lines, repeated=repeated)

    def without_repeated(self) -> "Table":
        """The first row of each stamp, where stamps do not go back; `repeated` has the others."""
        repeated = np.diff(self.stamps_s, prepend=-np.inf) == 0
        if not repeated.any():
            return self
        kept, dropped = (self.rows(np.flatnonzero(rows)) for rows in (~repeated, repeated))
        return replace(kept, repeated=dropped)

    def with_repeated(self) -> "Table":
        """The rows of the file, with those that share a stamp, in the order of their lines."""
        if self.repeated is None:
            return self
        lines = np.concatenate([self.lines, self.repeated.lines])
        order = np.argsort(lines, kind="stable")
        columns = {
            name: np.concatenate([column, self.repeated[name]])[order]
            for name, column in self.columns.items()
        }
        return Table(self.file, columns, lines[order])

    def to_pandas(self) -> Any:
        """The columns as a pandas DataFrame, rows numbered from 0; an empty name is missing.

        Raises
        ------
        ExtraError
            If pandas is not installed.
        """
        pandas = extra_module("pandas", "tables", "Table.to_pandas")
        frame = pandas.DataFrame(dict(self.columns))
        names = [name for name, column in self.columns.items() if column.dtype.kind == "U"]
        return frame.assign(**{name: frame[name].replace("", None) for name in names})


def fill_gaps(stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    """Values (N,) with NaN replaced: linear over gaps in time, held at both ends.

    Raises
    ------
    TrajectoryError
        If there is not one value a stamp, or none is a number.
    """
    values = np.asarray(values, dtype=np.float64)
    measured = np.isfinite(values)
    if values.shape != np.shape(stamps_s) or not measured.any():
        raise TrajectoryError(
            f"{measured.sum()} measured of {values.shape} values for {len(stamps_s)} stamps; "
            "expected one value a stamp, and one measured at least"
        )
    return np.interp(stamps_s, np.asarray(stamps_s)[measured], values[measured])


def level_where_missing(stamps_s: FloatArray, angle_rad: FloatArray | None) -> FloatArray:
    """Roll or pitch (N,) with its gaps filled; level terrain where it was never measured."""
    if angle_rad is None or np.all(np.isnan(angle_rad)):
        return np.zeros(len(stamps_s))
    return fill_gaps(stamps_s, angle_rad)
