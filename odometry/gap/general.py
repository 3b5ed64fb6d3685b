"""Smooth functions of all that was recorded: what a name of the catalogue has to beat.

An effect that no catalogue has still follows something: run time, a tread's own speed, the
heading. Each function of one variable is a candidate, with as many numbers as it needs.
"""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.residual import (
    ANGLES,
    COMPONENTS,
    HARMONICS,
    OF_TREADS,
    TREADS,
    Residual,
    variables_of,
)
from odometry.gap.config import GapConfig
from odometry.windows.dense import DenseWindows

INNER = (0.02, 0.98)  # quantiles between which knots lie
LEAST_RANGE = 1e-3  # of a variable that says anything


def general_candidates(
    scenes: Sequence[DenseWindows], base: Base, config: GapConfig
) -> tuple[Residual, ...]:
    """One or two of every variable that all runs have and that varies.

    What a tread's own motion does, it does to the tread; what angles do grows with speed or not;
    run time may take away a share of each tread's speed, or add a motion.
    """
    of_scenes = [variables_of(s.inputs, base.model.twist(base.values, s.inputs)) for s in scenes]
    shared = [name for name in of_scenes[0] if all(name in other for other in of_scenes)]
    found: list[Residual] = []
    for name in shared:
        if name in ANGLES:
            terms = _every(COMPONENTS, 2 * HARMONICS)
            found += [Residual(name, terms, by_speed) for by_speed in (False, True)]
            continue
        knots = _knots(np.concatenate([of[name].ravel() for of in of_scenes]), name, config)
        if len(knots) < 2:
            continue
        if name in OF_TREADS:
            found.append(Residual(name, _every(TREADS, len(knots)), False, knots))
            continue
        found.append(Residual(name, _every(COMPONENTS, len(knots)), False, knots))
        if name == "time":
            found.append(Residual(name, _every(TREADS, len(knots)), True, knots))
    return tuple(found)


def _knots(values: FloatArray, name: str, config: GapConfig) -> tuple[float, ...]:
    """Even in the share of samples between them; none where the variable hardly varies.

    Those of a tread's motion are even about zero, where what drives do changes its sign.
    """
    if name in OF_TREADS:
        largest = max(float(np.quantile(np.abs(values), INNER[1])), LEAST_RANGE / 2)
        half = np.geomspace(largest / 16, largest, config.tread_knots)
        places = np.concatenate([-np.flip(half), [0.0], half])
    else:
        places = np.unique(np.quantile(values, np.linspace(*INNER, config.knots)))
    if len(places) < 2 or np.ptp(places) <= LEAST_RANGE:
        return ()
    return tuple(float(place) for place in places)


def _every(components: Sequence[str], functions: int) -> tuple[tuple[str, int], ...]:
    return tuple((component, k) for component in components for k in range(functions))
