"""Rows of two sources in one table: two topics, two robots, or a command beside a speed."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level

FAR = 0.1  # of the ordinary fastest speed, between a row and the one before
NEAR = 0.15  # of that distance, to one of the rows before it
REACH = 4  # rows before: of a source that is so many times slower
OFTEN = 0.2  # share of the rows that are far: single zeros and outliers are fewer
MOST = 0.6  # of these, that return to a row before; of white noise a third does
SIDES = 0.2  # spread of both ends of the leaps, as a share of a leap
OTHERS = 0.05  # share of the rows that leap, and not to or from one value (a placeholder)
FINE = 1e-3  # of the fastest speed, within which two values are one level
STEPS = 6.0  # of coarse readings: these go to and fro between neighbouring values


def interleaved(evidence: Evidence) -> Iterator[Finding]:
    """Tread speeds that leap to and fro between two courses from row to row."""
    odometry, fastest_m_s = evidence.run.odometry, evidence.fastest_m_s
    if len(odometry) < 100 or fastest_m_s <= 0:
        return
    for name in ("v_left", "v_right"):
        values = np.asarray(odometry[name])
        if not np.isfinite(values).all():
            continue
        least = max(FAR * fastest_m_s, STEPS * _least_step(values, FINE * fastest_m_s))
        leaps, back = _leaps(values, least)
        if leaps.mean() > OFTEN and back[leaps].mean() > MOST and _two_courses(values, leaps):
            yield Finding(
                "interleaved_rows",
                Level.WARNING,
                f"{name} leaps away and back from row to row in {100 * leaps.mean():.0f} % of the "
                "rows, as if along two courses in turn",
                "Rows of two sources are mixed in odometry.csv (two topics or publishers, two "
                "robots, commands beside measured speeds, two recordings), or out of order",
                "Write the rows of one source alone; its stamps tell them apart",
            )
            return


def _leaps(values: FloatArray, least: float) -> tuple[BoolArray, BoolArray]:
    """Rows (N - REACH,) far from the one before, and those near to one of the rows before that."""
    earlier = np.stack([values[REACH - k : len(values) - k] for k in range(1, REACH + 1)])
    away = np.abs(values[REACH:] - earlier)
    return away[0] > least, away[1:].min(axis=0) < NEAR * away[0]


def _two_courses(values: FloatArray, leaps: BoolArray) -> bool:
    """Whether what leaps varies on both sides, apart from one value: zeros amid motion are one."""
    rows = np.flatnonzero(leaps) + REACH
    pairs = np.sort(np.stack([values[rows], values[rows - 1]]), axis=0)
    found, counts = np.unique(pairs, return_counts=True)
    low, high = pairs[:, (pairs != found[np.argmax(counts)]).all(axis=0)]
    if len(low) < OTHERS * len(leaps):
        return False
    return bool(min(_spread(low), _spread(high)) > SIDES * np.median(high - low))


def _spread(values: FloatArray) -> float:
    return float(np.diff(np.quantile(values, [0.1, 0.9]))[0])


def _least_step(values: FloatArray, fine: float) -> float:
    """The step to which values were rounded: the usual distance of two neighbouring levels."""
    steps = fine * np.diff(np.unique(np.round(values / fine)))
    return float(np.median(steps)) if len(steps) else 0.0
