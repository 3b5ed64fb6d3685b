"""Rows that were sent in bursts and have the stamps of their arrival."""

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.recording.run import Run, with_stamps
from odometry.tables.row_values import repeat_values

CLOSE = 0.2  # of the mean period, that rows of one burst are apart at most
MOST_CLOSE = 0.45  # share of the rows that follow so close: in pairs half of them do
# Share of the time within bursts: rows that are sent at once take less than the first; rows that
# take more than the second were recorded now and then; between the two they may be either.
AT_ONCE, NOW_AND_THEN = 0.02, 0.08
LONGEST_S = 5.0  # a longer mean period is of stamps in another unit
OFTEN = 20  # bursts
PIECE = 20  # bursts, over which rows are counted
# Of the time between bursts, by which their last rows may be off even stamps: rows of a log of
# changes are as many as there were changes, and off by more than one such time.
STEADY = 0.3
MOVING = 0.3  # of the way from one burst to the next of a fast robot
# Of that way, that a pose of a burst lies ahead of the one before: at least 0.2 in 26 recordings,
# whose noise makes it less, and nearly nothing where two sensors are read together.
AS_FAR = 0.15
NAMES = {"pose.csv": "pose_bursts", "images.csv": "image_bursts"}
PAIRS = 2.2  # rows of a burst in the mean
ARRIVAL = (
    "stamps are those of arrival: rows were sent in bursts (buffered), not when they were measured"
)
RECORDED = ", or rows were recorded for a moment now and then"
ROUNDED = ", or stamps were rounded to whole steps"
SEVERAL = ", or the camera took several images at a time"
TWO_OF_EACH = ", or each moment has two rows, of the messages of either tread"
WARNED_S = 0.1  # between bursts: with less, values are of nearly the right time


class Bursts(NamedTuple):
    """Where rows come many at once.

    Attributes
    ----------
    last : (B,)
        Numbers of the last rows of all bursts.
    within : float
        Share of the time within bursts.
    """

    last: IntArray
    within: float


def spread_bursts(run: Run) -> tuple[list[Finding], Run]:
    """A finding for each file whose rows come many at once, and the run with them spread evenly.

    Rows of bursts are as many as a steady sensor has measured since the burst before. Rows that may
    have been recorded now and then stay where they are.
    """
    found = []
    for name in ("odometry", "imu", "pose"):
        table = getattr(run, name)
        bursts = None if table is None else _bursts(table.stamps_s)
        if bursts is None or (name == "pose" and not _go_on(table.stack("x", "y"), bursts.last)):
            continue
        first = np.append(0, bursts.last[:-1] + 1)
        if repeat_values(table, ~np.isin(np.arange(len(table)), first)):
            found.append(_repeated(f"{name}.csv", len(table) - len(first)))
            run = replace(run, **{name: table.rows(first)})
            continue
        found.append(_finding(f"{name}.csv", table.stamps_s, bursts))
        if bursts.within < AT_ONCE:
            run = with_stamps(run, name, _even_s(table.stamps_s, bursts.last))
    return found, run


def in_bursts(file: str, stamps_s: FloatArray) -> Iterator[Finding]:
    """The finding where rows of a file come many at once."""
    bursts = _bursts(stamps_s)
    if bursts is not None:
        yield _finding(file, stamps_s, bursts)


def _bursts(stamps_s: FloatArray) -> Bursts | None:
    """Of the stamps (N,) of a file; None where rows do not come in bursts."""
    lasts_s = np.diff(stamps_s)
    if len(lasts_s) < OFTEN or (lasts_s < 0).any() or lasts_s.mean() > LONGEST_S:
        return None
    close = lasts_s < CLOSE * float(lasts_s.mean())
    last = np.append(np.flatnonzero(~close), len(close))
    within = float(np.sum(lasts_s[close]) / np.sum(lasts_s))
    if close.mean() < MOST_CLOSE or len(last) <= OFTEN or within > NOW_AND_THEN:
        return None
    if np.sum(np.diff(last) > 1) < OFTEN / 2:
        return None  # a log of changes: a few quick ones, and single rows far apart
    return Bursts(np.asarray(last), within) if _steady(stamps_s, last) else None


def _finding(file: str, stamps_s: FloatArray, bursts: Bursts) -> Finding:
    last, within = bursts
    sizes, waits_s = np.diff(last), np.diff(stamps_s)[last[:-1]]
    several = sizes > 1  # of all but the first
    in_each, usual_s = float(sizes[several].mean()), float(np.median(waits_s[several]))
    others = (
        RECORDED * (within > AT_ONCE)
        + ROUNDED * (within == 0)
        + SEVERAL * (file == "images.csv")
        + TWO_OF_EACH * (file == "odometry.csv" and in_each < PAIRS)
    )
    return Finding(
        NAMES.get(file, "uneven_stamps"),
        Level.WARNING if usual_s > WARNED_S else Level.NOTE,
        f"rows of {file} come in {several.sum() + 1} bursts of {in_each:.1f} rows in the mean, "
        f"usually {usual_s:.2g} s and at most {waits_s.max():.2g} s apart",
        f"Either {ARRIVAL}{others}" if others else ARRIVAL.capitalize(),
        "Use the stamps of the sensor (header time), or spread the rows evenly",
    )


def _repeated(file: str, rows: int) -> Finding:
    return Finding(
        "repeated_rows",
        Level.NOTE,
        f"{counted(rows, 'row')} of {file} follow another at once, with its values",
        "Rows are written more than once",
        "Nothing to do: the first ones were used",
    )


def _steady(stamps_s: FloatArray, last: IntArray) -> bool:
    """Whether the last rows of bursts have stamps that count the rows before them."""
    off_s = []
    for rows in np.split(last, np.arange(PIECE, len(last), PIECE)):
        if len(rows) > PIECE // 2:
            even_s = np.polynomial.Polynomial.fit(rows, stamps_s[rows], 1)(rows)
            off_s.append(float(np.std(stamps_s[rows] - even_s)))
    return float(np.median(off_s)) < STEADY * float(np.diff(stamps_s[last]).mean())


def _go_on(places_m: FloatArray, last: IntArray) -> bool:
    """Whether places (M, 2) of one burst follow each other as those of two bursts do.

    Places of two sensors, which come together each time, lie side by side.
    """
    steps_m = np.diff(places_m, axis=0)
    after = last[1:-1][np.diff(last[:-1]) > 1]  # steps from one burst to the next
    to_next_m, within_m = steps_m[after], steps_m[after - 1]
    sizes_m = np.hypot(*to_next_m.T)
    if not np.isfinite(sizes_m).any():
        return False
    moving = sizes_m > MOVING * np.nanquantile(sizes_m, 0.9)
    if moving.sum() < OFTEN:
        return False
    shares = np.sum(within_m * to_next_m, axis=1)[moving] / sizes_m[moving] ** 2
    return bool(np.nanmedian(shares) > AS_FAR)


def _even_s(stamps_s: FloatArray, last: IntArray) -> FloatArray:
    """Rows of a burst spread evenly since the one before, no farther apart than rows usually are.

    Where rows are lost between two bursts the gap stays.
    """
    rows = np.arange(len(stamps_s))
    period_s = float(np.median(np.diff(stamps_s[last]) / np.diff(last)))
    own = last[np.searchsorted(last, rows)]  # the last row of the burst
    at_most_s = stamps_s[own] - period_s * (own - rows)
    after = rows > last[0]
    since_s = np.where(after, np.interp(rows, last, stamps_s[last]), at_most_s)
    return np.asarray(np.maximum(since_s, at_most_s))
