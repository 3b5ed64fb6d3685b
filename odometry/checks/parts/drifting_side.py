"""One tread whose scale changes while recording, little by little or in a part of any shape."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.least_squares import ORDINARY, ordinary_fit
from odometry.checks.evidence.measured_turns import measured_turns
from odometry.checks.evidence.motion import Motion
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import TREADS, Mend, changed
from odometry.run import Run

KNOTS = 6  # of a scale, at equal steps of the way of both treads, a line between each two
LEAST_WINDOWS = 60
KNOT_MOVES = 0.02  # share of the squares of a tread's way that is near each knot
# Of the squares that constant scales leave of the ordinary turns, and of what the same course of
# the other tread, of the width or of a pull to one side leaves: 0.26 to 0.56 and 0.18 to 0.64 of
# treads that wear, 0.63 and more, or 0.85 and more, of 75 real recordings as they are.
LEFT, ALONE = 0.65, 0.75
# Times, and by how much of those squares, what is left may be more than both treads, with a course
# each, leave: lines between knots do not follow each course.
AS_WELL, NEARLY = 1.25, 0.05
EXPLAINED = 0.95  # of the ordinary turns, by a scale that changes
# Ratio of the largest to the least scale. Of 100 drives across terrains, of which one side may slip
# more on one of them, two that pass all else have 1.2.
CHANGED = 1.25
# The way along must change alike, where it is known: share of its squares that the treads leave at
# most, share of that which a course of the tread may leave, and correlation of both courses.
WAY_KNOWN, WAY_LEFT, ALIKE = 0.2, 0.95, 0.6


@dataclass(frozen=True)
class DriftingSide:
    """A tread whose scale changes.

    Attributes
    ----------
    side : int
        0 of the left tread.
    at_s : (KNOTS,)
        Stamps.
    reads : (KNOTS,)
        What it reads there, times its motion, if the other tread reads its own.
    left : float
        Share of the squares of what constant scales leave of the turns.
    """

    side: int
    at_s: FloatArray
    reads: FloatArray
    left: float

    def undone(self, run: Run) -> Run:
        """The run with the scale of the other tread all along."""
        scale = np.interp(run.odometry.stamps_s, self.at_s, 1 / self.reads)
        mend: Mend = changed("odometry", TREADS[self.side], lambda speeds: scale * speeds)
        return mend(run)


def side_drifts(evidence: Evidence) -> Iterator[Finding]:
    """The finding of a tread whose scale changes."""
    found = drifting_side(evidence)
    if found is None:
        return
    name, began_s = TREADS[found.side], evidence.run.began_s
    reads = ", ".join(f"{of:.2g}" for of in found.reads)
    at_s = ", ".join(f"{of - began_s:.0f}" for of in found.at_s)
    yield Finding(
        "tread_scale_drifts",
        Level.WARNING,
        f"by the turns {name} reads {reads} times the motion of its tread at {at_s} s, if the "
        "other tread reads its own",
        f"The scale of {name} changes while recording (an encoder that loses counts, a wheel that "
        "wears, a tyre that loses air, a setting); or that tread alone slips more or less",
        f"Correct {name}, or cut with --from and --to",
        mend=found.undone,
    )


@once
def drifting_side(evidence: Evidence) -> DriftingSide | None:
    """A scale of one tread that changes, by the first sensor that measures turns.

    A course of its scale, a line from knot to knot, must leave far less of the turns than constant
    scales do, and than the same course of the other tread or of the width of the robot, which
    changes with the terrain. The way along must change alike.
    """
    measured = next(measured_turns(evidence))
    of, clock = measured.motion, _Clock.of(evidence)
    turns = _Channel.of(of, measured.target, clock)
    if turns is None:
        return None
    found = _course(turns)
    if found is None:
        return None
    side, left, ratios = found
    way = _Channel.of(evidence.motion, evidence.forward_m, clock)
    if way is not None and not _goes_along(way, side, ratios):
        return None
    return DriftingSide(side, clock.knots_s, 1 / ratios, left)


def _course(turns: "_Channel") -> tuple[int, float, FloatArray] | None:
    """Side, share of the squares left, and turn by a metre of it in those of the other (KNOTS,)."""
    constant, _ = turns.fit(turns.left_m, turns.right_m, turns.lasts_s)
    fits = [turns.fit_course(side) for side in range(2)]
    side = int(fits[1][0] < fits[0][0])
    (left, course), (of_other, _) = fits[side], fits[1 - side]
    whole = float(np.sum(turns.target**2))
    if left > min(LEFT * constant, ALONE * of_other, (1 - EXPLAINED) * whole):
        return None
    both = AS_WELL * turns.fit_both()[0] + NEARLY * constant
    rivals = both, ALONE * turns.fit_width()[0], ALONE * turns.fit_pull()[0]
    if left > min(rivals) or not turns.moves_all_along(side):
        return None
    ratios = -course[:KNOTS] / course[KNOTS]
    changes = ratios.min() > 0 and ratios.max() > CHANGED * ratios.min()
    return (side, left / constant, ratios) if changes else None


def _goes_along(way: "_Channel", side: int, ratios: FloatArray) -> bool:
    """Whether the way along changes as the turns do, or does not say."""
    constant, _ = way.fit(way.left_m, way.right_m, way.lasts_s)
    if constant > WAY_KNOWN * float(np.sum(way.target**2)) or not way.moves_all_along(side):
        return True
    left, course = way.fit_course(side)
    of_way = course[:KNOTS]
    if left > WAY_LEFT * constant or of_way.min() <= 0:
        return False
    return bool(np.corrcoef(np.log(of_way), np.log(ratios))[0, 1] > ALIKE)


@dataclass(frozen=True)
class _Clock:
    """Share of the way of both treads as a function of the stamp."""

    stamps_s: FloatArray
    share: FloatArray

    @classmethod
    def of(cls, evidence: Evidence) -> "_Clock":
        of = evidence.uniform
        way_m = np.cumsum(np.abs(of.left_m) + np.abs(of.right_m))
        return cls(of.end_s, way_m / max(float(way_m[-1]) if len(way_m) else 0.0, 1e-300))

    @property
    def knots_s(self) -> FloatArray:
        return np.asarray(np.interp(np.linspace(0, 1, KNOTS), self.share, self.stamps_s))

    def hats(self, at_s: FloatArray) -> FloatArray:
        """Weights (KNOTS, K) of the knots at stamps (K,): a line between each two."""
        place = np.interp(at_s, self.stamps_s, self.share) * (KNOTS - 1)
        return np.asarray(np.maximum(1 - np.abs(place - np.arange(KNOTS)[:, None]), 0.0))


@dataclass(frozen=True)
class _Channel:
    """Windows (K) of a measured motion: of the turns, or of the way along."""

    left_m: FloatArray
    right_m: FloatArray
    lasts_s: FloatArray
    target: FloatArray
    hats: FloatArray

    @classmethod
    def of(cls, of: Motion, target: FloatArray, clock: _Clock) -> "_Channel | None":
        known = np.flatnonzero(np.isfinite(target) & np.isfinite(of.left_m + of.right_m))
        if len(known) < LEAST_WINDOWS:
            return None
        of = of.rows(known)
        return cls(of.left_m, of.right_m, of.lasts_s, target[known], clock.hats(of.start_s))

    def fit_course(self, side: int) -> tuple[float, FloatArray]:
        """With a course of the scale of one side: squares, and coefficients (KNOTS + 2,)."""
        own_m, other_m = self.left_m, self.right_m
        if side == 1:
            own_m, other_m = other_m, own_m
        return self.fit(*(self.hats * own_m), other_m, self.lasts_s)

    def fit_width(self) -> tuple[float, FloatArray]:
        return self.fit(*(self.hats * (self.right_m - self.left_m)), self.right_m, self.lasts_s)

    def fit_pull(self) -> tuple[float, FloatArray]:
        return self.fit(*(self.hats * self.lasts_s), self.left_m, self.right_m)

    def fit_both(self) -> tuple[float, FloatArray]:
        return self.fit(*(self.hats * self.left_m), *(self.hats * self.right_m), self.lasts_s)

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
