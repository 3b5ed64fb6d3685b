"""One tread whose scale changes while recording, little by little or in a part of any shape."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import TREADS, Mend, changed
from odometry.checks.parts.scale_courses import ScaleCourses, WayClock
from odometry.checks.turns.measured_turns import measured_turns
from odometry.recording.run import Run

# What a course of the scale of one tread leaves, as a share of what constant scales leave, and of
# what the same course of the other tread, of the width or of a pull to one side leaves at least. By
# turns alone, and by turns and the way along (the geometric mean).
BY_TURNS, BY_BOTH = (0.65, 0.75), (0.75, 0.85)
# Ratio of the largest to the least scale: on some terrain one side slips by a fifth more. With 1.1
# none of 75 real recordings and 200 drives without a fault has this and all of the above where the
# way changes alike; without the way two have.
CHANGED = 1.25
# Times, and by how much of those squares, what is left may be more than both treads, with a course
# each, leave: lines between knots do not follow each course.
AS_WELL, NEARLY = 1.25, 0.08
EXPLAINED = 0.95  # of the ordinary turns, by a scale that changes
# Correlation of the courses of turns and way, and the slope of one over the other, as logarithms.
# Of treads that wear 0.7 to 1.0 and 0.4 to 1.2, near 1 but where the robot slips.
ALIKE, SLOPES = 0.7, (0.4, 1.7)


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
        What it reads there, times its motion, if the other tread is right.
    turns : ScaleCourses
        By which it was found.
    """

    side: int
    at_s: FloatArray
    reads: FloatArray
    turns: ScaleCourses

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
    name, other, began_s = TREADS[found.side], TREADS[1 - found.side], evidence.run.began_s
    reads = ", ".join(f"{of:.2g}" for of in found.reads)
    at_s = ", ".join(f"{of - began_s:.0f}" for of in found.at_s)
    yield Finding(
        "tread_scale_drifts",
        Level.WARNING,
        f"the turns say that {name} reads {reads} times the motion of its tread at {at_s} s, if "
        f"{other} is right",
        f"The scale of {name} changes while recording (an encoder that loses counts, a wheel that "
        "wears, a tyre that loses air, a setting); or that tread alone slips more or less",
        f"Correct {name}, or cut with --from and --to",
        mend=found.undone,
    )


@once
def drifting_side(evidence: Evidence) -> DriftingSide | None:
    """A scale of one tread that changes, by the first sensor that measures turns, and by the way.

    A course of its scale, a line from knot to knot, must leave far less than constant scales do,
    and than the same course of the other tread or of the width of the robot, which changes with
    the terrain. Where the way along is known, it must change alike.
    """
    measured = next(measured_turns(evidence))
    clock = WayClock.of(evidence)
    turns = ScaleCourses.of(measured.motion, measured.target, clock, -1)
    if turns is None:
        return None
    way = ScaleCourses.of(evidence.motion, evidence.forward_m, clock, 1)
    fits = [turns] if way is None or not way.is_known else [turns, way]
    shares = np.prod([of.shares for of in fits], axis=0) ** (1 / len(fits))
    side = int(np.argmin(shares[:2]))
    courses = [of.course(side) for of in fits]
    if min(of.min() for of in courses) <= 0 or not all(of.moves_all_along(side) for of in fits):
        return None
    limits = BY_BOTH if len(fits) > 1 else BY_TURNS
    explains = turns.shares[side] * turns.unexplained < 1 - EXPLAINED
    if not explains or not _is_clear(shares, side, limits):
        return None
    if courses[0].max() < CHANGED * courses[0].min() or not _alike(courses):
        return None
    return DriftingSide(side, clock.knots_s, 1 / courses[0], turns)


def _is_clear(shares: FloatArray, side: int, limits: tuple[float, float]) -> bool:
    """Whether the course of one side leaves far less than anything else, `ScaleCourses.shares`."""
    left, alone = limits
    rivals = min(shares[1 - side], shares[2], shares[3])
    return bool(shares[side] < min(left, alone * rivals, AS_WELL * shares[4] + NEARLY))


def _alike(courses: list[FloatArray]) -> bool:
    """Whether scales by turns and by the way change together, where both are known."""
    if len(courses) < 2:
        return True
    of_turns, of_way = (np.log(of) - np.log(of).mean() for of in courses)
    both = float(of_turns @ of_way)
    slope = both / float(of_turns @ of_turns)
    sizes = np.sqrt(float(of_turns @ of_turns) * float(of_way @ of_way))
    return both > ALIKE * sizes and SLOPES[0] < slope < SLOPES[1]
