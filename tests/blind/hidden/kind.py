"""What a kind of case hides, and which answers about it are true, acceptable or wrong."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np


def as_it_is(values, *_):
    return values


@dataclass(frozen=True, eq=False)
class Hidden:
    """What is hidden in one run; each field changes one thing on its way from command to file.

    Rows are the N steps of the simulation, at `Clock.times_s`.

    Attributes
    ----------
    truth : dict
        Parameters, for the reader.
    treads : callable
        Commanded tread speeds (N, 2) [m/s] to those of the treads over the terrain.
    icrs : callable
        ICR parameters by name, each (N,), and tread speeds, to other parameters.
    twist : callable
        Body twist (N, 3), tread speeds (N, 2), to another twist.
    at_place : callable or None
        row, (x, y, yaw, roll, pitch), twist (3,) to a twist (3,), where the place matters.
    reported : callable
        Commanded tread speeds (N, 2) and those of the treads, to the speeds that are recorded.
    reference : callable
        Stamps (K,) [s] and poses (K, 3) of the sensor to both as they are recorded.
    gyroscope : callable
        Yaw rate (N,) to what the gyroscope reports.
    parts : tuple of Hidden
        What is hidden, one by one, where it is more than one thing.
    """

    truth: dict[str, Any] = field(default_factory=dict)
    treads: Callable = as_it_is
    icrs: Callable = as_it_is
    twist: Callable = as_it_is
    at_place: Callable | None = None
    reported: Callable = as_it_is
    reference: Callable = lambda times_s, poses: (times_s, poses)
    gyroscope: Callable = as_it_is
    parts: tuple["Hidden", ...] = ()


@dataclass(frozen=True, eq=False)
class Kind:
    """A kind of hidden effect.

    Families are plain words for answers; a study says which names of the program mean them. A
    family may be followed by a course: "wheel size gradual" is meant only with that course.

    Attributes
    ----------
    draw : callable
        rng, scene to hide(rng, clock); hide gives the `Hidden` of one run, so that what belongs to
        the robot is drawn once, and moments and places anew for each run.
    true : tuple of tuples of str
        For each effect that is hidden, the families that are right.
    acceptable : tuple of str
        Families that are not the truth, but that nobody could call misled.
    without_gyroscope : tuple of str
        More acceptable families where no gyroscope is recorded.
    course : str
        Course in time of the truth: from_a_moment, gradual, in_bursts, or "" (steady).
    style : str
        How the runs are driven: any, or crawl.
    gyroscope : str
        either, or always.
    labels : int
        Terrains that are labelled in all runs.
    sloped : bool
        Whether the measured and held-out runs are on slopes.
    """

    draw: Callable
    true: tuple[tuple[str, ...], ...] = (("unknown",),)
    acceptable: tuple[str, ...] = ()
    without_gyroscope: tuple[str, ...] = ()
    course: str = ""
    style: str = "any"
    gyroscope: str = "either"
    labels: int = 0
    sloped: bool = False


@dataclass(frozen=True, eq=False)
class Clock:
    """Time of the simulation's steps in one run.

    Attributes
    ----------
    step_s : float
    times_s : (N,) array
        From 0.
    """

    step_s: float
    times_s: np.ndarray

    @property
    def duration_s(self):
        return float(self.times_s[-1])

    @property
    def share(self):
        """Share of the run that is over (N,), from 0 to 1."""
        return self.times_s / self.times_s[-1]
