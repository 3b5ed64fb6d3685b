"""How measured positions are turned against the yaw, and stretched: one fit of all windows.

By yaw psi, positions move by exp(i psi) (s m + p q + i d m w) + g |m| + a m exp(-i psi), as complex
numbers, where treads move on by m and the robot turns by q at the rate w. What is of the robot (an
arm p, a late or sliding course d, a slope g along which it slides) is fitted beside the direction
of s, by which yaw is turned, and beside a, a stretch along one axis of the frame.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import middle_rad
from odometry.checks.evidence.once import once
from odometry.windows.recorded.in_motion import moving_windows

LEAST_WINDOWS = 40
BLOCKS = 8  # of the recording; each is left out once (jackknife), as slip and noise last a while
ROUNDS, CUTOFF = 6, 4.0  # of leaving out windows, beyond so many medians
MOST_TURN_RAD = 1.0  # within a window that has a direction
ON, SWUNG = 0, 2  # columns of s and of p
LEAST_ANGLE = 1e-4  # squared sine between columns, below which they are one


@dataclass(frozen=True)
class PositionFrame:
    """What positions are to yaw and treads.

    Attributes
    ----------
    turned_rad, turned_sd_rad : float
        Direction in which the treads move the robot, less yaw; and its standard deviation.
    ratio, ratio_sd : float
        Of the scale along the longest axis of the frame over that across.
    axis_rad : float
        Direction of the longest axis.
    """

    turned_rad: float
    turned_sd_rad: float
    ratio: float
    ratio_sd: float
    axis_rad: float


@once
def position_frame(evidence: Evidence) -> PositionFrame | None:
    """None where too few windows have a yaw, by poses or gyroscope, or do not tell all apart."""
    moved_m, columns = _columns(evidence)
    known = np.isfinite(moved_m) & np.isfinite(columns).all(axis=1)
    if known.sum() < LEAST_WINDOWS:
        return None
    moved_m, columns = moved_m[known], columns[known]
    moves = moving_windows(np.abs(columns[:, [ON, SWUNG]]).T)  # blocks are of the way it drives
    fits = _fits(moved_m[moves], columns[moves])
    if fits is None:
        return None
    forwards, stretch = fits[:, 0] + 1j * fits[:, 1], fits[:, 6] + 1j * fits[:, 7]
    stretch = stretch * forwards / np.abs(forwards) ** 2
    size = float(abs(stretch[0]))
    if not 0 < size < 1:
        return None
    return PositionFrame(
        float(np.angle(forwards[0])),
        _jackknife(np.angle(forwards[1:] / forwards[0])),
        (1 + size) / (1 - size),
        2 * _jackknife(np.real(stretch[1:] / stretch[0]) * size),
        float(np.angle(stretch[0])) / 2,
    )


def _columns(evidence: Evidence) -> tuple[AnyArray, AnyArray]:
    """What moved (K,), and what may have moved it (K, 9), each by a real factor."""
    m = evidence.motion
    turn = _turn_rad(evidence)
    yaw = middle_rad(m.yaw_rad if evidence.yaw_measured else evidence.gyroscope_yaw(m))
    ahead = np.exp(1j * np.where(np.abs(turn) < MOST_TURN_RAD, yaw, np.nan))
    chord = np.sinc(turn / (2 * np.pi))  # over the arc of a steady turn
    on, swung = m.mean_m * chord * ahead, turn * chord * ahead
    pairs = (on, swung, np.abs(m.mean_m) + 0j, on.conj())
    columns = [part for of in pairs for part in (of, 1j * of)]
    return m.moved_m @ np.array([1, 1j]), np.stack([*columns, 1j * on * turn / m.lasts_s], axis=-1)


def _turn_rad(evidence: Evidence) -> FloatArray:
    """Turn (K,) by the gyroscope with its bias undone, which an arm would make a way of its own."""
    m = evidence.motion
    by_yaw = evidence.pose_turn_by_gyroscope if evidence.yaw_measured else None
    if by_yaw is None or not by_yaw.certain():
        return evidence.turn_rad(m)
    return np.asarray(by_yaw.slope * m.gyroscope_rad + by_yaw.coefficients[1] * m.lasts_s)


def _fits(moved_m: AnyArray, columns: AnyArray) -> FloatArray | None:
    """Factors (1 + BLOCKS, 9) of all windows (K), and without each block; None of poor columns."""
    kept = np.ones(len(moved_m), dtype=np.bool_)
    for _ in range(ROUNDS):
        products = _products(moved_m[kept], columns[kept])
        factors = _factors(products)
        if factors is None:
            return None
        left_m = np.abs(moved_m - columns @ factors)
        kept = left_m <= CUTOFF * np.median(left_m) + 1e-12
    blocks = np.arange(len(moved_m)) * BLOCKS // len(moved_m)
    rows = [kept & (blocks == block) for block in range(BLOCKS)]
    parts = np.array([_products(moved_m[of], columns[of]) for of in rows])
    whole = parts.sum(axis=0)
    found = [of for one in (whole, *(whole - parts)) if (of := _factors(one)) is not None]
    return np.array(found) if len(found) == 1 + BLOCKS else None


def _products(moved_m: AnyArray, columns: AnyArray) -> FloatArray:
    """Products (9, 10) of the columns with each other and with what moved."""
    return np.asarray(np.real(columns.conj().T @ np.column_stack([columns, moved_m])))


def _factors(products: FloatArray) -> FloatArray | None:
    """Least squares (9,); None where columns are not told apart."""
    lengths = np.sqrt(np.diag(products))
    if not (lengths > 0).all():
        return None
    scaled = products[:, :-1] / np.outer(lengths, lengths)
    if np.linalg.eigvalsh(scaled)[0] < LEAST_ANGLE:
        return None
    return np.asarray(np.linalg.solve(scaled, products[:, -1] / lengths) / lengths)


def _jackknife(of: FloatArray) -> float:
    """Standard deviation by what is found without each block (B,)."""
    return float(np.sqrt((len(of) - 1) * np.var(of)))
