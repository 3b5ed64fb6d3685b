"""The yaw rate of a gyroscope less its bias, which positions determine."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from odometry.arrays import ComplexArray, FloatArray, IntArray
from odometry.recording.sensors import gyroscope_of
from odometry.windows.recorded.record import Record

LARGEST_BIAS_RAD_S = 0.04
COARSE, FINE = 41, 21  # numbers of biases
LENGTH_M = 80.0  # of the pieces of path that are compared: of 5 to 80 m the best on 19 recordings
TINY = np.finfo(float).tiny
LONGEST_SILENCE_S = 1.0  # of the gyroscope, over all of the run


def yaw_rates_of(record: Record) -> FloatArray | None:
    """Yaw rate (N,) in force at each sample, less the bias; None without a gyroscope.

    The bias is that with which the path of mean tread speed and this yaw rate has the shape of
    the measured positions, over pieces of LENGTH_M, each with slip and lever arms of its own.
    """
    gyroscope = gyroscope_of(record.run.yaw_rate)
    if gyroscope is None:
        return None
    stamps_s = record.stamps_s
    turn, _, _, silent_s = gyroscope.between(stamps_s[:-1], stamps_s[1:])
    if silent_s.sum() > LONGEST_SILENCE_S:
        return None
    steps_s = np.diff(stamps_s)
    rates = np.append(turn / steps_s, 0.0)
    speeds = record.inputs.tread_speeds_m_s.mean(axis=1)

    shape = PathShape(record, (LENGTH_M,))

    def best_of(biases: FloatArray) -> float:
        misfits = [shape.misfits_m(speeds, shape.turned(rates - bias))[0] for bias in biases]
        return float(biases[np.argmin(misfits)])

    tried = np.linspace(-LARGEST_BIAS_RAD_S, LARGEST_BIAS_RAD_S, COARSE)
    step = tried[1] - tried[0]
    return np.asarray(rates - best_of(best_of(tried) + np.linspace(-step, step, FINE)))


class PathShape:
    """The shape of measured positions over pieces of path of some lengths [m].

    Each piece is of one stretch of the record.
    """

    def __init__(self, record: Record, lengths_m: Sequence[float]) -> None:
        places = record.poses[:, 0] + 1j * record.poses[:, 1]
        self._samples = record.pose_samples
        self._steps_s = np.append(np.diff(record.stamps_s), 0.0)
        travel_m = record.travel_m[record.pose_samples]
        self._pieces = [
            _Pieces.of(np.floor(travel_m / each) + 1e6 * record.stretch) for each in lengths_m
        ]
        self._measured = [_centred(places, piece) for piece in self._pieces]

    def turned(self, rates_rad_s: FloatArray) -> "Turned":
        """What yaw rates (N,) alone make of a path."""
        per_speed = _per_speed(rates_rad_s, self._steps_s)
        path = self._path(rates_rad_s * per_speed)
        return Turned(per_speed, [_centred(path, pieces) for pieces in self._pieces])

    def misfits_m(self, speeds_m_s: FloatArray, turned: "Turned") -> FloatArray:
        """Sums (L,) of distances [m] between the positions and the path of yaw rates (N,).

        See `of_pieces`.
        """
        of_pieces = self.of_pieces(speeds_m_s, turned)
        return np.array([distances.sum() for distances, _ in of_pieces])

    def of_pieces(
        self, speeds_m_s: FloatArray, turned: "Turned"
    ) -> list[tuple[FloatArray, IntArray]]:
        """For each length, sums (P,) of distances [m] of its pieces, and of how many positions.

        The body moves by a share of the mean tread speeds (N,), and, forward and aside, by a
        length times the yaw rate: that holds for any tread ICRs and any place of the antenna. Each
        piece has a share and lengths of its own.
        """
        path = self._path(speeds_m_s * turned.per_speed)
        found = []
        each = zip(self._measured, self._pieces, turned.paths, strict=True)
        for measured, pieces, turning in each:
            distances = _distances(measured, _centred(path, pieces), turning, pieces)
            found.append((np.add.reduceat(distances, pieces.starts), pieces.counts))
        return found

    def _path(self, steps: ComplexArray) -> ComplexArray:
        """Places (M,) of the positions, by the steps (N,) of the samples."""
        return np.append(0.0, np.cumsum(steps)[:-1])[self._samples]


class Turned(NamedTuple):
    """Steps (N,) at a speed of 1 under some yaw rates, and for each length the path (M,) of these.

    Paths are about the middle of each piece.
    """

    per_speed: ComplexArray
    paths: list[ComplexArray]


class _Pieces(NamedTuple):
    """First place (P,) of each piece of path, and how many places it has."""

    starts: IntArray
    counts: IntArray

    @classmethod
    def of(cls, numbers: FloatArray) -> "_Pieces":
        """Of the number (M,) of the piece in which each place lies, none below that before."""
        starts = np.flatnonzero(np.diff(numbers, prepend=-1.0))
        return cls(starts, np.diff(starts, append=len(numbers)))


def _distances(
    measured: ComplexArray, forward: ComplexArray, turning: ComplexArray, pieces: _Pieces
) -> FloatArray:
    """Between measured places (M,) and those of two paths, fitted to each piece."""
    turning = turning - _along(forward, turning, pieces)
    for part in (forward, turning):
        measured = measured - _along(part, measured, pieces)
    return np.abs(measured)


def _along(path: ComplexArray, other: ComplexArray, pieces: _Pieces) -> ComplexArray:
    """Another path (M,) as far as it goes along one: turned and scaled by each piece."""
    own = np.add.reduceat(path.real**2 + path.imag**2, pieces.starts)
    factor = np.add.reduceat(np.conj(path) * other, pieces.starts) / np.maximum(own, TINY)
    return np.asarray(np.repeat(factor, pieces.counts) * path)


def _per_speed(rates: FloatArray, steps_s: FloatArray) -> ComplexArray:
    """Steps (N,) in the complex plane of a body that moves ahead at 1 and turns at rates (N,)."""
    half = rates * steps_s / 2
    yaw = 2 * np.cumsum(half) - half  # midway: a chord of an arc
    return np.asarray(steps_s * np.sinc(half / np.pi) * np.exp(1j * yaw))


def _centred(places: ComplexArray, pieces: _Pieces) -> ComplexArray:
    sums = np.add.reduceat(places, pieces.starts)
    return np.asarray(places - np.repeat(sums / pieces.counts, pieces.counts))
