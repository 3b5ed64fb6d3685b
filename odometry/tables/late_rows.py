"""Rows of a steady sensor that have the stamps of their arrival: how late, and even stamps.

What hands rows on (a serial line, a network, a busy computer) delays some more than others, in the
order in which they were sent. No row is early, so a row was measured no later than one period
before the next one was: the earliest of all times that later rows allow is that of the lower
envelope of the stamps over their numbers.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.tables.row_values import are_of_one_sensor
from odometry.tables.table import Table

CLOSE = 0.2  # of the period: no steady sensor measures twice so soon
FEWEST_CLOSE = 0.02  # share of the rows that follow so close; 31 real recordings have none
# Of the time, within such rows: rows that come at once take less, those that are measured more.
AT_ONCE = 0.02
LEAST_LATE = 0.5  # of the period, root mean square: less moves no row to the place of another
PIECE, FEWEST = 200, 8  # rows over which the period is taken, and of such pieces
TIMES = 10  # as many rows, over which stamps of rows that are late are off by no more
# Times that the variance over a piece is that over a tenth of it: 1 where each row is late by
# itself, 10 where the times between rows are their own (rows lost, a log of changes). In recordings
# of development made late it was 2.3 at most, in other logs 3.6 at least.
STEADY = 2.5
# Periods without rows, share of these times' rows that follow at once, and share of such times, in
# a log that stalls now and then; else rows are lost.
STALL, MADE_UP, MOSTLY = 5.0, 0.7, 0.8
ON_TIME = 0.25  # of the period, by which such a share of the rows of that log are late at most
# Share of rows that may be lost, or by which a clock may run off, before even stamps go wrong.
SLACK = 0.02
# Of stamps that are coarse: rows of a steady sensor share them.
STEPS_S = (1.0, 0.5, 0.25, 0.2, 0.1, 0.05, 0.02, 0.01)
SHARED = 1.1  # periods, than which such a step is longer
OFF = 1e-3  # of a step, by which stamps of that step are off at most
LATER, NEARLY_ALL = 1.5, 0.95  # times a step, that so many rows are late: they came late as well
ROUNDING_S = 1e-6  # of stamps from 1970, beside that


class LateRows(NamedTuple):
    """Rows (N,) of a steady sensor with stamps of arrival.

    Attributes
    ----------
    even_s : (N,)
        Stamps of no delay but one that all rows have; they increase, and none is later.
    late_s : (N,)
        By how much the stamps of the file are later; coarse ones with what was cut off at most.
    close : (N,) of bool
        The rows that came together with the one before.
    period_s : float
    step_s : float
        Step of stamps that are coarse, of which several rows have the same; 0 of finer ones.
    rows : Table
        The rows as they were read, with those that share a stamp.
    """

    even_s: FloatArray
    late_s: FloatArray
    close: BoolArray
    period_s: float
    step_s: float
    rows: Table

    @property
    def uneven_s(self) -> float:
        """Standard deviation of how late rows are."""
        return float(np.std(self.late_s))

    @property
    def are_coarse(self) -> bool:
        """Whether what was cut off the stamps explains nearly all of it."""
        return float(np.quantile(self.late_s, NEARLY_ALL)) < LATER * self.step_s

    @property
    def at_once(self) -> IntArray:
        """How many rows have each of the stamps (S,) of the file."""
        return np.unique(self.rows.stamps_s, return_counts=True)[1]

    def at(self, stamps_s: FloatArray) -> Table:
        """The rows at other stamps (N,)."""
        return replace(self.rows, columns={**self.rows.columns, "t": stamps_s})


def late_rows(table: Table) -> LateRows | None:
    """Rows of a steady sensor that came late by chance, some together; None where they did not.

    They are as many as the time asks for: over a longer time they are off by no more than over a
    shorter one. Rows that share a stamp, which the reader drops, are rows like others: late ones in
    stamps of few digits, or all of them in coarse stamps, of which the rest was cut off. Rows that
    repeat the values of the one before were not measured with it, and rows of several sensors have
    times of their own.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> from odometry.tables.late_rows import late_rows
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> late_rows(run.odometry) is None
    True
    """
    table = table.with_repeated()
    stamps_s, lasts_s = table.stamps_s, np.diff(table.stamps_s)
    rows = min(PIECE, len(stamps_s) // FEWEST)
    if rows < 2 * TIMES or np.any(lasts_s < 0):
        return None
    for period_s, is_late in (
        (float(np.median(lasts_s)), _stalls),
        (_period_s(stamps_s, rows), _is_late_by_chance),
    ):
        if period_s <= 0:
            continue
        found = _at_even_stamps(table, period_s)
        at_once_s = float(np.sum(lasts_s[found.close[1:]]))
        if at_once_s > AT_ONCE * (stamps_s[-1] - stamps_s[0]) or not is_late(stamps_s, found, rows):
            continue
        return found if are_of_one_sensor(table, found.close) else None
    return None


def _at_even_stamps(rows: Table, period_s: float) -> LateRows:
    step_s = _coarse_step_s(rows.stamps_s, period_s)
    latest_s = rows.stamps_s + max(step_s - period_s / 2, 0.0)
    even_s = even_stamps_s(latest_s, period_s)
    close = np.diff(rows.stamps_s, prepend=-np.inf) < CLOSE * period_s
    return LateRows(even_s, latest_s - even_s, close, period_s, step_s, rows)


def _coarse_step_s(stamps_s: FloatArray, period_s: float) -> float:
    """The step of stamps that are multiples of more than a period; 0 of finer ones.

    But the first, at which a cut may hold a row.
    """
    for step_s in STEPS_S:
        off_s = np.abs(stamps_s - step_s * np.round(stamps_s / step_s))[1:]
        if step_s > SHARED * period_s and off_s.max() < OFF * step_s + ROUNDING_S:
            return step_s
    return 0.0


def even_stamps_s(stamps_s: FloatArray, period_s: float) -> FloatArray:
    """Of each row the earliest time that it and later rows allow, (N,).

    Rows are a period apart or more, and where none came it stays a gap.
    """
    counted_s = (1 - SLACK) * period_s * np.arange(len(stamps_s))
    ahead_s = stamps_s - counted_s
    return np.asarray(counted_s + np.minimum.accumulate(ahead_s[::-1])[::-1])


def _period_s(stamps_s: FloatArray, rows: int) -> float:
    """The mean of the middle half of the periods over so many rows.

    Of coarse stamps also of those up to a step beside: any part of them that the step rounds to one
    side is biased.
    """
    periods_s = np.sort(stamps_s[rows:] - stamps_s[:-rows]) / rows
    quarter = len(periods_s) // 4
    middle_s = periods_s[quarter : len(periods_s) - quarter]
    found_s = float(middle_s.mean())
    step_s = _coarse_step_s(stamps_s, found_s)
    if not step_s:
        return found_s
    beside_s = (1 + OFF) * step_s / rows
    low, high = np.searchsorted(periods_s, [middle_s[0] - beside_s, middle_s[-1] + beside_s])
    return float(periods_s[low:high].mean())


def _is_late_by_chance(stamps_s: FloatArray, found: LateRows, rows: int) -> bool:
    """Whether many are, and stamps are off by as much over so many rows as over a tenth of them.

    Means over several numbers of rows: bursts of one size are even over multiples of it.
    """
    uneven_s = float(np.sqrt(np.mean(found.late_s**2)))
    if found.close.mean() < FEWEST_CLOSE or uneven_s < LEAST_LATE * found.period_s:
        return False
    few = range(rows // (2 * TIMES), rows // TIMES + 1)
    over_few, over_many = (
        np.mean([np.var(stamps_s[m:] - stamps_s[:-m]) for m in counts])
        for counts in (few, [TIMES * m for m in few])
    )
    return bool(over_many < STEADY * over_few)


def _stalls(stamps_s: FloatArray, found: LateRows, _: int) -> bool:
    """Whether the rows of most times without rows come at once at their end, and others on time."""
    lasts_s = np.diff(stamps_s)
    before = np.flatnonzero(lasts_s > STALL * found.period_s)
    if not len(before) or np.mean(found.late_s < ON_TIME * found.period_s) < MOSTLY:
        return False
    alone = np.append(np.flatnonzero(~found.close), len(stamps_s))
    together = alone[np.searchsorted(alone, before + 1, side="right")] - before - 1
    made_up = together * found.period_s > MADE_UP * lasts_s[before]
    return bool(made_up.mean() > MOSTLY)
