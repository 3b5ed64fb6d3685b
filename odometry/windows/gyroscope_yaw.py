"""The yaw rate of a gyroscope less its bias, which positions determine."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from odometry.arrays import FloatArray, IntArray
from odometry.geometry import se2
from odometry.sensors import gyroscope_of
from odometry.windows.record import Record

ComplexArray = NDArray[np.complex128]
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
        misfits = [shape.misfits_m(speeds, rates - bias)[0] for bias in biases]
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
            np.unique(np.floor(travel_m / each) + 1e6 * record.stretch, return_inverse=True)[1]
            for each in lengths_m
        ]
        self._measured = [_centred(places, piece) for piece in self._pieces]

    def misfits_m(self, speeds_m_s: FloatArray, rates_rad_s: FloatArray) -> FloatArray:
        """Sums (L,) of distances [m] between the positions and the path of yaw rates (N,).

        See `of_pieces`.
        """
        of_pieces = self.of_pieces(speeds_m_s, rates_rad_s)
        return np.array([distances.sum() for distances, _ in of_pieces])

    def of_pieces(
        self, speeds_m_s: FloatArray, rates_rad_s: FloatArray
    ) -> list[tuple[FloatArray, IntArray]]:
        """For each length, sums (P,) of distances [m] of its pieces, and of how many positions.

        The body moves by a share of the mean tread speeds (N,), and, forward and aside, by a
        length times the yaw rate: that holds for any tread ICRs and any place of the antenna. Each
        piece has a share and lengths of its own.
        """
        per_speed = _per_speed(rates_rad_s, self._steps_s)
        paths = [
            np.append(0.0, np.cumsum(moved * per_speed)[:-1])[self._samples]
            for moved in (speeds_m_s, rates_rad_s)
        ]
        found = []
        for measured, piece in zip(self._measured, self._pieces, strict=True):
            sums = np.bincount(piece, _distances(measured, paths, piece)).astype(np.float64)
            found.append((sums, np.bincount(piece)))
        return found


def _distances(
    measured: ComplexArray, paths: Sequence[ComplexArray], piece: IntArray
) -> FloatArray:
    """Between measured places (M,) and those of two paths, fitted to each piece."""
    forward, turning = (_centred(path, piece) for path in paths)
    own = _summed(np.abs(forward) ** 2, piece).real
    share = _summed(np.conj(forward) * turning, piece) / np.maximum(own, TINY)
    turning = turning - share[piece] * forward  # what is not along the other
    for part in (forward, turning):
        own = _summed(np.abs(part) ** 2, piece).real
        factor = _summed(np.conj(part) * measured, piece) / np.maximum(own, TINY)
        measured = measured - factor[piece] * part
    return np.abs(measured)


def _per_speed(rates: FloatArray, steps_s: FloatArray) -> ComplexArray:
    """Steps (N,) in the complex plane of a body that moves ahead at 1 and turns at rates (N,)."""
    twists = np.column_stack([np.ones_like(rates), np.zeros_like(rates), rates])
    along, across, turn = se2.exp(twists * steps_s[:, None]).T
    yaw = np.cumsum(turn) - turn
    return np.asarray((along + 1j * across) * np.exp(1j * yaw))


def _centred(places: ComplexArray, piece: IntArray) -> ComplexArray:
    return np.asarray(places - (_summed(places, piece) / np.bincount(piece))[piece])


def _summed(places: ComplexArray, piece: IntArray) -> ComplexArray:
    """Sums of places (M,) in the complex plane over each piece."""
    return np.asarray(np.bincount(piece, places.real) + 1j * np.bincount(piece, places.imag))
