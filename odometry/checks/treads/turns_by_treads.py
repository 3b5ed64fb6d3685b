"""Turns that a sensor measures, and what the treads, or the treads and more, explain of them."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.statistics.least_squares import least_squares
from odometry.checks.turns.measured_turns import measured_turns

LEAST_WINDOWS = 40
ORDINARY = 0.97  # share of the windows that are compared: those that the treads explain best
STANDING = 0.02  # of the ordinary fastest speed of a tread
PARTS = 8  # of a drive, each of which may lie on a terrain of its own


@dataclass(frozen=True)
class Turns:
    """K windows: travel of the treads, duration, measured turn, and what the treads leave of it.

    `squares` are those of what is left, `share` is that of all turns.
    """

    left_m: FloatArray
    right_m: FloatArray
    lasts_s: FloatArray
    turned_rad: FloatArray
    start_s: FloatArray
    squares: float
    share: float

    def left_by(self, more: FloatArray) -> tuple[float, FloatArray]:
        """Share of `squares` that is left with one column more (K,), and the coefficients (4,)."""
        return self.fit(self.left_m, self.right_m, self.lasts_s, more)

    def left_by_one_scale(self, more: FloatArray) -> float:
        """The same of treads of one scale."""
        return self.fit(self.right_m - self.left_m, self.lasts_s, more)[0]

    def fit(self, *columns: FloatArray) -> tuple[float, FloatArray]:
        """Share of `squares` that some columns (P, K) leave, and their coefficients (P,)."""
        rows = np.stack(columns)
        if not rows.any(axis=1).all():
            return np.inf, np.ones(len(rows))
        found = least_squares(rows, self.turned_rad)
        left = float(np.sum((self.turned_rad - found @ rows) ** 2))
        return left / max(self.squares, 1e-300), found

    def left_by_parts(self) -> float:
        """The same where each part of the drive has scales of its own."""
        rows = np.stack([self.left_m, self.right_m, self.lasts_s])
        return squares_by_parts(rows, self.turned_rad) / max(self.squares, 1e-300)

    def constants_s(self, fastest_m_s: float) -> tuple[FloatArray, FloatArray]:
        """Seconds (K,) in which each tread moves, with the sign of its travel."""
        found = []
        for way_m in (self.left_m, self.right_m):
            moves = np.abs(way_m) > STANDING * fastest_m_s * self.lasts_s
            found.append(np.where(moves, np.sign(way_m) * self.lasts_s, 0.0))
        return found[0], found[1]


def squares_by_parts(rows: FloatArray, target: FloatArray) -> float:
    """Squares that columns (P, K) leave of (K,) in the order of time where they fit each part.

    They are as large as those of one fit of P columns would be if all parts were alike.
    """
    left, parts = 0.0, np.array_split(np.arange(len(target)), PARTS)
    for part in parts:
        fitted = least_squares(rows[:, part], target[part]) @ rows[:, part]
        left += float(np.sum((target[part] - fitted) ** 2))
    free, fitted_by_parts = len(target) - len(rows), len(rows) * (PARTS - 1)
    return left * free / max(free - fitted_by_parts, 1)


@once
def turns_by_treads(evidence: Evidence) -> Turns | None:
    """Of the first sensor that measures turns, without outliers; None with few windows."""
    measured = next(measured_turns(evidence))
    m, target = measured.motion, measured.target
    rows = np.stack([m.left_m, m.right_m, m.lasts_s])
    known = np.flatnonzero(np.isfinite(target) & np.isfinite(rows).all(axis=0))
    if len(known) < LEAST_WINDOWS or not rows[:, known].any(axis=1).all():
        return None
    left = target[known] - least_squares(rows[:, known], target[known]) @ rows[:, known]
    ordinary = np.abs(left) <= np.quantile(np.abs(left), ORDINARY)
    kept = known[ordinary]
    left = target[kept] - least_squares(rows[:, kept], target[kept]) @ rows[:, kept]
    squares = float(np.sum(left**2))
    share = squares / max(float(np.sum(target[kept] ** 2)), 1e-300)
    left_m, right_m, lasts_s = rows[:, kept]
    return Turns(left_m, right_m, lasts_s, target[kept], m.start_s[kept], squares, share)
