"""One tread that reads faster for moments, while the robot turns as before and after."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.statistics.relation import relation
from odometry.checks.turns.measured_turns import measured_turns

# Rows of windows of half a second, between which such a moment lies: both ends are ordinary.
REACH, LONGEST_S = 2, 5.0
FASTER = 0.25  # of the ordinary fastest speed, than before and after
TIMES = 5.0  # the usual residual of the turns
ENDS = 0.3  # share of what is not explained, that is left at both ends
LIKE = (0.6, 1.6)  # of what the tread reads more, that the turn lacks
# On one side, and how many times more often than on the other. As recorded 3 and less in 44 real
# recordings; 5 and more in 38 of 44 drives to which ten such moments of half a second were added.
LEAST, ONE_SIDE = 5, 5
EXPLAINED = 0.5  # share of the turns that the treads explain


def moments_of_spin(evidence: Evidence) -> str:
    """Words where one tread often reads faster for half a second and no turn follows; "" else.

    A wheel that loses the terrain for a moment spins free.
    """
    measured = next(measured_turns(evidence))
    m, target = measured.motion, measured.target
    fit = relation(target, m.left_m, m.right_m, m.lasts_s)
    if fit is None or fit.explained < EXPLAINED or not (fit.certain(0) and fit.certain(1)):
        return ""
    way_m = (m.left_m, m.right_m)
    usual = 1.4826 * float(np.median(np.abs(fit.residuals[np.isfinite(fit.residuals)])))
    near = m.end_s[2 * REACH :] - m.start_s[: -2 * REACH] < LONGEST_S
    found = [
        near
        & (np.abs(fit.residuals[REACH:-REACH]) > TIMES * usual)
        & _moments(
            way_m[side] / m.lasts_s / evidence.fastest_m_s,
            -fit.residuals / fit.coefficients[side] / m.lasts_s / evidence.fastest_m_s,
        )
        for side in range(2)
    ]
    counts = [int(of.sum()) for of in found]
    side = int(np.argmax(counts))
    if counts[side] < max(LEAST, ONE_SIDE * counts[1 - side]):
        return ""
    first_s = evidence.run_time_s(float(m.start_s[REACH:-REACH][found[side]][0]))
    return (
        f"{('v_left', 'v_right')[side]} reads faster {counts[side]} times for about half a second "
        f"(first at {first_s:.1f} s), and the robot turns as before and after, as by a wheel that "
        "spins free for a moment"
    )


def _moments(speeds: FloatArray, more: FloatArray) -> BoolArray:
    """Windows (K - 2 REACH,) in which a tread is faster by about what the turns lack.

    Parameters
    ----------
    speeds : (K,)
        Of the tread, as shares of the ordinary fastest.
    more : (K,)
        By which it reads more than the turns say, likewise.
    """
    before, here, after = (slice(None, -2 * REACH), slice(REACH, -REACH), slice(2 * REACH, None))
    rise = speeds[here] - (speeds[before] + speeds[after]) / 2
    ends = np.maximum(np.abs(more[before]), np.abs(more[after]))
    like = more[here] / np.where(rise == 0, np.inf, rise)
    faster = (np.abs(rise) > FASTER) & (rise * speeds[here] > 0)
    return np.asarray(
        faster & (ends < ENDS * np.abs(more[here])) & (like > LIKE[0]) & (like < LIKE[1])
    )
