"""Play of a drive: a tread that moves a little after each reversal before its encoder does."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.statistics.least_squares import Columns
from odometry.checks.treads.turns_by_treads import Turns, turns_by_treads

STANDING = 0.01  # of the ordinary fastest speed
LONGEST_S = 3.0  # before a tread reads the other direction, in which it may move unread
LEAST_REVERSALS = 4
# Of real recordings as they are, standard deviations are 4.1 at most where treads explain 0.9 of
# the turns; of simulated drives with play of 0.05 to 0.35 m half have more than 7.
EXPLAINED, CERTAIN, LEAST_M = 0.9, 7.0, 0.03
NEAR = 0.7  # share of the squares that is left in the windows of reversals


def play(evidence: Evidence) -> str:
    """Words where turns lack one way at each reversal of a tread; "" elsewhere."""
    turns = turns_by_treads(evidence)
    if turns is None or turns.share > 1 - EXPLAINED:
        return ""
    found = [_lost_m(evidence, turns, side) for side in range(2)]
    seen = [
        f"the {('left', 'right')[side]} tread moves by {lost_m:.2g} m"
        for side, lost_m in enumerate(found)
        if lost_m > 0
    ]
    if not seen:
        return ""
    return f"by the turns {' and '.join(seen)} unread at each reversal, as by play of its drive"


def _lost_m(evidence: Evidence, turns: Turns, side: int) -> float:
    """The way that a tread moves unread at each reversal; 0 where it is not certain."""
    unread = _unread(evidence, turns, side)
    if unread is None:
        return 0.0
    rows = np.stack([turns.left_m, turns.right_m, turns.lasts_s])
    _, plain = turns.fit(*rows)
    left, found = turns.fit(*rows, unread)
    variances = Columns(np.vstack([rows, unread])).variances()
    sigma = np.sqrt(left * turns.squares / len(unread) * variances[3])
    lost_m = float(found[3] / found[side])
    near = unread != 0
    before, after = (
        float(np.sum((turns.turned_rad - of @ columns)[near] ** 2))
        for of, columns in ((plain, rows), (found, np.vstack([rows, unread])))
    )
    sure = abs(found[3]) > CERTAIN * sigma and lost_m > LEAST_M and after < NEAR * before
    return lost_m if sure else 0.0


def _unread(evidence: Evidence, turns: Turns, side: int) -> FloatArray | None:
    """Share (K,) of each reversal that lies in a window, with the sign of the new direction.

    It is spread over the time between the last reading of one sign and the first of the other.
    None with few reversals.
    """
    speeds = evidence.speeds_m_s[:, side]
    moving = np.flatnonzero(np.abs(speeds) > STANDING * evidence.fastest_m_s)
    signs = np.sign(speeds[moving])
    turned = np.flatnonzero(signs[1:] != signs[:-1])
    if len(turned) < LEAST_REVERSALS:
        return None
    end_s = evidence.stamps_s[moving[turned + 1]]
    begin_s = np.maximum(evidence.stamps_s[moving[turned]], end_s - LONGEST_S)
    edges_s = np.stack([begin_s, end_s], axis=-1).ravel()  # each begins where the last one ended
    passed = np.repeat(np.append(0.0, np.cumsum(signs[turned + 1])), 2)[1:-1]
    ends_s = turns.start_s, turns.start_s + turns.lasts_s
    first, last = (np.interp(at_s, edges_s, passed) for at_s in ends_s)
    unread = last - first
    return unread if unread.any() else None
