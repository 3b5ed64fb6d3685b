"""What scales of the treads that change, each in its own course, leave of a measured motion."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.statistics.least_squares import ORDINARY, ordinary_fit

KNOTS = 6  # of a scale, at equal steps of the way of both treads, a line between each two
LEAST_WINDOWS = 60
KNOT_MOVES = 0.02  # share of the squares of a tread's way that is near each knot
WAY_KNOWN = 0.2  # share of the squares of the way along that constant scales leave at most


@dataclass(frozen=True, eq=False)
class WayClock:
    """Share of the way of both treads as a function of the stamp."""

    stamps_s: FloatArray
    share: FloatArray

    @classmethod
    def of(cls, evidence: Evidence) -> "WayClock":
        """That of a recording."""
        of = evidence.uniform
        way_m = np.cumsum(np.abs(of.left_m) + np.abs(of.right_m))
        return cls(of.end_s, way_m / max(float(way_m[-1]) if len(way_m) else 0.0, 1e-300))

    @property
    def knots_s(self) -> FloatArray:
        """Stamps (KNOTS,)."""
        return np.asarray(np.interp(np.linspace(0, 1, KNOTS), self.share, self.stamps_s))

    def hats(self, at_s: FloatArray) -> FloatArray:
        """Weights (KNOTS, K) of the knots at stamps (K,): a line between each two."""
        place = np.interp(at_s, self.stamps_s, self.share) * (KNOTS - 1)
        return np.asarray(np.maximum(1 - np.abs(place - np.arange(KNOTS)[:, None]), 0.0))


@dataclass(frozen=True, eq=False)
class ScaleCourses:
    """Windows (K) of a measured motion: of the turns, or of the way along.

    `windows_s` (K, 2) are their stamps. `sign` is that of the left tread beside the right one.
    """

    left_m: FloatArray
    right_m: FloatArray
    lasts_s: FloatArray
    target: FloatArray
    windows_s: FloatArray
    hats: FloatArray
    sign: int

    @classmethod
    def of(
        cls, of: Motion, target: FloatArray, clock: WayClock, sign: int
    ) -> "ScaleCourses | None":
        """Of windows in which a target (K,) was measured; None with few."""
        known = np.flatnonzero(np.isfinite(target) & np.isfinite(of.left_m + of.right_m))
        if len(known) < LEAST_WINDOWS:
            return None
        of = of.rows(known)
        windows_s, hats = np.stack([of.start_s, of.end_s], axis=-1), clock.hats(of.start_s)
        return cls(of.left_m, of.right_m, of.lasts_s, target[known], windows_s, hats, sign)

    @cached_property
    def shares(self) -> FloatArray:
        """Of the squares that constant scales leave (5,).

        What a course of the left, and of the right tread leaves, of what both do together (the
        width, or the mean), of a pull to one side (of no way), and of each of both.
        """
        ways_m = self.hats * self.left_m, self.hats * self.right_m
        together_m = self.hats * (self.right_m + self.sign * self.left_m)
        found = [*(squares for squares, _ in self._courses)]
        found.append(self.fit(*together_m, self.right_m, self.lasts_s)[0])
        pulls = self.hats * self.lasts_s if self.sign < 0 else self.lasts_s[None]
        found.append(self.fit(*pulls, self.left_m, self.right_m)[0])
        found.append(self.fit(*ways_m[0], *ways_m[1], self.lasts_s)[0])
        return np.minimum(np.array(found) / max(self._constant, 1e-300), 1.0)

    @cached_property
    def unexplained(self) -> float:
        """Share of the ordinary motion that constant scales leave."""
        return self._constant / max(float(np.sum(self.target**2)), 1e-300)

    @property
    def is_known(self) -> bool:
        """Whether treads of constant scales explain most of it."""
        return self.unexplained < WAY_KNOWN

    def own_and_other_m(self, side: int) -> tuple[FloatArray, FloatArray]:
        """Ways (K,) of one side and of the other, above 0 where they add to the target."""
        left_m, right_m = self.sign * self.left_m, self.right_m
        return (right_m, left_m) if side else (left_m, right_m)

    def left_by_course(self, side: int) -> float:
        """The squares that a course of one side leaves."""
        return self._courses[side][0]

    def course(self, side: int) -> FloatArray:
        """The scale of one side at the knots (KNOTS,), in that of the other one; 0 without one."""
        found = self._courses[side][1]
        of_other = float(found[KNOTS])
        return found[:KNOTS] / of_other if of_other else np.zeros(KNOTS)

    @cached_property
    def _constant(self) -> float:
        return self.fit(self.left_m, self.right_m, self.lasts_s)[0]

    @cached_property
    def _courses(self) -> tuple[tuple[float, FloatArray], tuple[float, FloatArray]]:
        """With a course of the left, and of the right tread: squares, coefficients (KNOTS + 2,)."""
        left_m, right_m = self.own_and_other_m(0)
        return (
            self.fit(*(self.hats * left_m), right_m, self.lasts_s),
            self.fit(*(self.hats * right_m), left_m, self.lasts_s),
        )

    def moves_all_along(self, side: int) -> bool:
        """Whether a tread moves near each knot."""
        near = self.hats @ (self.right_m if side else self.left_m) ** 2
        return bool(near.min() > KNOT_MOVES * near.sum())

    def fit(self, *columns: FloatArray) -> tuple[float, FloatArray]:
        """Squares that columns leave of the ordinary windows, and coefficients.

        They are as large as those of columns without free coefficients would be.
        """
        rows, known = np.stack(columns), ORDINARY * len(self.target)
        left, found = ordinary_fit(rows, self.target)
        return left * known / max(known - len(rows), 1), found
