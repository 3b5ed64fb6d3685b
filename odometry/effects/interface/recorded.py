"""The recorded data of the measured runs, from which effects are determined."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.models.inputs import Inputs
from odometry.recording.run import UNKNOWN

CRAWLING_M_S = 0.25  # fastest speed down to which searches of speeds are as for fast robots


@dataclass(frozen=True)
class Recorded:
    """Measured runs as the effects use them.

    Attributes
    ----------
    base : Base
        The base model, and its robot.
    inputs : tuple of Inputs
        Of each run (N,).
    observed_s : tuple of (float, float)
        Of each run: when its first window ends and its last one begins, in run time.
    calibrated : frozenset of str
        Terrains on which the base was identified.
    reported : tuple of Reported
        Of each run: what the reference reported.
    """

    base: Base
    inputs: tuple[Inputs, ...]
    observed_s: tuple[tuple[float, float], ...]
    calibrated: frozenset[str] = frozenset()
    reported: "tuple[Reported, ...]" = ()

    @property
    def longest_s(self) -> float:
        """Run time at which the longest run ends."""
        return max(float(np.max(of.time_s)) for of in self.inputs if of.time_s is not None)

    @property
    def fastest_m_s(self) -> float:
        """Of any tread."""
        return max(float(np.abs(of.tread_speeds_m_s).max()) for of in self.inputs)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Terrains that the runs name."""
        return tuple(sorted(set().union(*map(labels_of, self.inputs))))

    @cached_property
    def is_on_one_terrain(self) -> bool:
        """Whether every sample of every run has one and the same label."""
        of_runs = [np.asarray(of.terrain) for of in self.inputs if of.terrain is not None]
        labels = set().union(*(np.unique(of.astype(str)).tolist() for of in of_runs))
        return len(of_runs) == len(self.inputs) and len(labels) == 1

    @cached_property
    def lateral_m_s2(self) -> float:
        """Lateral acceleration that one sample in twenty of some run exceeds, by the base."""
        return max(self._lateral_m_s2(of) for of in self.inputs)

    def _lateral_m_s2(self, inputs: Inputs) -> float:
        twist = self.base.model.twist(self.base.values, inputs)
        return float(np.percentile(np.abs(twist[:, 0] * twist[:, 2]), 95))


def crawling(fastest_m_s: float) -> float:
    """Share of CRAWLING_M_S that a fastest speed is, 1 at most; 1 of a robot at rest, too."""
    return min(1.0, fastest_m_s / CRAWLING_M_S) or 1.0


def labels_of(inputs: Inputs) -> set[str]:
    """Terrains that a recording names."""
    if inputs.terrain is None:
        return set()
    return set(np.unique(np.asarray(inputs.terrain).astype(str))) - {UNKNOWN, ""}


@dataclass(frozen=True)
class Reported:
    """Poses of one run as the reference reported them.

    Attributes
    ----------
    stamps_s : (M,)
        In run time.
    poses : (M, 3)
        x, y [m], yaw [rad]; yaw need not be wrapped.
    run : int or None
        Number of the run among those that effects were fitted to, and those after them that they
        are judged by; None: another, of which nothing that is a run's own is known.
    yaw_is_found : bool
        Whether the yaw was found from positions and a gyroscope, and not measured.
    """

    stamps_s: FloatArray
    poses: FloatArray
    run: int | None = None
    yaw_is_found: bool = False

    @property
    def yaw_rad(self) -> FloatArray:
        """Yaw (M,)."""
        return np.asarray(self.poses[:, 2])

    def of(self, poses: FloatArray) -> "Reported":
        """The same with other poses (M, 3)."""
        return replace(self, poses=poses)
