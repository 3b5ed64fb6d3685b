"""Cases driven by a formula: one robot, its ICRs, and effects of sizes that show."""

import itertools

import numpy as np

from tests.blind.commands import CALIBRATION_S, MEASURED_S, RATE_HZ, Limits, draw_commands
from tests.blind.drawn import Drawn
from tests.blind.effects import draw_effect
from tests.blind.ground import Ground, draw_ground
from tests.blind.motion import drive
from tests.blind.robot import draw_body, draw_icrs
from tests.blind.sizes import NOISE_FLOOR_M, size_m

SIZES_OF_FLOOR = (2.0, 10.0)
ATTEMPTS = 60


def draw_formula_case(kind, rng):
    """A robot and two runs in which each effect shows by itself, 2 to 10 times the noise floor."""
    names = () if kind == "none" else tuple(kind.split("+"))
    body = draw_body(rng)
    icrs = draw_icrs(rng, body)
    for _ in range(ATTEMPTS):
        truth = {name: draw_effect(name, rng, body, icrs) for name in names}
        ground = draw_ground(rng) if "slope_sliding" in names else Ground()
        limits = _limits(rng, icrs, truth)
        commands = draw_commands(rng, MEASURED_S, limits)
        labels = _labels(rng, truth, len(commands))
        world = {"ground": ground, "start": _start(rng), "labels": labels}
        alone = (
            size_m(drive(commands, body, icrs, one, **world), icrs, one)
            for one in ({name: truth[name]} for name in names)
        )
        if all(SIZES_OF_FLOOR[0] <= s / NOISE_FLOOR_M <= SIZES_OF_FLOOR[1] for s in alone):
            break
    else:
        raise ValueError(f"{kind}: no effect of the wanted size in {ATTEMPTS} draws")
    measured = drive(commands, body, icrs, truth, **world)
    again = draw_commands(rng, MEASURED_S, limits)
    other = _labels(rng, truth, len(again))
    holdout = drive(again, body, icrs, truth, ground=ground, start=_start(rng), labels=other)
    motions = {
        "calibration": (_calibration(rng, body, icrs, truth), {}),
        "measured": (measured, truth),
        "holdout": (holdout, truth),
    }
    named = tuple("unknown" if name.startswith("unknown") else name for name in names)
    return Drawn(body, motions, named, {"base": icrs.values(), **truth})


def _calibration(rng, body, icrs, truth):
    """At up to 0.5 m/s on level ground, on the first label where there are labels."""
    limits = Limits(0.5, 1.2, 1.0, icrs.width)
    commands = draw_commands(rng, CALIBRATION_S, limits)
    labels = None
    if "terrain" in truth:
        labels = np.full(len(commands), next(iter(truth["terrain"])))
    return drive(commands, body, icrs, {}, ground=Ground(), start=_start(rng), labels=labels)


def _limits(rng, icrs, truth):
    """Faster than the calibration; below v_max on slopes, harder turns for inertia."""
    speed = rng.uniform(1.0, 1.5)
    if "slope_sliding" in truth:
        speed = min(speed, 0.95 * truth["slope_sliding"]["v_max"])
    if "inertia" in truth:
        return Limits(speed, rng.uniform(1.8, 2.6), rng.uniform(2.0, 3.5), icrs.width)
    return Limits(speed, rng.uniform(0.9, 1.6), 1.5, icrs.width)


def _labels(rng, truth, count):
    """Names of the ground along a run, in stretches of 10 to 35 s; None where nobody names it."""
    if "terrain" not in truth:
        return None
    order = itertools.cycle(rng.permutation(list(truth["terrain"])))
    result, row = np.empty(count, dtype="U16"), 0
    while row < count:
        length = round(rng.uniform(10.0, 35.0) * RATE_HZ)
        result[row : row + length] = next(order)
        row += length
    return result


def _start(rng):
    return (*rng.uniform(-50.0, 50.0, size=2), rng.uniform(-np.pi, np.pi))
