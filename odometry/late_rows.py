"""Rows of a steady sensor that have the stamps of their arrival: how late, and even stamps.

What hands rows on (a serial line, a network, a busy computer) delays some more than others, in the
order in which they were sent. No row is early, so a row was measured no later than one period
before the next one was: the earliest of all times that later rows allow is that of the lower
envelope of the stamps over their numbers.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.run import Run
from odometry.table import Table

CLOSE = 0.2  # of the period: no steady sensor measures twice so soon
# Share of the rows that follow so close: one stall of a second each 50 s makes 2 %, and 31 real
# recordings have none.
FEWEST_CLOSE = 0.02
# Of the time, within such rows: rows that come at once take less, those that are measured more.
AT_ONCE = 0.02
LEAST_LATE = 0.5  # of the period, root mean square: less moves no row to the place of another
TOGETHER = 0.1  # ... and of those late by a period: others wait behind them
PIECE, FEWEST = 200, 8  # rows over which the period is taken, and of such pieces
TIMES = 10  # as many rows, over which stamps of rows that are late are off by no more
# Times that the variance over a piece is that over a tenth of it: 1 where each row is late by
# itself, 10 where the times between rows are their own (rows lost, a log of changes). In recordings
# of development made late it was 2.3 at most, in other logs 3.6 at least.
STEADY = 2.5
# Share of rows that may be lost, or by which a clock may run off, before even stamps go wrong.
SLACK = 0.02
# Of the share of other rows that have a new value: rows that follow close and have one more rarely
# are copies.
SAME = 0.1


class LateRows(NamedTuple):
    """Rows (N,) of a steady sensor with stamps of arrival.

    Attributes
    ----------
    even_s : (N,)
        Stamps of no delay but one that all rows have; they increase, and none is later.
    late_s : (N,)
        By how much the stamps of the file are later.
    close : (N,) of bool
        The rows that came together with the one before.
    period_s : float
    """

    even_s: FloatArray
    late_s: FloatArray
    close: BoolArray
    period_s: float

    @property
    def uneven_s(self) -> float:
        """Standard deviation of how late rows are."""
        return float(np.std(self.late_s))


def late_rows(table: Table) -> LateRows | None:
    """Rows of a steady sensor that came late by chance, some together; None where they did not.

    They are as many as the time asks for: over a longer time they are off by no more than over a
    shorter one. Rows that repeat the values of the one before were not measured with it.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> from odometry.late_rows import late_rows
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> late_rows(run.odometry) is None
    True
    """
    stamps_s = table.stamps_s
    rows = min(PIECE, len(stamps_s) // FEWEST)
    if rows < 2 * TIMES or np.any(np.diff(stamps_s) < 0):
        return None
    period_s = _period_s(stamps_s, rows)
    lasts_s = np.diff(stamps_s)
    close = np.concatenate([[False], lasts_s < CLOSE * period_s])
    at_once_s = float(np.sum(lasts_s[close[1:]]))
    if close.mean() < FEWEST_CLOSE or at_once_s > AT_ONCE * (stamps_s[-1] - stamps_s[0]):
        return None
    even_s = even_stamps_s(stamps_s, period_s)
    late_s = stamps_s - even_s
    uneven = float(np.sqrt(np.mean(late_s**2))) > LEAST_LATE * period_s
    together = close.mean() > TOGETHER * np.mean(late_s > period_s)
    if not (uneven and together and _is_steady(stamps_s, rows)) or repeat_values(table, close):
        return None
    return LateRows(even_s, late_s, close, period_s)


def with_stamps(run: Run, name: str, stamps_s: FloatArray) -> Run:
    """The run with other stamps (N,) in one of its tables."""
    table = getattr(run, name)
    return replace(run, **{name: replace(table, columns={**table.columns, "t": stamps_s})})


def even_stamps_s(stamps_s: FloatArray, period_s: float) -> FloatArray:
    """Of each row the earliest time that it and later rows allow, (N,).

    Rows are a period apart or more, and where none came it stays a gap.
    """
    counted_s = (1 - SLACK) * period_s * np.arange(len(stamps_s))
    ahead_s = stamps_s - counted_s
    return np.asarray(counted_s + np.minimum.accumulate(ahead_s[::-1])[::-1])


def _period_s(stamps_s: FloatArray, rows: int) -> float:
    """The mean of the middle half of the periods over so many rows."""
    periods_s = np.sort(stamps_s[rows:] - stamps_s[:-rows]) / rows
    quarter = len(periods_s) // 4
    return float(periods_s[quarter : len(periods_s) - quarter].mean())


def _is_steady(stamps_s: FloatArray, rows: int) -> bool:
    """Whether stamps are off by as much over so many rows as over a tenth of them.

    Means over several numbers of rows: bursts of one size are even over multiples of it.
    """
    few = range(rows // (2 * TIMES), rows // TIMES + 1)
    over_few, over_many = (
        np.mean([np.var(stamps_s[m:] - stamps_s[:-m]) for m in counts])
        for counts in (few, [TIMES * m for m in few])
    )
    return bool(over_many < STEADY * over_few)


def repeat_values(table: Table, close: BoolArray) -> bool:
    """Whether rows (N,) that follow close repeat the values before them, and others do not."""
    change = False
    for name, column in table.columns.items():
        if name == "t" or column.dtype.kind != "f":
            continue
        known = np.isfinite(column[1:] + column[:-1])
        new = np.diff(column) != 0
        together, others = new[known & close[1:]], new[known & ~close[1:]]
        if np.sum(together) * len(others) > SAME * np.sum(others) * len(together):
            return False
        change |= bool(others.any())
    return change
