"""A scale of the treads that changes slowly: along the way and in turns by the same factor."""

from itertools import pairwise

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.statistics.relation import relation
from odometry.checks.turns.measured_turns import measured_turns

PARTS, FEWEST = 8, 6
CERTAIN = 8.0  # standard deviations
HELD = 0.9  # correlation in a part
CHANGED = 1.3  # ratio of the largest to the smallest factor of a part
# Of 26 real recordings one has factors that go together by 0.91, with half of their spread between
# them; of a drifting scale they go together by 0.96 and more.
TOGETHER, APART = 0.95, 0.35


def scale_drifts(evidence: Evidence) -> str:
    """Words where what a metre of the treads moves and turns changes from part to part alike."""
    m, forward_m = evidence.motion, evidence.forward_m
    turns = next(measured_turns(evidence))
    of = turns.motion
    edges_s = np.linspace(evidence.stamps_s[0], evidence.stamps_s[-1], PARTS + 1)
    factors = []
    for begin_s, end_s in pairwise(edges_s.tolist()):
        along, across = (
            _factor(target[rows], by[rows])
            for target, by, rows in (
                (forward_m, m.mean_m, (m.start_s >= begin_s) & (m.end_s <= end_s)),
                (turns.target, of.difference_m, (of.start_s >= begin_s) & (of.end_s <= end_s)),
            )
        )
        if along > 0 and across > 0:
            factors.append((along, across))
    if len(factors) < FEWEST:
        return ""
    logs = np.log(factors).T
    if np.ptp(logs, axis=1).min() < np.log(CHANGED) or np.corrcoef(logs)[0, 1] < TOGETHER:
        return ""
    if np.std(logs[0] - logs[1]) > APART * np.std(logs[0]):
        return ""
    least, most = np.exp([logs[0].min(), logs[0].max()])
    return (
        f"a metre of tread travel moves the robot by {least:.2f} to {most:.2f} m in parts of the "
        "recording, and turns it by what changes alike (a scale of the treads that drifts)"
    )


def _factor(target: FloatArray, by: FloatArray) -> float:
    """0 where it is not certain."""
    found = relation(target, by)
    sure = found is not None and found.certain(0, CERTAIN) and found.correlation > HELD
    return found.slope if found is not None and sure else 0.0
