"""The direction in which treads drive a robot, wherever on it the positions are measured."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.heading import middle_rad
from odometry.checks.evidence.motion import Integrals, Motion

PIECE_S = 20.0  # in which the gyroscope's bias and the terrain may be taken as constant
LEAST_WINDOWS = 10
LEAST_M = 1.0  # of way that gives a direction
LEAST_ANGLE = 0.1  # sine between way and turn: in a circle an arm is as good as a direction
UNSURE_RAD = 0.1  # standard deviation from which a direction is not known
# Share of the squares of the way that must be explained: real recordings have 0.62 and more, those
# on ice, whose way goes anywhere, 0.28 to 0.39, and mirrored positions 0.01 to 0.06.
EXPLAINED = 0.5
ROUNDS, CUTOFF = 5, 3.0  # of leaving out windows, beyond so many deviations


def yaw_by_gyroscope(motion: Motion, of: Integrals) -> FloatArray:
    """Yaw [rad] (K, 2) at the start and end of each window; NaN where it cannot be determined.

    That of the gyroscope, which counts from the direction of the way, in each piece anew.

    Parameters
    ----------
    motion : Motion
        K windows between measured positions.
    of : Integrals
        With a gyroscope in rad/s.
    """
    turned = np.stack([of.gyroscope_rad(motion.start_s), of.gyroscope_rad(motion.end_s)], axis=-1)
    yaw = np.full((len(motion), 2), np.nan)
    piece = ((motion.start_s - motion.start_s[:1]) // PIECE_S).astype(np.int64)
    for rows in np.split(np.arange(len(motion)), np.flatnonzero(np.diff(piece)) + 1):
        windows = motion.rows(rows)
        direction_rad = way_direction_rad(windows, turned[rows], windows.gyroscope_rad)
        yaw[rows] = turned[rows] + direction_rad
    return yaw


def way_direction_rad(motion: Motion, yaw_rad: FloatArray, turn_rad: FloatArray) -> float:
    """Direction in the robot frame, as a yaw (K, 2) has it, of what the treads' mean moves.

    By the yaw turned back, positions move by ``factor mean + arm turn``, as complex numbers:
    forwards with the mean of the treads, and with the turn (K,) as the measured point swings. Both
    factors are fitted; the angle of the first is the direction. NaN where it cannot be determined.
    """
    moved = (motion.moved_m @ [1, 1j]) * np.exp(-1j * middle_rad(yaw_rad))
    columns = np.stack([motion.mean_m, turn_rad], axis=-1)
    known = np.isfinite(moved) & np.isfinite(columns).all(axis=1)
    moved, columns = moved[known], columns[known]
    if len(moved) < LEAST_WINDOWS or np.abs(columns[:, 0]).sum() < LEAST_M:
        return np.nan
    way, turn = columns.T / np.maximum(np.linalg.norm(columns, axis=0), 1e-12)[:, None]
    if (apart := 1 - float(way @ turn) ** 2) < LEAST_ANGLE**2:
        return np.nan
    kept = np.ones(len(moved), dtype=np.bool_)
    for _ in range(ROUNDS):
        factors = np.linalg.lstsq(columns[kept].astype(np.complex128), moved[kept], rcond=None)[0]
        left_m = np.abs(moved - columns @ factors)
        kept = left_m <= CUTOFF * np.median(left_m) + 1e-12
    explained = 1 - float(np.sum(left_m**2)) / max(float(np.sum(np.abs(moved) ** 2)), 1e-300)
    sigma_m = float(np.sqrt(np.mean(left_m[kept] ** 2) / 2))
    least_m = abs(factors[0]) * float(np.linalg.norm(columns[kept, 0])) * np.sqrt(apart)
    known = explained > EXPLAINED and sigma_m < UNSURE_RAD * least_m
    return float(np.angle(factors[0])) if known else np.nan
