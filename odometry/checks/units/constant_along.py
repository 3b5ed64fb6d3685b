"""Treads that read less by a constant than the robot moves or turns: no factor does as well."""

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.statistics.relation import relation
from odometry.checks.units.effective_width import WIDTH

MOVING = 0.01  # of the ordinary fastest speed: slower is noise of a tread that stands
# Share of what a factor leaves of the way that a constant beside it leaves: 0.31 and 0.43 of two
# drives with a dead zone, 0.74 and more of 34 whose speeds were scaled.
LEFT, TIMES = 0.6, 5.0  # standard deviations
# The same of turns: 0.56 to 0.68 of four draws of a dead zone on one drive, 0.76 and more of 28
# drives that were made narrow by a track width, of which a constant makes none but one ordinary.
TURNS_LEFT = 0.72


def reads_less(evidence: Evidence) -> str:
    """Words where the way asks for a constant that both treads read too little; "" elsewhere."""
    m = evidence.motion
    moves = np.abs(m.mean_m) > MOVING * evidence.fastest_m_s * m.lasts_s
    constant_s = np.where(moves, np.sign(m.mean_m) * m.lasts_s, 0.0)
    factor = relation(evidence.forward_m, m.mean_m)
    both = relation(evidence.forward_m, m.mean_m, constant_s)
    if factor is None or both is None or not both.certain(1, TIMES) or both.coefficients[1] < 0:
        return ""
    if 1 - both.explained > LEFT * (1 - factor.explained):
        return ""
    slope, constant_m_s = both.coefficients
    return (
        f"{slope:.3g} m and {constant_m_s:.2g} m/s more while it moves fit far better, as where "
        "slow speeds read zero (a dead zone) and others too little by as much"
    )


def turns_less(evidence: Evidence) -> str:
    """Words where turns ask for a constant that treads read too little, and for no odd width.

    "" elsewhere.
    """
    m, turn_rad = evidence.uniform, evidence.uniform.gyroscope_rad
    if evidence.yaw_rate is None:
        m, turn_rad = evidence.turn_motion, evidence.pose_turn_rad
    least_m = MOVING * evidence.fastest_m_s * m.lasts_s
    left, right = (
        np.where(np.abs(way_m) > least_m, np.sign(way_m), 0.0) for way_m in (m.left_m, m.right_m)
    )
    factor = relation(turn_rad, m.difference_m)
    both = relation(turn_rad, m.difference_m, (right - left) * m.lasts_s)
    if factor is None or both is None or not both.certain(1, TIMES):
        return ""
    slope, constant = both.coefficients
    track_m = evidence.run.robot.track_width
    width = 1 / (abs(slope) * track_m)
    alike = 1 - both.explained > TURNS_LEFT * (1 - factor.explained)
    if alike or constant / slope < 0 or not WIDTH[0] <= width <= WIDTH[1]:
        return ""
    return (
        f"the robot turns as if {1 / (abs(factor.slope) * track_m):.3g} track widths wide; as if "
        f"{width:.3g}, and as if each tread were {constant / slope:.2g} m/s faster while it moves, "
        "fits far better, as where slow speeds read zero (a dead zone) and others too little by as "
        "much"
    )
