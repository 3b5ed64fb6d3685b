"""Speeds from encoder counts that wrapped: a counter of so many bits began anew."""

from collections.abc import Callable

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.checks.findings.undo import TREADS, changed, in_turn
from odometry.recording.run import Run

FAST, ORDINARY = 3.0, 0.9  # times the speed below which so many rows are
# Samples of one tread: six that come anywhere agree by REGULAR in one of 120 draws.
LEAST, MOST = 6, 0.1  # the most as a share of the rows
# Nine of ten of them are at most so far from the middle one, as a share of it: 0.013 and less of 52
# treads whose counts were wrapped.
ONE_SIZE = 0.03
# How far the ways at which they come agree, modulo their size (1: all of them): 0.92 and more of
# these 52. A placeholder has one size as well, and comes anywhere.
REGULAR = 0.9
# Share by which the wheel passes that place more or less often than samples are far off. A wheel
# that hardly goes on is near one place all the time.
OFTEN = 0.25


def unwrapped(run: Run) -> tuple[list[Finding], Run]:
    """What wrapped, and the run with the counts continued; the run itself where nothing did.

    The difference of two counts is off by the size of the counter where it began anew: a speed for
    one row, which comes each time the wheel has gone on by that size.
    """
    stamps_s = run.odometry.stamps_s
    before_s = np.diff(stamps_s, prepend=2 * stamps_s[0] - stamps_s[1])
    ways_m = {name: run.odometry[name] * before_s for name in TREADS}
    sizes_m = {name: _size_m(way_m) for name, way_m in ways_m.items()}
    found = {n: (_far(ways_m[n]), size_m) for n, size_m in sizes_m.items() if size_m is not None}
    if not found:
        return [], run
    seen = [
        f"{name} {counted(int(far.sum()), 'time')}, by {size_m:.4g} m"
        for name, (far, size_m) in found.items()
    ]
    far_s = stamps_s[np.any([far for far, _ in found.values()], axis=0)] - run.began_s
    finding = Finding(
        "counts_wrapped",
        Level.WARNING,
        f"tread speeds jump for one row, each time by one way and after one way: {'; '.join(seen)}",
        "Encoder counts wrapped (a counter of 16 bits, say, that overflows), and their differences "
        "were taken as they are",
        "Take the differences of counts modulo the size of the counter; the rest was judged "
        "with the size added",
        tuple((float(s), float(s)) for s in far_s),
    )
    mends = [
        changed("odometry", name, _continued(before_s, size_m))
        for name, (_, size_m) in found.items()
    ]
    return [finding], in_turn(*mends)(run)


def _far(way_m: FloatArray) -> BoolArray:
    """Rows (N,) of ways from row to row that are far longer than those of most rows."""
    sizes_m = np.abs(way_m)
    return np.asarray(sizes_m > FAST * np.quantile(sizes_m, ORDINARY))


def _size_m(way_m: FloatArray) -> float | None:
    """The way that a counter wraps by, where all that is far off in ways (N,) is; else None."""
    far = _far(way_m)
    if far.sum() < LEAST or far.mean() > MOST:
        return None
    rows = np.arange(len(way_m))
    usual_m = np.interp(rows[far], rows[~far], way_m[~far])
    sizes_m = np.abs(way_m[far] - usual_m)
    size_m = float(np.median(sizes_m))
    scatter = float(np.quantile(np.abs(sizes_m / size_m - 1), ORDINARY))
    times = np.cumsum(_added(way_m, size_m)) / size_m
    place = np.mean(np.exp(2j * np.pi * times[far]))
    passes = np.sum(np.diff(np.floor(times - np.angle(place) / (2 * np.pi))) != 0)
    as_often = abs(passes - far.sum()) <= max(1, OFTEN * far.sum())
    return size_m if scatter < ONE_SIZE and np.abs(place) > REGULAR and as_often else None


def _added(way_m: FloatArray, size_m: float) -> FloatArray:
    """Ways (N,) with the size of the counter added where they are far off."""
    return np.asarray(way_m - np.where(_far(way_m), np.sign(way_m) * size_m, 0.0))


def _continued(before_s: FloatArray, size_m: float) -> Callable[[FloatArray], FloatArray]:
    """Speeds (N,) of counts that go on."""
    return lambda values: np.asarray(_added(values * before_s, size_m) / before_s)
