"""Where the pieces of smooth functions of a variable meet."""

from collections.abc import Mapping, Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.residual import ANGLES, OF_TREADS, variables_of
from odometry.gap.config import GapConfig
from odometry.windows.dense import DenseWindows

INNER = (0.02, 0.98)  # quantiles between which knots lie
LEAST_RANGE = 1e-3  # of a variable that can explain anything
SINCE_REVERSAL_M = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8)  # gears, tracks and casters settle
STATED = {
    "travel_since_reversal": SINCE_REVERSAL_M,
    "tread_travel_since_reversal": SINCE_REVERSAL_M,
}


def knots_of_variables(
    scenes: Sequence[DenseWindows], base: Base, config: GapConfig
) -> Mapping[str, tuple[float, ...]]:
    """Knots of every variable that all runs have and that varies; none of angles."""
    of_scenes = [variables_of(s.inputs, base.model.twist(base.values, s.inputs)) for s in scenes]
    shared = [name for name in of_scenes[0] if all(name in other for other in of_scenes)]
    found = {}
    for name in shared:
        values = np.concatenate([of[name].ravel() for of in of_scenes])
        knots = () if name in ANGLES else _knots(values, name, config)
        if name in ANGLES or len(knots) > 1:
            found[name] = knots
    return found


def _knots(values: FloatArray, name: str, config: GapConfig) -> tuple[float, ...]:
    """Even in the share of samples between them; none where the variable hardly varies.

    Those of a tread's motion are even about zero, where what drives do changes its sign.
    """
    if name in STATED:
        return STATED[name]
    if name in OF_TREADS:
        largest = max(float(np.quantile(np.abs(values), INNER[1])), LEAST_RANGE / 2)
        half = np.geomspace(largest / 16, largest, config.tread_knots)
        places = np.concatenate([-np.flip(half), [0.0], half])
    else:
        places = np.unique(np.quantile(values, np.linspace(*INNER, config.knots)))
    if len(places) < 2 or np.ptp(places) <= LEAST_RANGE:
        return ()
    return tuple(float(place) for place in places)
