"""A force that depends on the motion that depends on the force: solved for many at once."""

from collections.abc import Callable

import numpy as np

from odometry.arrays import FloatArray

NEWTON_STEPS = 20
HALVINGS = 60  # from the limit down to its last digit
TOLERANCE = 4 * np.finfo(float).eps  # of the limit

ForceAt = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


def consistent_force(force_at: ForceAt, limit_n: FloatArray) -> FloatArray:
    """Force (...) with force = min(force_at(force), limit), by Newton's method within a bracket.

    Between 0 and the limit there is always such a force. Newton's method starts from no force;
    a step out of the bracket is replaced by its middle, and so are all steps after the
    twentieth. Where several forces are consistent (only if the force feeds back on itself more
    than one to one), the answer is one of them, for one sample always the same.

    Parameters
    ----------
    force_at : callable
        From a force (...) [N], not negative, to (...) the force that the motion under it would
        cause, not negative, and its derivative.
    limit_n : (...)
        [N]
    """
    low, high = np.zeros_like(limit_n), np.array(limit_n)
    force = low
    for step in range(NEWTON_STEPS + HALVINGS):
        caused, slope = force_at(force)
        excess = np.minimum(caused, limit_n) - force
        settled = np.abs(excess) <= TOLERANCE * limit_n
        if np.all(settled):
            break
        low, high = np.where(excess > 0, force, low), np.where(excess > 0, high, force)
        proposed = (low + high) / 2
        if step < NEWTON_STEPS:
            slope = np.where(caused < limit_n, slope, 0.0)
            ahead = force + excess / np.where(slope < 1, 1 - slope, np.inf)
            proposed = np.where((slope < 1) & (ahead > low) & (ahead <= high), ahead, proposed)
        force = np.where(settled, force, proposed)
    return force
