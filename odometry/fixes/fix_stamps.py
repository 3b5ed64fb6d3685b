"""Stamps of a CSV file in seconds: numbers of any usual unit, or dates of ISO 8601."""

import math
from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from odometry.arrays import FloatArray

UNITS_S = {
    **dict.fromkeys(("s", "sec", "secs", "seconds"), 1.0),
    **dict.fromkeys(("ms", "msec", "milliseconds"), 1e-3),
    **dict.fromkeys(("us", "usec", "microseconds"), 1e-6),
    **dict.fromkeys(("ns", "nsec", "nanoseconds"), 1e-9),
}
# Between rows, in seconds; units differ by 1000, so that two of them are possible at the most
LEAST_S, MOST_S = 0.005, 60.0
SINCE_1970_S = (1e9, 4e9)  # 2001 to 2096


def unit_s(values: FloatArray, said: str, lasts_s: float | None = None) -> float | None:
    """Seconds of one unit of stamps (N,): that which the name says, or with a likely period.

    Where two units have one: that in which they count from 1970; else that in which they last
    nearly as long as `lasts_s`; else the one of the shorter period. None where no unit has one.
    """
    if said in UNITS_S:
        return UNITS_S[said]
    values = values[np.isfinite(values)]
    steps = np.abs(np.diff(values))
    steps = steps[steps > 0]
    if not len(steps):
        return None
    period, middle = float(np.median(steps)), float(np.median(values))
    likely = [unit for unit in (1.0, 1e-3, 1e-6, 1e-9) if LEAST_S <= unit * period < MOST_S]
    least_s, most_s = SINCE_1970_S
    epoch = [unit for unit in likely if least_s <= unit * middle <= most_s]
    if epoch or lasts_s is None or len(likely) < 2:
        return next(iter(epoch or likely[::-1]), None)
    span = float(np.ptp(values))
    return min(likely, key=lambda unit: abs(math.log(unit * span / lasts_s)))


def is_date(cell: str) -> bool:
    """Whether a cell is a date with a time, as ISO 8601 or with strokes between the numbers."""
    return date_s(cell) is not None


def date_s(cell: str) -> float | None:
    """Seconds since 1970 of a date with a time; UTC where it names no zone. None of other text."""
    text = cell.strip().replace("/", "-").removesuffix(" UTC")
    if ":" not in text or "-" not in text:
        return None
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        return None
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()


def name_no_zone(cells: Sequence[str]) -> bool:
    """Whether the first of these dates has no time zone."""
    text = cells[0].strip().replace("/", "-")
    return not text.endswith(("Z", "UTC")) and datetime.fromisoformat(text).tzinfo is None
