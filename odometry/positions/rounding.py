"""Positions that were rounded: the step of the grid on which they lie.

Positions of step g have residues modulo g that agree, which a mean of unit phasors measures: the
quantogram of Kendall 1974 (Phil. Trans. R. Soc. A 276, 231), of all steps at once by a Fourier
transform. A robot that rests, or drives the same lanes again, agrees by itself: what counts is by
how much positions agree more than the mean of their neighbours does, while the robot moves.
"""

import math
from collections.abc import Callable

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray

LEAST_STEP_M, MOST_STEP_M = 0.02, 1.5  # that are looked for
BANDS = 19
BAND = (MOST_STEP_M / LEAST_STEP_M) ** (1 / BANDS)  # of steps that are tried together
BIN = 1 / 16  # of the least step of a band
PARTS = 8  # of the bins of a band, every eighth: the steps of a band need no shorter transform
FINER = 4  # frequencies than positions resolve
MOST_BINS = 2**17  # of a transform: steps of 0.02 m are looked for on 160 m, of 0.5 m on 4 km
MANY_CHANGES = 20  # of a coordinate, that are whole multiples of the least
FEWEST_CHANGES = 6  # the same where values are repeated: steady speeds of a simulation are not
REPEATED = 0.5  # of the rows
AROUND_S = 1.0  # to each side of a position, of its neighbours
LEAST_MOVED = 2.0  # steps that the neighbours of a position must span
LEAST_POSES = 40  # of which these are
LEAST_AGREEMENT = float(np.exp(-(np.pi**2) / 6))  # that noise as large as that of rounding leaves
BY_CHANCE = 1e-6  # probability of as good an agreement of any step
AS_GOOD = 0.9  # of the best agreement: the largest such step is the one, its parts agree, too


def rounding_step_m(stamps_s: FloatArray, positions: FloatArray) -> float:
    """Step of the grid on which positions (M, 2) lie, that of the coarser axis; 0 without one.

    Each axis along which the robot moved enough must show one. A grid that was turned after
    positions were rounded is not found, nor one that is finer than 1 in 8,000 of the way between
    the outermost positions.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(0.0, 120.0, 0.1)
    >>> path = np.column_stack([8 * np.cos(t / 20), 8 * np.sin(t / 20)])
    >>> measured = np.round(path / 0.05) * 0.05
    >>> round(rounding_step_m(t, measured), 4), rounding_step_m(t, path)
    (0.05, 0.0)
    """
    found = [step for axis in positions.T if (step := _step_of(stamps_s, axis)) is not None]
    return max(found) if found and min(found) > 0 else 0.0


def steps_m(stamps_s: FloatArray, positions: FloatArray) -> FloatArray:
    """Steps (2,) of x and y of which all positions (M, 2) are multiples; else of `rounding_step_m`.

    Zeros where there are none.
    """
    exact = exact_steps_m(positions)
    if exact.any() or len(positions) <= FEWEST_CHANGES:
        return exact
    new = np.append(True, np.diff(positions, axis=0).any(axis=1))
    return np.full(2, rounding_step_m(stamps_s[new], positions[new]))


def exact_steps_m(positions: FloatArray) -> FloatArray:
    """Steps (2,) of x and y of which all positions (M, 2) are multiples; zeros without.

    Where values are repeated in most rows, a coordinate that hardly changes has the step of the
    other one.
    """
    if len(positions) <= FEWEST_CHANGES:
        return np.zeros(2)
    changes = np.abs(np.diff(positions, axis=0))
    least = 1e-9 * np.maximum(1.0, np.abs(positions).max(axis=0))
    repeated = (changes <= least).mean(axis=0) >= REPEATED
    exact = [
        _multiples_of(column[column > above], FEWEST_CHANGES if often else MANY_CHANGES)
        for column, above, often in zip(changes.T, least, repeated, strict=True)
    ]
    known = [step for step in exact if step is not None]
    if known and min(known) > 0 and (len(known) == 2 or repeated.all()):
        return np.array([max(known) if step is None else step for step in exact])
    return np.zeros(2)


def _multiples_of(changes: FloatArray, fewest: int) -> float | None:
    """The step of which changes (K,) of a coordinate are multiples.

    0 without one; None where there are fewer changes.
    """
    if len(changes) < fewest:
        return None
    step = float(changes.min())
    counts = changes / step
    whole = np.abs(counts - np.round(counts)) < 0.02
    small = changes < 10 * step
    return step if whole[small].mean() > 0.98 and small.mean() > 0.3 else 0.0


def _step_of(stamps_s: FloatArray, places_m: FloatArray) -> float | None:
    """Step of one axis (M,); 0 without one, None where the robot moved too little to say."""
    means, spans = _neighbours(stamps_s, places_m)
    decided, best, step = False, 0.0, 0.0
    for least in np.geomspace(LEAST_STEP_M, MOST_STEP_M, BANDS + 1)[:-1]:
        used = spans > LEAST_MOVED * BAND * least
        count = np.count_nonzero(used)
        if count < LEAST_POSES or _bins(places_m[used], means[used], least) > MOST_BINS:
            continue
        decided = True
        steps, agreement_of = _band(places_m[used], means[used], least)
        agreement = agreement_of(places_m[used])
        by_chance = float(np.sqrt(np.log(BANDS * len(steps) / BY_CHANCE) / count))
        needed = max(LEAST_AGREEMENT, by_chance)
        if agreement.max() <= needed:
            continue  # whatever the neighbours do
        sure = agreement - agreement_of(means[used]) > needed
        place = int(np.argmax(np.where(sure, agreement, 0.0)))
        if sure[place] and agreement[place] > AS_GOOD * best:
            best, step = max(best, float(agreement[place])), float(steps[place])
    return step if decided else None


def _band(
    places_m: FloatArray, means_m: FloatArray, least_m: float
) -> tuple[FloatArray, Callable[[FloatArray], FloatArray]]:
    """Steps (F,) of a band, and how well places (M,) or their means agree with each."""
    origin, width = float(min(places_m.min(), means_m.min())), BIN * least_m
    size = 1 << math.ceil(math.log2(FINER * _bins(places_m, means_m, least_m)))
    waves = np.arange(int(BIN * size / BAND), int(BIN * size) + 1)
    frequencies = waves * (1 / (size * width))
    inside = (frequencies > 1 / (BAND * least_m)) & (frequencies <= 1 / least_m)
    waves = waves[inside]
    return 1 / frequencies[inside], lambda of: np.abs(_phasors(of - origin, width, size, waves))


def _bins(places_m: FloatArray, means_m: FloatArray, least_m: float) -> int:
    """How many bins of a band reach from the least to the greatest of places and means."""
    return int(np.ptp(np.concatenate([places_m, means_m])) / (BIN * least_m)) + 1


def _phasors(places_m: FloatArray, width_m: float, size: int, waves: IntArray) -> AnyArray:
    """Means (F,) of unit phasors of places, of so many waves (F,) on all bins."""
    counts = np.bincount((places_m / width_m).astype(np.int64), minlength=size)
    parts = np.fft.rfft(counts.reshape(-1, PARTS), axis=0)[waves]
    turn = np.exp(-2j * np.pi / size * waves)  # from one part to the next
    phasors = parts[:, -1]
    for part in parts[:, -2::-1].T:
        phasors = phasors * turn + part
    return phasors / len(places_m)


def _neighbours(stamps_s: FloatArray, places_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean (M,) of the places around each without itself, and the way between the outermost."""
    first = np.searchsorted(stamps_s, stamps_s - AROUND_S)
    last = np.searchsorted(stamps_s, stamps_s + AROUND_S, side="right") - 1
    rows = np.arange(len(stamps_s))
    half = np.maximum(1, np.minimum(rows - first, last - rows))
    first, last = np.maximum(rows - half, 0), np.minimum(rows + half, len(rows) - 1)
    summed = np.concatenate([[0.0], np.cumsum(places_m)])
    means = (summed[last + 1] - summed[first] - places_m) / np.maximum(last - first, 1)
    return means, np.abs(places_m[last] - places_m[first])
