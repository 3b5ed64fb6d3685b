"""A CSV file of satellite fixes: its columns as numbers, whatever their names and separators."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import RunFolderError, TrajectoryError
from odometry.fixes.fix_columns import FixColumns, Named, columns_of, header_of
from odometry.fixes.fix_stamps import date_s, is_date, name_no_zone, unit_s
from odometry.io.csv_columns import numbers, opened_csv

MISSING = frozenset({"nan", "null", "none", "n/a", "na", "-", "--"})
LARGEST = 1e19  # nanoseconds since 1970 are 1.8e18
ALTITUDES_M = (-500.0, 9000.0)  # of the surface of the Earth


@dataclass(frozen=True)
class FixFile:
    """What a CSV file of fixes holds.

    Attributes
    ----------
    file : Path
    columns : FixColumns
    lines : (N,)
        Of the file, on which the rows end.
    cells : dict of str to list of str
        By the name of the column.
    """

    file: Path
    columns: FixColumns
    lines: IntArray
    cells: dict[str, list[str]]

    def numbers(self, column: str) -> FloatArray:
        """Numbers (N,) of a column, NaN where a cell says that there is none.

        Raises
        ------
        TrajectoryError
            Naming file, row and column of another text.
        """
        cells = self.cells[column]
        try:
            return numbers(
                cells, self.file, self.lines.tolist(), column, may_miss=True, largest=LARGEST
            )
        except RunFolderError as error:
            raise TrajectoryError(str(error)) from error

    @property
    def angles(self) -> FloatArray:
        """Latitude and longitude (N, 2) as they are in the file."""
        both = self.columns.latitude, self.columns.longitude
        return np.column_stack([self.numbers(each.column) for each in both])

    def altitudes_m(self, *, of_whole_degrees: bool) -> tuple[FloatArray, str]:
        """Altitudes (N,) [m], and a note; NaN where there are none on Earth.

        Where angles are whole numbers of 1e-7 degrees, whole altitudes are in millimetres, as
        receivers and flight logs have both.
        """
        named = self.columns.altitude
        if named is None:
            return np.full(len(self.lines), np.nan), ""
        values = self.numbers(named.column)
        whole = (values == np.round(values))[np.isfinite(values)].all()
        note = ""
        if named.says == "mm" or (of_whole_degrees and whole and named.says != "m"):
            values, note = values / 1000, f"{named.column!r} is read as millimetres"
        least_m, most_m = ALTITUDES_M
        wrong = (values < least_m) | (values > most_m)
        if wrong.any():
            note = (
                f"{named.column!r} is beyond {least_m:g} to {most_m:g} m in {wrong.sum()} rows, "
                "where it is left out: another unit?"
            )
        return np.where(wrong, np.nan, values), note

    def stamps_s(
        self, of: Named | tuple[Named, Named], lasts_s: float | None = None
    ) -> tuple[FloatArray, str]:
        """Stamps (N,) [s], NaN where there is none, and what they are in words.

        `lasts_s` is how long the odometry lasts, for units that nothing else decides.

        Raises
        ------
        TrajectoryError
            As `numbers`; if no usual unit gives a likely period.
        """
        if isinstance(of, tuple):
            whole, rest = (self.numbers(each.column) for each in of)
            return whole + rest * 1e-9, f"{of[0].column!r} and {of[1].column!r}"
        cells = self.cells[of.column]
        first = next((cell for cell in cells if cell), "")
        if is_date(first):
            zone = ", taken as UTC: no zone is named" if name_no_zone([first]) else ""
            return self._dates(of.column), f"{of.column!r}, dates{zone}"
        if first and not is_number(first):
            raise TrajectoryError(
                f"{self.file}: row {self.lines[cells.index(first)]}, column {of.column!r}: "
                f"{first!r} is neither a number nor a date with a time, as 2026-11-30T10:15:00.2Z"
            )
        values = self.numbers(of.column)
        unit = unit_s(values, of.says, lasts_s)
        if unit is None:
            raise TrajectoryError(
                f"{self.file}: column {of.column!r}: no unit from seconds to nanoseconds gives "
                "a likely period of its rows. Say the unit in the name, for example time_ms"
            )
        words = {1.0: "seconds", 1e-3: "milliseconds", 1e-6: "microseconds"}
        return values * unit, f"{of.column!r} in {words.get(unit, 'nanoseconds')}"

    def _dates(self, column: str) -> FloatArray:
        stamps_s = np.full(len(self.lines), np.nan)
        for k, cell in enumerate(self.cells[column]):
            if not cell:
                continue
            stamp_s = date_s(cell)
            if stamp_s is None:
                raise TrajectoryError(
                    f"{self.file}: row {self.lines[k]}, column {column!r}: {cell!r} is no date "
                    "and time as the first one"
                )
            stamps_s[k] = stamp_s
        return stamps_s


def read_fix_file(file: Path) -> FixFile | None:
    """Read the columns of a CSV file whose header names latitude and longitude; None without.

    Raises
    ------
    TrajectoryError
        If the file cannot be read, has no rows, or as `columns_of`.
    """
    found = header_of(file)
    if found is None:
        return None
    separator = found.separator
    opened = opened_csv(file, TrajectoryError, separator, found.before, found.names)
    with opened as (header, blocks):
        columns = columns_of(header, file)
        wanted = _wanted(columns)
        lines: list[int] = []
        cells: dict[str, list[str]] = {name: [] for name in wanted}
        for block_lines, of_columns in blocks:
            lines += block_lines
            for name, column in zip(header, of_columns, strict=True):
                if name in cells:
                    cells[name] += [_plain(cell, separator) for cell in column]
    if not lines:
        raise TrajectoryError(f"{file}: there are no rows below the header")
    return FixFile(file, columns, np.array(lines, dtype=np.int64), cells)


def is_number(cell: str) -> bool:
    """Whether a cell is a number, or empty."""
    try:
        float(cell or "nan")
    except ValueError:
        return False
    return True


def _wanted(columns: FixColumns) -> set[str]:
    named = [columns.latitude, columns.longitude, *columns.states]
    named += [columns.altitude] if columns.altitude is not None else []
    for each in columns.stamps:
        named += each if isinstance(each, tuple) else [each]
    return {each.column for each in named}


def _plain(cell: str, separator: str) -> str:
    """A cell without spaces, empty where it says that it is; a comma in a number is a point."""
    text = cell.strip()
    if text.lower() in MISSING:
        return ""
    return text if separator == "," else text.replace(",", ".")
