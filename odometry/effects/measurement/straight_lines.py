"""A reference that knows few poses, and draws straight lines between them."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.interface.base import Effect, EffectParameter
from odometry.effects.interface.recorded import Recorded, Reported
from odometry.effects.measurement.reference_filter import NO_INVERSE, ReferenceFilter

SHORTEST_S, LONGEST_S = 0.8, 5.0  # between fixes
BEND_S = 0.4  # to each side, over which a bend is measured
MOST_USUAL = 8.0  # of a bend: larger ones count as this
FINE = 6  # of the span of a run: over which a period is distinguished from the next
REFINED = np.linspace(-1.0, 1.0, 21)
SURE = 8.0  # standard deviations by which bends gather at the fixes
LEAST_BENDS = 4  # poses between two fixes, or they are fixes themselves
LEAST_POSES = 64  # of a run
TOGETHER = 64  # rates at a time
NORMAL = 1.4826  # standard deviations of the median absolute deviation


class StraightLines(ReferenceFilter):
    """Poses lie on straight lines between fixes at even intervals, which bends of the path show.

    No robot changes its velocity in every direction at even intervals alone.
    """

    form = "straight_lines"
    in_words = "poses of the reference that are drawn straight between few fixes"
    equation = "pose -> (1 - share) pose + share (a straight line from fix to fix)"
    source = "linear interpolation"
    looks_like = "a path of straight pieces of the same duration, in turns as well"
    remedy = "use the fixes alone: " + NO_INVERSE.split(": ")[0]
    needs = "several poses between two fixes"

    def __init__(self) -> None:
        self._fixes: dict[bytes, FloatArray] = {}

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Where the paths of all runs bend at even intervals."""
        found = [len(fixes_s(of.stamps_s, of.poses)) > 0 for of in recorded.reported]
        return (cls(),) if found and all(found) else ()

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("share", "", -0.5, 1.5, 0.0, 0.02),)

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: lines are drawn, or not."""
        return bool(values[0] > 0.5)

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`."""
        stamps_s = reported.stamps_s
        key = stamps_s.tobytes() + reported.poses.tobytes()
        if key not in self._fixes:
            self._fixes[key] = fixes_s(stamps_s, reported.poses)
        fixes = self._fixes[key]
        if not len(fixes):
            return poses
        at_fixes = [np.interp(fixes, stamps_s, column) for column in poses.T]
        lines = [np.interp(stamps_s, fixes, column) for column in at_fixes]
        return np.asarray(poses + values[0] * (np.column_stack(lines) - poses))


def fixes_s(stamps_s: FloatArray, poses: FloatArray) -> FloatArray:
    """Moments of fixes at even intervals, by where the path bends; none where it does not."""
    if len(stamps_s) < LEAST_POSES:
        return np.empty(0)
    spacing_s = float(np.median(np.diff(stamps_s)))
    lag = max(1, round(BEND_S / spacing_s))
    bends, at_s = _bends(poses, lag), stamps_s[lag:-lag]
    shortest_s = max(SHORTEST_S, LEAST_BENDS * spacing_s)
    step_hz = 1 / (FINE * float(np.ptp(at_s)))
    tried_hz = np.arange(1 / LONGEST_S, 1 / shortest_s, step_hz)
    _, _, rate_hz = _most_gathered(at_s, bends, tried_hz, spacing_s)
    near_hz = rate_hz + step_hz * REFINED
    sure, phase, rate_hz = _most_gathered(at_s, bends, near_hz, spacing_s)
    if sure < SURE:
        return np.empty(0)
    first = np.ceil(stamps_s[0] * rate_hz - phase)
    count = int(np.floor(stamps_s[-1] * rate_hz - phase) - first) + 1
    inner_s = (first + np.arange(count) + phase) / rate_hz
    return np.unique(np.concatenate([stamps_s[:1], inner_s, stamps_s[-1:]]))


def _bends(poses: FloatArray, lag: int) -> FloatArray:
    """By how much the path turns aside at each pose (M - 2 lag,), in what is usual, bounded."""
    changes = np.abs(poses[2 * lag :] - 2 * poses[lag:-lag] + poses[: -2 * lag])
    usual = np.maximum(NORMAL * np.median(changes, axis=0), np.finfo(float).tiny)
    return np.asarray(np.minimum(changes / usual, MOST_USUAL).sum(axis=1))


def _most_gathered(
    at_s: FloatArray, bends: FloatArray, tried_hz: FloatArray, spacing_s: float
) -> tuple[float, float, float]:
    """By how much bends are larger at one phase of a rate, in standard errors; phase and rate.

    Of the rates tried that at which they are largest.
    """
    usual = float(bends.mean()), float(bends.std())
    tried = [
        one
        for some in np.array_split(tried_hz, len(tried_hz) // TOGETHER + 1)
        for one in zip(*_largest(at_s, bends, some, spacing_s, usual), some.tolist(), strict=True)
    ]
    sure = max(size for size, _, _ in tried)
    alike = [one for one in tried if not one[0] < sure]
    return max((size, _phase(at_s, bends, near, of), of) for size, near, of in alike)


def _largest(
    at_s: FloatArray,
    bends: FloatArray,
    rates_hz: FloatArray,
    spacing_s: float,
    usual: tuple[float, float],
) -> tuple[list[float], BoolArray]:
    """By how much bends are larger at one phase of each rate (T,), and which are there (T, B)."""
    counts = np.maximum(4, (1 / (rates_hz * spacing_s)).astype(np.int64))
    ends = np.cumsum(counts)
    firsts = ends - counts
    turns = at_s * rates_hz[:, None]
    place = np.minimum(
        ((turns - np.floor(turns)) * counts[:, None]).astype(np.int64), counts[:, None] - 1
    )
    of_rate = (place + firsts[:, None]).ravel()
    sums = np.bincount(of_rate, np.tile(bends, len(rates_hz)), ends[-1])
    numbers = np.bincount(of_rate, minlength=ends[-1])
    after = np.arange(1, ends[-1] + 1)
    after[ends - 1] = firsts
    sums, numbers = sums + sums[after], np.maximum(numbers + numbers[after], 1)
    errors = np.maximum(usual[1] / np.sqrt(numbers), np.finfo(float).tiny)
    sizes = (sums / numbers - usual[0]) / errors
    best = [
        first + int(np.argmax(sizes[first:end])) for first, end in zip(firsts, ends, strict=True)
    ]
    chosen = (np.array(best) - firsts)[:, None]
    near = (place == chosen) | (place == (chosen + 1) % counts[:, None])
    return sizes[best].tolist(), near


def _phase(at_s: FloatArray, bends: FloatArray, near: BoolArray, rate_hz: float) -> float:
    """The mean phase of the larger ones of some bends."""
    phase = (at_s[near] * rate_hz) % 1.0
    weights = np.maximum(bends[near] - bends.mean(), 0.0)
    turned = np.angle(np.sum(weights * np.exp(2j * np.pi * phase)))
    return float(turned / (2 * np.pi) % 1.0)
