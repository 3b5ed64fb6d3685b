"""Rows of numbers into a CSV file, in the order of their stamps, block by block."""

from collections.abc import Callable
from itertools import chain
from pathlib import Path
from typing import TextIO

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.bags.rows.set_clock import SetClock
from odometry.io.csv_columns import LARGEST, LARGEST_BY_NAME

LARGEST_NUMBER = 1e12  # of a number in a message
HELD = 1024  # rows that are held back: those out of order by fewer are sorted
Columns = Callable[[IntArray, FloatArray], tuple[IntArray, FloatArray]]


class OrderedRows:
    """Writes rows as they come; memory does not grow with their number.

    Rows that repeat a stamp are dropped, and so are rows whose stamp goes back by more rows than
    are held.

    Attributes
    ----------
    written, repeated, back, incomplete : int
        Rows written, and rows dropped: with a stamp that was there before; with a stamp that goes
        back; with a number missing that has to be there.
    farthest_back_s : float
        How far the worst stamp goes back.
    clock : SetClock
        Leaves out rows behind a clock that was set back.
    """

    def __init__(self, file: Path, names: tuple[str, ...], columns: Columns, needed: int) -> None:
        """Begin a file.

        Parameters
        ----------
        file : Path
        names : of str
            Columns behind `t`.
        columns : callable
            Turns stamps [ns] (N,) and rows (N, k) into those that are written, (M,) and (M, len
            (names)); called in the order of time.
        needed : int
            How many of the first columns must have a number; rows without are dropped.
        """
        self.written = self.repeated = self.back = self.incomplete = 0
        self.farthest_back_s = 0.0
        self.clock = SetClock()
        self._file, self._names, self._columns = file, names, columns
        self._needed = needed
        self._stream: TextIO | None = None
        self._stamps: list[int] = []
        self._rows: list[tuple[float, ...]] = []
        self._held: tuple[IntArray, FloatArray] | None = None
        self._last_ns = -(2**63)
        self._largest = np.array([LARGEST_BY_NAME.get(name, LARGEST) for name in names])
        self._line = "%d.%09d" + len(names) * ",%.10g" + "\n"

    def add(self, stamp_ns: int, row: tuple[float, ...]) -> None:
        """Take in a row."""
        for stamp, one in self.clock.add(stamp_ns, row):
            self._stamps.append(stamp)
            self._rows.append(one)
        if len(self._stamps) >= HELD:
            self._write(HELD)

    def close(self) -> None:
        """Write what is held; a file without rows is not made."""
        for stamp, row in self.clock.rest():
            self._stamps.append(stamp)
            self._rows.append(row)
        self._write(0)
        if self._stream is not None:
            self._stream.close()

    def _write(self, kept: int) -> None:
        """Write all rows but the latest `kept`."""
        stamps, rows = np.array(self._stamps, dtype=np.int64), np.array(self._rows, dtype=float)
        self._stamps, self._rows = [], []
        if self._held is not None:
            pair = (self._held, (stamps, rows)) if len(stamps) else (self._held,)
            stamps, rows = (np.concatenate(parts) for parts in zip(*pair, strict=True))
        if not len(stamps):
            return
        order = np.argsort(stamps, kind="stable")
        count = max(0, len(order) - kept)
        self._held = stamps[order[count:]], rows[order[count:]]
        stamps, rows = self._in_order(stamps[order[:count]], rows[order[:count]])
        stamps, values = self._columns(stamps, _plausible(rows, LARGEST_NUMBER))
        values = _plausible(values, self._largest)
        whole = np.isfinite(values[:, : self._needed]).all(axis=1)
        self.incomplete += int(np.count_nonzero(~whole))
        self._put(stamps[whole], values[whole])

    def _in_order(self, stamps: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Rows behind the last one that was written, each stamp once; the others are counted."""
        back = stamps < self._last_ns
        if back.any():
            self.back += int(np.count_nonzero(back))
            farthest = (self._last_ns - int(stamps[back].min())) / 1e9
            self.farthest_back_s = max(self.farthest_back_s, farthest)
        again = np.diff(stamps, prepend=self._last_ns) == 0
        self.repeated += int(np.count_nonzero(again & ~back))
        kept = ~back & ~again
        if kept.any():
            self._last_ns = int(stamps[kept][-1])
        return stamps[kept], rows[kept]

    def _put(self, stamps: IntArray, values: FloatArray) -> None:
        if not len(stamps):
            return
        if self._stream is None:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            self._stream = self._file.open("w", encoding="utf-8", newline="")
            self._stream.write(",".join(("t", *self._names)) + "\n")
        columns = [*np.divmod(stamps, 10**9), *values.T]
        cells = chain.from_iterable(zip(*(column.tolist() for column in columns), strict=True))
        lines = len(stamps) * self._line % tuple(cells)
        self._stream.write(lines.replace("nan", ""))
        self.written += len(stamps)


def _plausible(values: FloatArray, largest: FloatArray | float) -> FloatArray:
    """Values (N, k), NaN where they are larger than any that is meant: bytes were damaged."""
    return np.where(np.abs(values) <= largest, values, np.nan)


def seconds(stamp_ns: int) -> str:
    """A stamp as seconds, all digits."""
    return f"{stamp_ns // 10**9}.{stamp_ns % 10**9:09d}"
