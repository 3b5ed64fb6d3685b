"""Drives of one motion alone, of which no parameters can be identified."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import LEAST_ANGLE_RAD

MOVING = 0.1  # of the ordinary fastest speed
LEAST_TRAVEL_M = 2.0  # windows of `identify`
ONE_WAY = 0.1  # difference of the treads by their sum on a straight drive; its inverse in a spin
REMEDY = "Drive turns to both sides, of several radii and speeds, and straight stretches as well"


def one_motion(evidence: Evidence) -> Iterator[Finding]:
    """A robot with poses that only stands, goes straight, spins, or drives one circle."""
    if (found := motion_alone(evidence)) is not None:
        yield found


@once
def motion_alone(evidence: Evidence) -> Finding | None:
    """The finding of a drive of one motion; None of others.

    Its parameters come from how left and right tread differ: where both have one ratio all the
    time, the smaller singular value of their scaled travel is that of their noise (Belsley, Kuh
    and Welsch 1980, chapter 3).
    """
    if evidence.positions_measured is None or evidence.fastest_m_s < 1e-3:
        return None
    m = evidence.uniform
    way_m = float(evidence.run.wheel_travel_m[-1])
    if way_m < LEAST_TRAVEL_M:
        return _finding(
            f"the treads travel {way_m:.2g} m in all", "By the treads the robot hardly drives"
        )
    travel = np.stack([m.left_m, m.right_m], axis=-1)
    moving = np.abs(travel).max(axis=1) > MOVING * evidence.fastest_m_s * m.lasts_s
    lengths = np.linalg.norm(travel[moving], axis=0)
    if not (lengths > 0).all():
        return None  # one tread stands: a fault, or turns about it
    sizes = np.linalg.svd(travel[moving] / lengths, compute_uv=False)
    if sizes[-1] > LEAST_ANGLE_RAD * sizes[0]:
        return None
    ratio = float(np.sum(travel[moving].prod(axis=1)) / lengths[1] ** 2)
    turn = abs(1 - ratio) / max(abs(1 + ratio), 1e-9)
    motion = "drives circles of one radius"
    if turn < ONE_WAY:
        motion = "only goes straight on"
    elif turn > 1 / ONE_WAY:
        motion = "only spins on the spot"
    return _finding(
        f"v_left is {ratio:.2g} times v_right all the time", f"By the treads the robot {motion}"
    )


def _finding(seen: str, cause: str) -> Finding:
    return Finding(
        "one_motion",
        Level.NOTE,
        seen,
        f"{cause}: such a drive does not determine the parameters of icr, and identify "
        "refuses it alone",
        REMEDY,
    )
