"""The yaw rate of a gyroscope less its bias, which positions determine."""

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

    def best_of(biases: FloatArray) -> float:
        misfits = [path_misfit(record, speeds, rates - bias) for bias in biases]
        return float(biases[np.argmin(misfits)])

    tried = np.linspace(-LARGEST_BIAS_RAD_S, LARGEST_BIAS_RAD_S, COARSE)
    step = tried[1] - tried[0]
    return np.asarray(rates - best_of(best_of(tried) + np.linspace(-step, step, FINE)))


def path_misfit(
    record: Record, speeds_m_s: FloatArray, rates_rad_s: FloatArray, length_m: float = LENGTH_M
) -> float:
    """Sum of distances [m] between measured positions and the path of yaw rates (N,).

    The body moves by a share of the mean tread speeds (N,), and, forward and aside, by a length
    times the yaw rate: that holds for any tread ICRs and any place of the antenna. Each piece of
    path of the length has a share and lengths of its own.
    """
    steps_s = np.append(np.diff(record.stamps_s), 0.0)
    travel_m = record.travel_m[record.pose_samples]
    pieces = np.floor(travel_m / length_m) + 1e6 * record.stretch
    _, piece = np.unique(pieces, return_inverse=True)
    measured = _centred(record.poses[:, 0] + 1j * record.poses[:, 1], piece)
    forward, turning = (
        _centred(_path(moved, rates_rad_s, steps_s)[record.pose_samples], piece)
        for moved in (speeds_m_s, rates_rad_s)
    )
    own = _summed(np.abs(forward) ** 2, piece).real
    share = _summed(np.conj(forward) * turning, piece) / np.maximum(own, TINY)
    turning = turning - share[piece] * forward  # what is not along the other
    for part in (forward, turning):
        own = _summed(np.abs(part) ** 2, piece).real
        factor = _summed(np.conj(part) * measured, piece) / np.maximum(own, TINY)
        measured = measured - factor[piece] * part
    return float(np.abs(measured).sum())


def _path(moved: FloatArray, rates: FloatArray, steps_s: FloatArray) -> ComplexArray:
    """Places (N,) in the complex plane of a body that moves ahead at rates (N,) and turns."""
    twists = np.column_stack([moved, np.zeros_like(moved), rates])
    along, across, turn = se2.exp(twists * steps_s[:, None]).T
    yaw = np.cumsum(turn) - turn
    return np.asarray(np.append(0.0, np.cumsum((along + 1j * across) * np.exp(1j * yaw))[:-1]))


def _centred(places: ComplexArray, piece: IntArray) -> ComplexArray:
    return np.asarray(places - (_summed(places, piece) / np.bincount(piece))[piece])


def _summed(places: ComplexArray, piece: IntArray) -> ComplexArray:
    """Sums of places (M,) in the complex plane over each piece."""
    return np.asarray(np.bincount(piece, places.real) + 1j * np.bincount(piece, places.imag))
