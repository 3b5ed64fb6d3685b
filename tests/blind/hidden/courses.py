"""Courses in time and over the plane from which hidden effects are made."""

import math

import numpy as np
from scipy.signal import lfilter


def sign(rng):
    return float(rng.choice([-1.0, 1.0]))


def bursts(rng, clock, lasts_s, pauses_s):
    """Mask (N,) of stretches of lasts_s = (low, high), with pauses between, and the stretches."""
    mask, events = np.zeros(len(clock.times_s), dtype=bool), []
    begin = rng.uniform(*pauses_s)
    while begin < clock.duration_s:
        end = begin + rng.uniform(*lasts_s)
        mask |= (clock.times_s >= begin) & (clock.times_s < end)
        events.append([round(begin, 3), round(end, 3)])
        begin = end + rng.uniform(*pauses_s)
    return mask, events


def moment(rng, clock):
    """A moment in the middle 60 % of a run [s]."""
    return float(clock.duration_s * rng.uniform(0.2, 0.8))


def lagged(values, constant_s, step_s):
    """First-order low-pass of each column, from the first value."""
    kept = math.exp(-step_s / constant_s)
    begin = kept * values[:1]
    return lfilter([1 - kept], [1, -kept], values, axis=0, zi=begin)[0]


def delayed(values, delay_s, step_s):
    """Each row later, from the first value."""
    rows = round(delay_s / step_s)
    return np.concatenate([np.repeat(values[:1], rows, axis=0), values[: len(values) - rows]])


def wander(rng, clock, constant_s):
    """A smooth random course (N,) of unit variance."""
    white = rng.standard_normal(len(clock.times_s))
    smooth = lagged(lagged(white, constant_s, clock.step_s), constant_s, clock.step_s)
    return smooth / smooth.std()


def rates_of(values, step_s, over_s=0.1):
    """Rate of change of each column, smoothed."""
    return np.gradient(lagged(values, over_s, step_s), step_s, axis=0)


class Patches:
    """Patches of a size strewn over the plane; `cover` is about the share that they take."""

    def __init__(self, rng, size_m, cover):
        number = math.pi / size_m
        directions = rng.uniform(0, 2 * math.pi, 4)
        scales = rng.uniform(0.7, 1.4, 4)
        self.waves = [
            (number * s * math.cos(d), number * s * math.sin(d), p)
            for s, d, p in zip(scales, directions, rng.uniform(0, 6.28, 4), strict=True)
        ]
        grid = rng.uniform(-200, 200, (4000, 2))
        values = [self._height(x, y) for x, y in grid]
        self.threshold = float(np.quantile(values, 1 - cover))

    def _height(self, x, y):
        return sum(math.sin(a * x + b * y + p) for a, b, p in self.waves)

    def at(self, x, y):
        """Whether a point is on a patch, from 0 to 1 with a soft border."""
        return 1 / (1 + math.exp(-12 * (self._height(x, y) - self.threshold)))
