"""A metre of the treads that moves the robot by less and less, or more and more, of the map."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import relation
from odometry.checks.turns.measured_turns import measured_turns

PARTS, FEWEST = 8, 6  # of the way
KNOWN = 0.2  # standard deviation of a factor that counts
LEAST = 1.1  # ratio of the factors at both ends, of a line through those of the parts
SURELY = 5.0  # standard deviations of that line; as recorded 1.5 at most of what changes so much
# By the treads of an ideal drive, between two poses. In more the way is longer than its chord, and
# the place of the sensor counts.
GENTLE_RAD = 1.0
TURNS_KEEP, TURNS_SURELY = 0.75, 2.0  # share of the change that turns surely stay below
TURNS_UNKNOWN = 0.35  # share of the change: standard deviation of that of turns


@dataclass(frozen=True)
class Line:
    """A line through the logarithms of factors, over the share of the way: its rise.

    `is_step` says that one step explains them better: another terrain from there on.
    """

    rise: float
    sigma: float
    first: float
    last: float
    is_step: bool


def way_drifts(evidence: Evidence, uneven: str) -> Iterator[Finding]:
    """Positions whose scale drifts against the treads, while turns keep theirs.

    A scale of the treads changes turns alike, most terrain changes them more. `uneven` says that
    the way differs between places of the map, which a drive that goes on from one to the other
    does not tell from time; "" where it does not.
    """
    if evidence.heading is None:
        return
    of = evidence.motion
    turned_rad = np.abs(of.difference_m) / evidence.run.robot.track_width
    along_m = np.where(turned_rad < GENTLE_RAD, evidence.forward_m, np.nan)
    way = _line(evidence, of, along_m, of.mean_m)
    if way is None or way.is_step or abs(way.rise) < max(np.log(LEAST), SURELY * way.sigma):
        return
    turns = next(measured_turns(evidence))
    turn = _line(evidence, turns.motion, turns.target, turns.motion.difference_m)
    unknown = turn is None or turn.sigma > TURNS_UNKNOWN * abs(way.rise)
    if turn is not None and not unknown:
        most = np.sign(way.rise) * turn.rise + TURNS_SURELY * turn.sigma
        if most > TURNS_KEEP * abs(way.rise):
            return
    seen = (
        f"a metre of tread travel moves the robot by {way.first:.3g} m at first and by "
        f"{way.last:.3g} m at last, changing along the way, "
        + ("and turns do not say how they change" if unknown else "and turns do not change alike")
    )
    slip = "more and more" if way.rise < 0 else "less and less"
    cause = (
        "Either the scale of the map drifts (visual odometry or SLAM with one camera), or differs "
        f"between its places; or the treads slip {slip} along (terrain, load, a slope)"
        + ("; or the scale of the tread speeds drifts" if unknown else "")
    )
    yield Finding(
        "scale_drifts",
        Level.WARNING,
        "; ".join(filter(None, (seen, uneven))),
        cause,
        "Drive one measured distance at first and at last: if pose.csv has two lengths for it, "
        "the map drifts",
    )


def _line(evidence: Evidence, of: Motion, target: FloatArray, by: FloatArray) -> Line | None:
    """The line through the factors of parts of equal way; None with too few of them."""
    travel_m = evidence.travel_m((of.start_s + of.end_s) / 2)
    edges_m = np.linspace(0.0, float(evidence.travel_m(evidence.stamps_s[-1:])[0]), PARTS + 1)
    middles, logs = [], []
    for begin_m, end_m in pairwise(edges_m.tolist()):
        inside = (travel_m >= begin_m) & (travel_m < end_m)
        fit = relation(np.where(inside, target, np.nan), by)
        if fit is not None and 0 < fit.slope_sigma < KNOWN * fit.slope:
            middles.append((begin_m + end_m) / 2 / edges_m[-1])
            logs.append(np.log(fit.slope))
    if len(logs) < FEWEST:
        return None
    share = np.array(middles) - np.mean(middles)
    rise = float(share @ logs) / float(share @ share)
    left = np.array(logs) - np.mean(logs) - rise * share
    sigma = float(np.sqrt(left @ left / (len(logs) - 2) / (share @ share)))
    steps = (np.split(np.array(logs), [place]) for place in range(1, len(logs)))
    is_step = min(sum(len(of) * of.var() for of in both) for both in steps) < left @ left
    at_ends = np.mean(logs) + rise * (np.array([0.0, 1.0]) - np.mean(middles))
    first, last = np.exp(at_ends).tolist()
    return Line(rise, sigma, first, last, is_step=bool(is_step))
