"""Both columns of the treads hold one speed."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.turning import lasting_turn_rad

EQUAL = 0.98  # share of the rows in motion; encoders of two treads differ in their last digits
LEAST_ROWS = 100
LEAST_TURN_RAD = 1.0  # range of the heading that equal treads do not explain


def equal_treads(evidence: Evidence) -> Iterator[Finding]:
    """A robot that turns while v_left and v_right are the same number in each row."""
    left, right = evidence.speeds_m_s.T
    moving = (left != 0) | (right != 0)
    if moving.sum() < LEAST_ROWS or np.mean(left[moving] == right[moving]) < EQUAL:
        return
    measured = (
        ("the gyroscope", evidence.uniform.gyroscope_rad, evidence.uniform.lasts_s),
        ("the poses", evidence.pose_turn_rad, evidence.turn_motion.lasts_s),
    )
    for name, turns, lasts_s in measured:
        if (turned_rad := lasting_turn_rad(turns, lasts_s)) > LEAST_TURN_RAD:
            yield Finding(
                "treads_equal",
                Level.WARNING,
                f"v_left equals v_right in {100 * np.mean(left[moving] == right[moving]):.0f} % of "
                f"the rows in motion, and {name} turns over a range of {turned_rad:.2g} rad",
                "Both columns hold one speed: the mean of the treads, or one tread twice",
                "Log the speed of each tread; the turns are lost",
            )
            return
