"""Errors of positions that last, by how far positions wander while the treads stand."""

import math
from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.estimation.watches.rest_watch import STILL_M_S
from odometry.recording.run import Run
from odometry.windows.recorded.interpolated import interpolated
from odometry.windows.recorded.spans import runs_of

SETTLED_S = 2.0  # after that a robot that braked, and positions that are late, are stationary too
PIECE_S = (3.0, 20.0)  # shortest and longest time at rest that counts as one
FEWEST = 4  # positions of a piece
STOPS = 3  # at one the robot may have been pushed
LASTING_S = 60.0  # how long errors of satellites and their receivers last
SIGMAS = 3.0  # of the median, by which ways must be more than scatter makes them
MEDIAN = math.log(2.0)  # of an exponential distribution of mean 1, as of squares in a plane


def wander_sigma_m(run: Run, stamps_s: FloatArray, positions_m: FloatArray) -> float | None:
    """Standard deviation of errors that last, per axis, by what positions do at rest.

    A robot whose treads stand does not move, so that a way between the means of the first and
    the second half of a piece of such time is an error of the positions. As a random walk it has
    a variance of a third of the walk's over the piece, beside that of the scatter. The median over
    the pieces counts: at a few of them the robot may have been pushed. Errors that are forgotten
    after `LASTING_S` and walk so fast have the standard deviation that is given. Positions
    that repeat the one before, or were interpolated, do not count: a receiver that holds its
    position at rest says nothing.

    Positions (M, 2) [m] are at ascending stamps (M,).

    Returns
    -------
    float or None
        0 where scatter explains the ways within `SIGMAS`. None where fewer than `STOPS` stops have
        a piece of `FEWEST` positions.
    """
    new = np.append(True, (np.diff(positions_m, axis=0) != 0).any(axis=1))
    new &= ~interpolated(stamps_s, positions_m)
    stamps_s, positions_m = stamps_s[new], positions_m[new]
    stops = [
        [
            _walks_m2_s(stamps_s[piece], positions_m[piece])
            for piece in _pieces(stamps_s, *span_s)
            if len(piece) >= FEWEST
        ]
        for span_s in _at_rest(run)
    ]
    walks = np.array([each for stop in stops for each in stop])
    if sum(map(bool, stops)) < STOPS:
        return None
    way, scatter = np.median(walks, axis=0) / (MEDIAN, 1.0)
    is_sure = way > scatter * (1 + SIGMAS / (MEDIAN * math.sqrt(len(walks))))
    return math.sqrt(float(way - scatter) * LASTING_S / 2) if is_sure else 0.0


def _at_rest(run: Run) -> Iterator[tuple[float, float]]:
    """From when to when the treads stand for long, without the time in which a robot settles."""
    at_s = run.odometry.stamps_s
    still = np.abs(run.odometry.stack("v_left", "v_right")).max(axis=1) <= STILL_M_S
    for first, end in runs_of(still):
        from_s, to_s = at_s[first] + SETTLED_S, at_s[end - 1]
        if to_s - from_s >= PIECE_S[0]:
            yield float(from_s), float(to_s)


def _pieces(stamps_s: FloatArray, from_s: float, to_s: float) -> list[IntArray]:
    """Rows of the pieces of a time at rest."""
    first, end = np.searchsorted(stamps_s, from_s), np.searchsorted(stamps_s, to_s, side="right")
    return np.array_split(np.arange(first, end), max(1, math.ceil((to_s - from_s) / PIECE_S[1])))


def _walks_m2_s(stamps_s: FloatArray, positions_m: FloatArray) -> tuple[float, float]:
    """How fast the variance of positions (K, 2) grows, per axis, and what scatter adds to it."""
    half = len(stamps_s) // 2
    way_m = positions_m[-half:].mean(axis=0) - positions_m[:half].mean(axis=0)
    scatter_m2 = np.mean(np.diff(positions_m, axis=0) ** 2) / 2  # of one position
    per_s = 3 / float(stamps_s[-1] - stamps_s[0])
    return per_s * float(np.mean(way_m**2)), per_s * float(2 * scatter_m2 / half)
