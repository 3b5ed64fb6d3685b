"""What a comparison finds out, window by window."""

from collections.abc import Mapping
from dataclasses import dataclass

from odometry.comparison.judged import JudgedWindows
from odometry.evaluation.fitness import Fitness
from odometry.windows.window_errors import WindowErrors


@dataclass(frozen=True)
class Judgement:
    """Models on the windows of one part of a run, over one horizon.

    Attributes
    ----------
    robot, ground, run : str
    seen : str
        What the identified models had seen.
    horizon_m : float
    judged : JudgedWindows
    errors : Mapping of model to WindowErrors
        Without the models that failed here.
    """

    robot: str
    ground: str
    run: str
    seen: str
    horizon_m: float
    judged: JudgedWindows
    errors: Mapping[str, WindowErrors]


@dataclass(frozen=True)
class Shortfall:
    """What could not be judged, and why; `model` is "" where it concerns all of them."""

    robot: str
    ground: str
    run: str
    model: str
    reason: str


@dataclass(frozen=True)
class RunFitness:
    """Dead reckoning of a whole run under one model, each row held out."""

    robot: str
    run: str
    model: str
    fitness: Fitness
