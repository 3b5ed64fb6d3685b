"""Treads that read less by a constant than the robot moves: no factor does as well."""

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.relation import relation

MOVING = 0.01  # of the ordinary fastest speed: slower is noise of a tread that stands
# Share of what a factor leaves of the way that a constant beside it leaves: 0.31 and 0.43 of two
# drives with a dead zone, 0.74 and more of 34 whose speeds were scaled.
LEFT, TIMES = 0.6, 5.0  # standard deviations


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
