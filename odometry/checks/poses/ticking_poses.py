"""Positions that jump at a regular beat: a receiver or a SLAM that corrects itself in steps."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.checks.poses.steps import without_window_changes

LEAST_M = 0.05  # of a jump, beyond what the treads moved on more than before and after
TIMES = (3.0, 4.0, 5.0, 6.0, 8.0, 10.0)  # the usual step beside others: the first that has a beat
STAYS = 0.75  # of a jump, that its neighbours are less than: an outlier goes out and back
LATE = 1.6  # usual periods, after which a step is that of lost rows
FEWEST, FEWEST_POSES = 10, 100
SHORTEST_ROWS, LONGEST_S = 4.0, 12.0  # of a beat
OVERSAMPLED = 4  # frequencies for each that the time distinguishes
ON_BEAT = 0.8  # mean resultant of the phases of jumps: their stamps are those of rows
HARMONIC = 0.9  # of the largest resultant: multiples of a frequency have one phase as well
# By which jumps times the squared resultant exceeds the logarithm of the frequencies tried: chance
# does so once in exp(SURELY) recordings.
SURELY = 12.0
MANY = 0.3  # share of the beats that have a jump
TOGETHER = 1000  # jumps whose phases are in memory at once
SHORTEST_S, LEAST_STEP_M = 1e-3, 1e-9  # against divisions by zero


class Beat(NamedTuple):
    """Jumps (K,) of rows of pose.csv at a beat."""

    period_s: float
    rows: IntArray
    sizes_m: FloatArray


def ticking_poses(evidence: Evidence) -> Iterator[Finding]:
    """A warning where positions jump at a regular beat, by more than the treads moved on."""
    pose, measured = evidence.run.pose, evidence.positions_measured
    if pose is None or measured is None:
        return
    rows = np.flatnonzero(measured)
    new = np.any(np.diff(pose.stack("x", "y")[rows], axis=0, prepend=np.inf) != 0, axis=1)
    rows = rows[new]  # held positions jump as well, once they go on
    if len(rows) < FEWEST_POSES:
        return
    stamps_s = pose.stamps_s[rows]
    positions = without_window_changes(evidence, rows, pose.stack("x", "y")[rows])
    beat = _beat(stamps_s, positions, evidence.travel_m(stamps_s))
    if beat is None:
        return
    at_s = stamps_s[beat.rows]
    yield Finding(
        "ticking_poses",
        Level.WARNING,
        f"positions jump by {float(np.median(beat.sizes_m)):.2g} m in the median, and stay, "
        f"{counted(len(at_s), 'time')} at a beat of {beat.period_s:.2g} s (first at "
        f"{evidence.run_time_s(at_s[0]):.1f} s), and the treads do not",
        "The reference corrects itself in steps: a receiver or a filter between its fixes, or a "
        "SLAM at its key frames or matches",
        "Record what the reference itself is sure of (its fixes, or the map once it is finished); "
        "`gap` may name these steps, not the robot",
    )


def _beat(stamps_s: FloatArray, positions: FloatArray, travel_m: FloatArray) -> Beat | None:
    """The beat at which positions (M, 2) jump from a row to the next, and stay; else None.

    A step beside those just before and after shows a jump as such, and both of these as half of it.
    It is measured along the way and across it, each by what is usual.
    """
    lasts_s, steps = np.diff(stamps_s), np.diff(positions, axis=0)
    beside_m, by_treads_m = _beside(steps, lasts_s), _beside(np.diff(travel_m)[:, None], lasts_s)
    size_m = np.hypot(*beside_m.T)
    odd = np.hypot(*_in_usual_ones(beside_m, steps[:-2] + steps[2:]).T)
    sudden = (
        (size_m - np.abs(by_treads_m[:, 0]) > LEAST_M)[1:-1]
        & (np.maximum(odd[:-2], odd[2:]) < STAYS * odd[1:-1])
        & (lasts_s[2:-2] < LATE * np.median(lasts_s))
    )
    for times in TIMES:
        rows = np.flatnonzero(sudden & (odd[1:-1] > times * np.median(odd))) + 3
        if len(rows) < FEWEST:
            return None
        at_s = stamps_s[rows] - stamps_s[rows[0]]
        beat_s, resultant, tried = _strongest(at_s, SHORTEST_ROWS * float(np.median(lasts_s)))
        surely = len(rows) * resultant**2 > np.log(tried) + SURELY
        if resultant > ON_BEAT and surely and len(rows) > MANY * at_s[-1] / beat_s:
            return Beat(beat_s, rows, size_m[rows - 2])
    return None


def _beside(steps: FloatArray, lasts_s: FloatArray) -> FloatArray:
    """What steps (M, D) are more than at the mean rate of those before and after, (M - 2, D)."""
    rates = steps / np.maximum(lasts_s, SHORTEST_S)[:, None]
    return np.asarray((rates[1:-1] - (rates[:-2] + rates[2:]) / 2) * lasts_s[1:-1, None])


def _in_usual_ones(vectors: FloatArray, ways: FloatArray) -> FloatArray:
    """Vectors (K, 2) along and across ways (K, 2), by the median size of each."""
    ways = ways / np.maximum(np.hypot(*ways.T), LEAST_STEP_M)[:, None]
    across = vectors[:, 1] * ways[:, 0] - vectors[:, 0] * ways[:, 1]
    parts = np.stack([np.sum(vectors * ways, axis=1), across], axis=-1)
    return np.asarray(parts / np.maximum(np.median(np.abs(parts), axis=0), LEAST_STEP_M))


def _strongest(at_s: FloatArray, shortest_s: float) -> tuple[float, float, int]:
    """The beat at which times (K,) have most nearly one phase, how nearly, and how many there are.

    The mean resultant of the phases is 1 where all are one (Rayleigh's test of a period).
    """
    step_hz = 1 / (OVERSAMPLED * at_s[-1])
    tried_hz = np.arange(1 / LONGEST_S, 1 / shortest_s, step_hz)
    if not len(tried_hz):
        return LONGEST_S, 0.0, 1
    resultants = resultants_of(at_s, tried_hz[0], step_hz, len(tried_hz))
    first = int(np.argmax(resultants > HARMONIC * resultants.max()))
    near = resultants[first : first + OVERSAMPLED + 1]
    best = first + int(np.argmax(near))
    return float(1 / tried_hz[best]), float(resultants[best]), len(tried_hz)


def resultants_of(at_s: FloatArray, first_hz: float, step_hz: float, count: int) -> FloatArray:
    """Mean resultants (count,) of the phases of times (K,) at frequencies in even steps.

    A phasor at a frequency is that of the first of some frequencies times that of the distance:
    so many exponentials are taken as two roots of their number, and the rest is a product.
    """
    together = math.isqrt(count) + 1
    firsts_hz = first_hz + together * step_hz * np.arange(math.ceil(count / together))
    apart_hz = step_hz * np.arange(together)
    sums = np.zeros((len(firsts_hz), together), np.complex128)
    for begin in range(0, len(at_s), TOGETHER):
        some_s = at_s[begin : begin + TOGETHER]
        firsts, apart = (np.exp(2j * np.pi * np.outer(hz, some_s)) for hz in (firsts_hz, apart_hz))
        sums += firsts @ apart.T
    return np.abs(sums).ravel()[:count] / len(at_s)
