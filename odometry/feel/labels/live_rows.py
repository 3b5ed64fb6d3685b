"""Rows of sensors as they come in, and even signals of a stretch of them."""

import math
from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.feel.recorded.signals import GAP_PERIODS, held_rows, interpolated


class LiveRows:
    """The latest rows of a sensor with A columns.

    Parameters
    ----------
    columns : int

    Attributes
    ----------
    first_s, latest_s : float
        Stamps of the first row of all, and of the latest; infinite without one.
    """

    def __init__(self, columns: int) -> None:
        self.first_s, self.latest_s = math.inf, -math.inf
        self._columns = columns
        self._stamps_s: list[float] = []
        self._rows: list[tuple[float, ...]] = []

    def add(self, stamp_s: float, row: Sequence[float]) -> bool:
        """Take in a row; False where its stamp does not increase or is no number."""
        if not self.latest_s < stamp_s < math.inf:
            return False
        self.first_s, self.latest_s = min(self.first_s, stamp_s), stamp_s
        self._stamps_s.append(stamp_s)
        self._rows.append(tuple(row))
        return True

    @property
    def stamps_s(self) -> FloatArray:
        """Of the rows (N,) that are kept."""
        return np.array(self._stamps_s)

    def forget(self, before_s: float) -> None:
        """Drop what came before a stamp, but for the row in force there."""
        first = max(int(np.searchsorted(self._stamps_s, before_s, side="right")) - 1, 0)
        del self._stamps_s[:first], self._rows[:first]

    def held(self, grid_s: FloatArray) -> FloatArray:
        """Rows (N, A) in force at even stamps (N,), as held from stamp to stamp."""
        return np.array(self._rows)[held_rows(self.stamps_s, grid_s)]

    def even(self, grid_s: FloatArray, rate_hz: float) -> FloatArray:
        """Columns (A, N) at even stamps (N,), linear between numbers; NaN within gaps."""
        stamps_s, table = self.stamps_s, np.array(self._rows).T
        nothing = np.full(len(grid_s), math.nan)
        return np.stack(
            [
                interpolated(grid_s, stamps_s, column, rate_hz)
                if np.isfinite(column).any()
                else nothing
                for column in table
            ]
        )

    def completed_s(self, at_s: float, rate_hz: float) -> float:
        """The stamp of the row from which on all columns are known at a stamp.

        That of its first number there or later, of each column, or from which on it is sure that
        a gap of the column lies there. Infinite before that.
        """
        return max(self._completed_s(column, at_s, rate_hz) for column in range(self._columns))

    def _completed_s(self, column: int, at_s: float, rate_hz: float) -> float:
        first = int(np.searchsorted(self._stamps_s, at_s, side="left"))
        gap_s, before_s = GAP_PERIODS / rate_hz, -math.inf
        for row in range(first - 1, -1, -1):
            if math.isfinite(self._rows[row][column]):
                before_s = self._stamps_s[row]
                break
        for row in range(first, len(self._rows)):
            stamp_s = self._stamps_s[row]
            if math.isfinite(self._rows[row][column]) or stamp_s - before_s > gap_s:
                return stamp_s
        return math.inf
