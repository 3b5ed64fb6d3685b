"""A latency over a recording: whether it changes, and how.

Lags of short pieces are fitted by a constant, by one that grows, from or until a moment or all the
time, by a step, and by broken lines of more and more knots. Schwarz's criterion with an unknown
variance (Schwarz 1978) judges between these; outlying pieces weigh less (Huber 1964).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.statistics.lag import Lags

CONSTANT, LINE, STEP, COURSE = "constant", "line", "step", "course"
OWN_S = 0.02  # by which lags of pieces of good recordings differ though noise explains less
FEWEST, AT_EDGE = 6, 2  # pieces, and of them that a change at either end has at least
ALONE = 5.0  # times the usual difference of neighbours
# By which a step must be better than what changes slowly: "strong" (Kass and Raftery 1995). Of 40
# steps that were made 37 were better by as much, of 12 other courses three.
STRONGLY = 6.0
KNOTS = (3, 4, 5, 7, 9, 13, 17)
PER_KNOT = 3  # pieces
HUBER, ROUNDS = 1.5, 8


@dataclass(frozen=True)
class LatencyCourse:
    """A latency over a recording.

    Attributes
    ----------
    kind : str
        CONSTANT, LINE (all the time), STEP or COURSE (anything else).
    stamps_s, seconds, sigmas_s : (K,)
        The latency at some stamps, between which it is a line, and its standard deviations.
    gain : float
        By how much Schwarz's criterion prefers it to a constant.
    scatter_s : float
        Standard deviation of a piece's lag beside it.
    moment_s : float
        Stamp of a step.
    """

    kind: str
    stamps_s: FloatArray
    seconds: FloatArray
    sigmas_s: FloatArray
    gain: float
    scatter_s: float
    moment_s: float

    @property
    def extent_s(self) -> float:
        """Between the largest and the smallest latency."""
        return float(np.ptp(self.seconds))

    def at(self, stamps_s: FloatArray) -> FloatArray:
        """The latency at other stamps (N,), beyond the ends that of the ends."""
        if self.kind == STEP:
            later = stamps_s > self.moment_s
            return np.asarray(np.where(later, self.seconds[-1], self.seconds[0]))
        return np.asarray(np.interp(stamps_s, self.stamps_s, self.seconds))


@dataclass(frozen=True)
class _Fit:
    kind: str
    chi2: float
    seconds: FloatArray
    sigmas_s: FloatArray
    unknowns: int
    moment_s: float

    def score(self, pieces: int) -> float:
        """Schwarz's criterion, with what few pieces lack (Hurvich and Tsai 1989)."""
        few = pieces / max(pieces - self.unknowns - 1, 1)
        variance = max(self.chi2 / pieces, 1.0)  # none is less than lags have of their own
        return float(pieces * np.log(variance) + self.unknowns * np.log(pieces) * few)


def latency_course(lags: Lags) -> LatencyCourse | None:
    """The likeliest course of a latency; None of too few pieces."""
    lags = _confirmed(lags)
    count = len(lags.lags_s)
    if count < FEWEST:
        return None
    fits = [_fit(lags, *shape) for shape in _shapes(lags.middles_s)]
    steps = [fit for fit in fits if fit.kind == STEP]
    best, step = (
        min(of, key=lambda fit: fit.score(count))
        for of in ([fit for fit in fits if fit.kind != STEP], steps)
    )
    if step.score(count) < best.score(count) - STRONGLY:
        best = step
    scale = np.sqrt(best.chi2 / max(count - best.unknowns, 1))
    return LatencyCourse(
        best.kind,
        lags.middles_s,
        best.seconds,
        scale * best.sigmas_s,
        float(fits[0].score(count) - best.score(count)),
        float(scale * np.median(np.hypot(lags.sigmas_s, OWN_S))),
        best.moment_s,
    )


def _confirmed(lags: Lags) -> Lags:
    """The pieces with a lag like that of a neighbour: one piece alone shows no change."""
    if len(lags.lags_s) < FEWEST:
        return lags
    apart_s = np.abs(np.diff(lags.lags_s))
    near = apart_s < ALONE * max(float(np.median(apart_s)), OWN_S)
    kept = np.append(near, False) | np.append(False, near)
    return Lags(*(of[kept] for of in lags))


def _shapes(stamps_s: FloatArray) -> Iterator[tuple[str, FloatArray, int, float]]:
    """Name, columns (K, C), unknowns and moment of what is tried; the constant first."""
    count, one = len(stamps_s), np.ones(len(stamps_s))
    along = (stamps_s - stamps_s[0]) / np.ptp(stamps_s)
    yield CONSTANT, one[:, None], 1, np.nan
    yield LINE, np.stack([one, along], axis=1), 2, np.nan
    for row in range(AT_EDGE, count - AT_EDGE + 1):
        later = (np.arange(count) >= row).astype(float)
        moment_s = float(stamps_s[row - 1 : row + 1].mean())
        yield STEP, np.stack([one, later], axis=1), 3, moment_s
    for place in along[AT_EDGE : count - AT_EDGE]:
        for side in (-1, 1):
            turned = np.maximum(side * (along - place), 0)
            yield COURSE, np.stack([one, turned], axis=1), 3, np.nan
    for knots in KNOTS:
        if count >= PER_KNOT * knots:
            at = np.linspace(0, 1, knots)
            hats = np.stack([np.interp(along, at, of) for of in np.eye(knots)], axis=1)
            yield COURSE, hats, knots, np.nan


def _fit(lags: Lags, kind: str, columns: FloatArray, unknowns: int, moment_s: float) -> _Fit:
    of, covariance, chi2 = fitted(lags, columns)
    spread_s = np.sqrt(np.einsum("ij,jk,ik->i", columns, covariance, columns))
    return _Fit(kind, chi2, columns @ of, spread_s, unknowns, moment_s)


def fitted(lags: Lags, columns: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Factors (C,) of columns (K, C), their covariance, and Huber's chi-squared."""
    sigmas_s = np.hypot(lags.sigmas_s, OWN_S)
    weights = 1 / sigmas_s
    for _ in range(ROUNDS):
        weighed = columns * weights[:, None]
        of, *_rest = np.linalg.lstsq(weighed, lags.lags_s * weights, rcond=None)
        off = np.abs(lags.lags_s - columns @ of) / sigmas_s
        weights = np.sqrt(np.minimum(1, HUBER / np.maximum(off, HUBER))) / sigmas_s
    inside = np.minimum(off, HUBER)
    chi2 = float(np.sum(inside * (2 * off - inside)))
    return np.asarray(of, float), np.asarray(np.linalg.pinv(weighed.T @ weighed), float), chi2
