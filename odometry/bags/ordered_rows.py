"""Rows of numbers into a CSV file, in the order of their stamps, block by block."""

from collections.abc import Callable
from pathlib import Path
from typing import TextIO

import numpy as np

from odometry.arrays import FloatArray, IntArray

BLOCK = 2048  # rows that are held back; those out of order by less than half of it are sorted
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
        self._file, self._names, self._columns = file, names, columns
        self._needed = needed
        self._stream: TextIO | None = None
        self._stamps: list[int] = []
        self._rows: list[tuple[float, ...]] = []
        self._last_ns = -(2**63)

    def add(self, stamp_ns: int, row: tuple[float, ...]) -> None:
        """Take in a row."""
        self._stamps.append(stamp_ns)
        self._rows.append(row)
        if len(self._stamps) >= BLOCK:
            self._write(BLOCK // 2)

    def close(self) -> None:
        """Write what is held; a file without rows is not made."""
        self._write(len(self._stamps))
        if self._stream is not None:
            self._stream.close()

    def _write(self, count: int) -> None:
        """Write the earliest `count` rows that are held."""
        if not self._stamps:
            return
        order = np.argsort(np.array(self._stamps), kind="stable")
        stamps = np.array(self._stamps)[order]
        rows = np.array(self._rows, dtype=np.float64)[order]
        self._stamps, self._rows = stamps[count:].tolist(), list(map(tuple, rows[count:]))
        stamps, rows = self._in_order(stamps[:count], rows[:count])
        stamps, values = self._columns(stamps, rows)
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
        for stamp, row in zip(stamps.tolist(), values.tolist(), strict=True):
            cells = ["" if value != value else f"{value:.10g}" for value in row]  # noqa: PLR0124 - NaN
            self._stream.write(f"{seconds(stamp)},{','.join(cells)}\n")
        self.written += len(stamps)


def seconds(stamp_ns: int) -> str:
    """A stamp as seconds, all digits."""
    return f"{stamp_ns // 10**9}.{stamp_ns % 10**9:09d}"
