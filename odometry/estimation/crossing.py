"""ICRs of a robot astride an edge: they move from one terrain's to the other's by shares."""

from collections.abc import Mapping

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.estimate import OF_TERRAIN, IcrBelief
from odometry.estimation.measurement import Gaussian


def crossed(
    belief: Gaussian,
    known: Mapping[str, IcrBelief],
    before: Mapping[str, float],
    after: Mapping[str, float],
    opened: Mapping[str, FloatArray],
) -> Gaussian:
    """Carry a belief from some shares of terrains to others.

    The mean moves by what each terrain gains or loses of its share, times the ICRs known there,
    so that what was learned on the way stays. Whole to whole in many steps moves it as in one.

    Parameters
    ----------
    belief : mean (9,), covariance (9, 9)
    known : Mapping of terrain to IcrBelief
        The ICRs of every terrain that has or had a share.
    before, after : Mapping of terrain to share
    opened : Mapping of terrain to (5, 5)
        Covariance that a whole share gained adds to that of the ICRs and slip factors.
    """
    mean, covariance = belief[0].copy(), belief[1].copy()
    block = np.ix_(OF_TERRAIN, OF_TERRAIN)
    for name, of in known.items():
        gained = after.get(name, 0.0) - before.get(name, 0.0)
        mean[OF_TERRAIN] += gained * np.concatenate([of.icrs, of.alphas])
        if gained > 0:
            covariance[block] += gained * opened[name]
    return mean, covariance
