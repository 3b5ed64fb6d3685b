"""Smooth functions of all that was recorded: what a name of the catalogue has to beat.

An effect that no catalogue has still follows something: run time, a tread's own speed, the
heading. Each function of one variable is a candidate, with as many numbers as it needs.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.measurement.reference_fault import all_round
from odometry.effects.unknown.history import BOTH, LAGS_S, History
from odometry.effects.unknown.leaning import LEANING
from odometry.effects.unknown.residual import (
    ANGLES,
    COMPONENTS,
    HARMONICS,
    OF_TREADS,
    TREADS,
    Residual,
    variables_of,
)
from odometry.effects.unknown.residual_variables import REPEATED, WHAT_WENT_BEFORE
from odometry.gap.config import GapConfig
from odometry.gap.name.places import maps
from odometry.windows.dense.dense import DenseWindows

MOTIONS = (  # components, each by what it may grow with
    *(("v_x", ""), ("v_x", "v_x"), ("v_x", "omega"), ("v_y", ""), ("v_y", "speed")),
    *(("v_y", "omega"), ("omega", ""), ("omega", "speed"), ("omega", "omega")),
)
WHOLE = ("v_x", "omega")  # parts of a twist of which a share may be taken


def general_candidates(
    scenes: Sequence[DenseWindows], base: Base, config: GapConfig
) -> tuple[Residual, ...]:
    """One or two of every variable of the moment that all runs have and that varies.

    Of what went before `History` alone is a rival of names. What a tread's own motion does, it
    does to the tread; what angles do grows with speed or not; run time may take away a share of
    each tread's speed, or add a motion.
    """
    found: list[Residual] = []
    for name, knots in knots_of_variables(scenes, base, config).items():
        if name in WHAT_WENT_BEFORE:
            continue
        if name in ANGLES:
            terms = every(COMPONENTS, 2 * HARMONICS + 1)
            found += [Residual(name, terms, by) for by in ("", "speed")]
            continue
        if name in OF_TREADS:
            found.append(Residual(name, every(TREADS, len(knots)), "", knots))
            continue
        found.append(Residual(name, every(COMPONENTS, len(knots)), "", knots))
        if name == "time":
            found.append(Residual(name, every(TREADS, len(knots)), "speed", knots))
    return (*found, *maps(scenes, config))


def shares_of_motion(
    scenes: Sequence[DenseWindows], base: Base, config: GapConfig
) -> tuple[Residual, ...]:
    """Shares of each tread's speed, of the forward speed or of the turn, by every variable.

    Most names take away a share of a motion: functions that cannot are no rivals of them. Knots of
    the whole motion are once even in samples and once in the variable: of a speed most samples lie
    at rest and at full speed, and what bends between has no knot there.
    """
    found: list[Residual] = []
    for name, knots in knots_of_variables(scenes, base, config).items():
        functions = len(knots) or 2 * HARMONICS + 1
        if name != "time":
            found.append(Residual(name, every(TREADS, functions), "speed", knots))
        if name in OF_TREADS:
            continue
        found += [Residual(name, every((part,), functions), part, knots) for part in WHOLE]
        found += _even_shares(name, knots, config)
    return tuple(found)


def _even_shares(name: str, knots: Sequence[float], config: GapConfig) -> list[Residual]:
    """Shares of the forward speed and of the turn, of knots that are even in the variable."""
    if not knots:
        return []
    evenly = tuple(map(float, np.linspace(knots[0], knots[-1], config.even_knots)))
    return [Residual(name, every((part,), len(evenly)), part, evenly) for part in WHOLE]


def single_candidates(
    scenes: Sequence[DenseWindows], base: Base, config: GapConfig
) -> tuple[Residual, ...]:
    """Smooth functions of every variable that add to one component or one tread alone.

    By themselves, in proportion to the speed, or to a part of the twist: each is so small that
    several may be added in turn, and a product of two variables is one of them.
    """
    lags = range(len(LAGS_S))
    found: list[Residual] = [History(terms=tuple((t, k) for k in lags)) for t in (BOTH, *TREADS)]
    for name, knots in knots_of_variables(scenes, base, config).items():
        functions = len(knots) or 2 * HARMONICS + 1
        added: list[tuple[str, str]] = [(tread, "speed") for tread in TREADS]
        if name in OF_TREADS:
            added += [(tread, "") for tread in TREADS]
        elif name != "time":
            added += MOTIONS
        found += [Residual(name, every((to,), functions), by, knots) for to, by in added]
        if name not in OF_TREADS and name != "time":
            found += _even_shares(name, knots, config)
    return tuple(found)


def every(components: Sequence[str], functions: int) -> tuple[tuple[str, int], ...]:
    """Terms of a smooth function: so many basis functions of each component."""
    return tuple((component, k) for component in components for k in range(functions))


INNER = (0.02, 0.98)  # quantiles between which knots lie
SINCE_REVERSAL_M = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8)  # gears, tracks and casters settle
SINCE_TURN_RAD = (0.0, 0.05, 0.1, 0.2, 0.4, 0.8)  # tyres that twist before they scrub
STATED = {
    "travel_since_reversal": SINCE_REVERSAL_M,
    "tread_travel_since_reversal": SINCE_REVERSAL_M,
    "turn_since_rest": SINCE_TURN_RAD,
    "turn_since_reversal": SINCE_TURN_RAD,
}


def knots_of_variables(
    scenes: Sequence[DenseWindows], base: Base, config: GapConfig
) -> Mapping[str, tuple[float, ...]]:
    """Knots of every variable that all runs have and that varies; none of angles.

    On headings over less than half a turn what follows them is something else: on one straight,
    the noise of the measured heading.
    """
    of_scenes = [variables_of(s.inputs, base.model.twist(base.values, s.inputs)) for s in scenes]
    shared = [name for name in of_scenes[0] if all(name in other for other in of_scenes)]
    if all(all_round(scene.inputs) for scene in scenes):
        shared = [name for name in shared if name != "heading"]
    found = {}
    for name in shared:
        values = np.concatenate([of[name].ravel() for of in of_scenes])
        knots = () if name in ANGLES else knots_of(values, name, config)
        if name in ANGLES or len(knots) > 1:
            found[name] = knots
    return found


def knots_of(values: FloatArray, name: str, config: GapConfig) -> tuple[float, ...]:
    """Even in the share of samples between them; none where the variable hardly varies.

    Those of a tread's motion are even about zero, where what drives do changes its sign. What a
    record says of repeated speeds, and what leans, is added by a share of it, one of each sign.
    """
    if name in STATED:
        return STATED[name]
    if name in (REPEATED, *LEANING):
        largest = float(np.abs(values).max(initial=0.0))
        places = np.array([-largest, 0.0, largest])
    elif name in OF_TREADS:
        largest = max(float(np.quantile(np.abs(values), INNER[1])), config.least_range / 2)
        half = np.geomspace(largest / 16, largest, config.tread_knots)
        places = np.concatenate([-np.flip(half), [0.0], half])
    else:
        places = np.unique(np.quantile(values, np.linspace(*INNER, config.knots)))
    if len(places) < 2 or np.ptp(places) <= config.least_range:
        return ()
    return tuple(float(place) for place in places)
