"""What a fault of a drive is: how it is drawn, and what a filter should say of it."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.blind.faults.fault import UnsuitableError
from tests.blind.faults.recordings import Recording

SHARE = 0.1  # of wheel travel: what reckoning may lose while nothing corrects it


@dataclass(frozen=True, eq=False)
class Case:
    """A faulty copy of a recording.

    Attributes
    ----------
    recording : Recording
        What the program is given.
    reference : dict
        Columns t, x, y, yaw of where the robot was.
    begin_s, end_s : float
        When the fault acts.
    size_m : float
        How far a correct filter may be off by poses that are consistently wrong.
    reckons : bool
        Whether the robot must reckon while the fault acts, so that an error grows with travel.
    """

    recording: Recording
    reference: dict
    begin_s: float
    end_s: float
    size_m: float = 0.0
    reckons: bool = False


@dataclass(frozen=True)
class DriveFault:
    """A kind of fault.

    Attributes
    ----------
    key : str
    truth : str
        What happened, in one sentence.
    kinds : str
        Regular expression that a right flag's kind contains.
    draw : callable
        Recording and Generator to a Case; UnsuitableError where there is no place for it.
    named : bool
        The issue names it.
    flag : bool
        Whether silence would be wrong. A fault that a filter can absorb needs no flag.
    """

    key: str
    truth: str
    kinds: str
    draw: Callable = field(repr=False)
    named: bool = False
    flag: bool = True


def reference_of(recording):
    """Columns of truth.csv where there is one, else of pose.csv."""
    table = recording["truth" if "truth" in recording else "pose"]
    return {name: table[name] for name in ("t", "x", "y", "yaw")}


def acts(recording, begin_s, end_s, *, reference=None, size_m=0.0, reckons=False):
    """The case of a changed recording; what the program must not see is taken away."""
    given = recording.without("truth") if "truth" in recording else recording
    where = reference_of(recording) if reference is None else reference
    return Case(given, where, float(begin_s), float(end_s), size_m, reckons)


def span(recording, rng, length_s, least_m=0.0):
    """Begin and end of a stretch of a given length at a random moment, with wheel travel."""
    t = recording["pose"]["t"]
    first, last = t[0] + 0.15 * np.ptp(t), t[-1] - 0.1 * np.ptp(t) - length_s
    if last <= first:
        raise UnsuitableError
    for _ in range(100):
        begin = rng.uniform(first, last)
        if travel_m(recording, begin, begin + length_s) >= least_m:
            return begin, begin + length_s
    raise UnsuitableError


def during(table, begin_s, end_s):
    """Mask of the rows of a table between two stamps."""
    return (table["t"] >= begin_s) & (table["t"] < end_s)


def travel_m(recording, begin_s, end_s):
    """Wheel travel between two stamps."""
    table = recording["odometry"]
    sums = np.r_[0.0, np.cumsum(speed(table)[:-1] * np.diff(table["t"]))]
    return float(np.diff(np.interp([begin_s, end_s], table["t"], sums))[0])


def speed(table):
    return (np.abs(table["v_left"]) + np.abs(table["v_right"])) / 2


def posed(recording, **columns):
    return recording.with_columns("pose", **columns)


def driven(recording, **columns):
    return recording.with_columns("odometry", **columns)
