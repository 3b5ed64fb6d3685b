"""Terrain of a run: under its robot, and by row."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray
from odometry.recording.run import UNKNOWN, UNNAMED_TERRAIN, Run


@dataclass(frozen=True, slots=True)
class Footing:
    """The terrain in force and the shares of all terrains under the footprint.

    Attributes
    ----------
    terrain : str
        The one with the largest share, as a rule.
    shares : Mapping of str to float
        Above zero; they add up to 1. On one terrain alone its share is 1.
    """

    terrain: str
    shares: Mapping[str, float]

    @classmethod
    def of(cls, terrain: "str | Footing") -> "Footing":
        """A name is a footing on one terrain."""
        return cls(terrain, {terrain: 1.0}) if isinstance(terrain, str) else terrain

    @property
    def is_whole(self) -> bool:
        """Whether all of the footprint is on one terrain."""
        return len(self.shares) == 1


def with_named_terrain(run: Run, given: str | None) -> Run:
    """The run with a name for every terrain: `given`, or "ground", where it has no name."""
    usual = run.terrain if run.terrain not in (None, UNKNOWN) else given or UNNAMED_TERRAIN
    settings = {**run.settings, "run": {**run.settings.get("run", {}), "terrain": usual}}
    odometry = run.odometry
    if "terrain" in odometry:
        names = odometry["terrain"].astype(object)
        named = np.where((names == "") | (names == UNKNOWN), usual, names)
        odometry = replace(odometry, columns={**odometry.columns, "terrain": named})
    return replace(run, settings=settings, odometry=odometry)


def row_terrains(run: Run) -> AnyArray:
    """Name of the terrain (N,) at each row of odometry.csv.

    Its column `terrain` where there is one, else the run's; "unknown" where neither names one.
    """
    usual = run.terrain or UNKNOWN
    if "terrain" not in run.odometry:
        return np.full(len(run.odometry), usual, dtype=object)
    names = run.odometry["terrain"].astype(object)
    return np.asarray(np.where(names == "", usual, names))
