"""Turns that agree in one part of a recording and are opposite in another."""

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.evidence.once import once
from odometry.checks.statistics.relation import relation
from odometry.checks.turns.turn_signs import LEAST_TURN_RAD

PARTS = 8
CERTAIN = 8.0  # standard deviations
SURELY = 0.9  # correlation in a part


@once
def turns_flip(evidence: Evidence) -> str:
    """Two sensors that turn together in one part, and against each other in another.

    Parts are eighths of the time, and drives forwards and backwards. No slip turns a robot against
    its treads all the time, and no single sign is wrong.
    """
    poses, uniform = evidence.turn_motion, evidence.uniform
    pairs = (
        ("gyroscope and treads", uniform, uniform.gyroscope_rad, uniform.difference_m),
        ("poses and treads", poses, evidence.pose_turn_rad, poses.difference_m),
        ("poses and gyroscope", poses, evidence.pose_turn_rad, poses.gyroscope_rad),
    )
    for names, motion, turns, others in pairs:
        signs = [_sign(turns[rows], others[rows]) for rows in _parts(motion)]
        if {-1, 1} <= set(signs):
            return (
                f"{names} turn together in one part of the recording, and against each other in "
                "another"
            )
    return ""


def _parts(motion: Motion) -> list[IntArray]:
    ways = [np.flatnonzero(motion.mean_m > 0), np.flatnonzero(motion.mean_m < 0)]
    return [*np.array_split(np.arange(len(motion)), PARTS), *ways]


def _sign(turns: FloatArray, others: FloatArray) -> int:
    """The sign of a relation; 0 where it is not certain."""
    found = relation(turns, others)
    if found is None or not found.certain(0, CERTAIN) or abs(found.correlation) < SURELY:
        return 0
    if np.nansum(np.abs(turns)) < LEAST_TURN_RAD:
        return 0
    return int(np.sign(found.slope))
