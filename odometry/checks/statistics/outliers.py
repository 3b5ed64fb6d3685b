"""Single samples and poses that a robot cannot have driven: outliers that come back at once."""

import itertools

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.windows.recorded.in_motion import moving_samples
from odometry.windows.recorded.spans import runs_of

NEIGHBOURS = 4.0  # a spike exceeds both neighbours by this many ordinary steps (99 in 100)
OF_FASTEST = 0.6  # and by this share of the ordinary fastest value (99 in 100)
OF_FASTEST_ALONE, BACK = 0.5, 0.5  # the same of one sample, and how near its neighbours are
LONGEST = 3  # samples of a spike or poses of an outlier: a longer one is a jump
FAR_TIMES = 20.0  # a placeholder (-999) for what was not measured is so far above all speeds
MOST_FAR = 0.1  # share of the samples
REACH = 5  # poses to each side whose median is compared
LEAST_M = 0.5
TIMES = 8.0  # the usual distance from that median
# Of positions that go out by one step and come back by another: seconds, and what both leave of it.
EXCURSION_S, LEFT, LEAST_STEP_M = 5.0, 0.3, 1.0


def spikes(values: FloatArray) -> BoolArray:
    """Which of the samples (N,) go out and come back at once, far beyond what is usual.

    A step that stays is none: treads start and stop, and latched speeds jump.
    """
    if len(values) < 10:
        return np.zeros(len(values), dtype=np.bool_)
    far = _far_off(values)
    if far.any():
        rows = np.arange(len(values))
        return np.asarray(far | spikes(np.interp(rows, rows[~far], values[~far])))
    sizes, steps = np.abs(values), np.abs(np.diff(values))
    moves = moving_samples(sizes)
    ordinary = min(0.99, 1 - 2 * LONGEST / max(int(moves.sum()), 10))  # one spike is not ordinary
    fastest = np.quantile(sizes[moves], ordinary)
    usual_step = np.quantile(steps[moves[1:] | moves[:-1]], ordinary)
    least = max(NEIGHBOURS * float(usual_step), OF_FASTEST * float(fastest), 1e-9)
    found = np.zeros(len(values), dtype=np.bool_)
    lowest = highest = values[1:-1]  # of so many samples from each on
    for length in range(1, LONGEST + 1):
        before, after = values[: -length - 1], values[length + 1 :]
        higher = lowest - np.maximum(before, after)
        lower = np.minimum(before, after) - highest
        begins = np.flatnonzero(np.maximum(higher, lower) > least) + 1
        for offset in range(length):
            found[begins + offset] = True
        lowest = np.minimum(lowest[:-1], values[length + 1 : -1])
        highest = np.maximum(highest[:-1], values[length + 1 : -1])
    return found


def _far_off(values: FloatArray) -> BoolArray:
    """Which samples (N,) are far above all others, for a moment each, however often: a placeholder.

    Their size is on the other side of a gap that no other sample lies in.
    """
    size = np.sort(np.abs(values))
    top = size[int((1 - MOST_FAR) * len(size)) :]
    gaps = np.flatnonzero((top[1:] > FAR_TIMES * top[:-1]) & (top[:-1] > 0))
    if not len(gaps):
        return np.zeros(len(values), dtype=np.bool_)
    far = np.abs(values) > top[gaps[-1]]
    return far if np.diff(runs_of(far), axis=1).max() <= LONGEST else np.zeros_like(far)


def peaks(values: FloatArray, fastest: float) -> BoolArray:
    """Which samples (N,) alone go out and back by half of the fastest value, however often.

    Zeros are no peaks: samples may be lost.
    """
    off = values[1:-1] - np.stack([values[:-2], values[2:]])
    least = np.abs(off).min(axis=0)
    alone = (off[0] * off[1] > 0) & (least > OF_FASTEST_ALONE * fastest)
    alone &= (np.abs(off[0] - off[1]) < BACK * least) & (values[1:-1] != 0)
    return np.concatenate([[False], alone, [False]])


def without_spikes(values: FloatArray) -> FloatArray:
    """The values (N,) with spikes replaced by a line between their neighbours."""
    odd = spikes(values) | ~np.isfinite(values)
    if not odd.any() or odd.all():
        return values
    rows = np.arange(len(values))
    return np.asarray(np.interp(rows, rows[~odd], values[~odd]))


def pose_outliers(positions: FloatArray) -> BoolArray:
    """Which positions (M, 2) are far from the median of their neighbours, for a few poses.

    While the robot drives, the median of its neighbours is where it is: only what leaves the way
    and comes back differs from it.
    """
    count = len(positions)
    if count < 2 * REACH + 1:
        return np.zeros(count, dtype=np.bool_)
    padded = np.concatenate(
        [np.repeat(positions[:1], REACH, 0), positions, np.repeat(positions[-1:], REACH, 0)]
    )
    around = np.lib.stride_tricks.sliding_window_view(padded, 2 * REACH + 1, axis=0)
    away = np.hypot(*(positions - np.median(around, axis=-1)).T)
    steps = np.hypot(*np.diff(positions, axis=0).T)
    moves = moving_samples(steps)
    step = float(np.quantile(steps[moves], 0.9))
    usual = 1.4826 * float(np.median(away[1:][moves]))
    far = away > max(TIMES * usual, 3 * step, LEAST_M * _unit(step))
    edges = np.diff(np.concatenate([[False], far, [False]]).astype(np.int8))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    found = np.zeros(count, dtype=np.bool_)
    for begin, end in zip(begins, ends, strict=True):
        short = end - begin <= LONGEST
        found[begin:end] = short and _comes_back(positions, away, int(begin), int(end))
    return found


def excursions(stamps_s: FloatArray, positions: FloatArray) -> BoolArray:
    """Which positions (M, 2) lie between a large step and one that takes it back in some seconds.

    The reference was elsewhere for a while, as by another fix; the robot was not.
    """
    found = np.zeros(len(positions), dtype=np.bool_)
    if len(positions) < 2 * REACH + 1:
        return found
    steps = np.diff(positions, axis=0)
    sizes = np.hypot(*steps.T)
    ordinary = float(np.quantile(sizes[moving_samples(sizes)], 0.9))
    far = np.flatnonzero(sizes > max(TIMES * ordinary, LEAST_STEP_M * _unit(ordinary)))
    for out, back in itertools.pairwise(far.tolist()):
        left = float(np.hypot(*(steps[out] + steps[back])))
        soon = stamps_s[back] - stamps_s[out] < EXCURSION_S
        if soon and not found[out] and left < LEFT * min(sizes[out], sizes[back]):
            found[out + 1 : back + 1] = True
    return found


def _comes_back(positions: FloatArray, away: FloatArray, begin: int, end: int) -> bool:
    """Whether the poses beside a span are near each other: else the robot drove on."""
    if begin == 0 or end == len(positions):
        return True
    apart = float(np.hypot(*(positions[end] - positions[begin - 1])))
    return apart < float(away[begin:end].max())


def _unit(step: float) -> float:
    """A metre in the unit of the positions, as far as their steps show: it may be wrong."""
    return 1.0 if 1e-3 < step < 10 else step
