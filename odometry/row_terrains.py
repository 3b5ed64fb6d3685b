"""The terrain of a run, row by row."""

from dataclasses import replace

import numpy as np

from odometry.arrays import AnyArray
from odometry.run import UNKNOWN, UNNAMED_TERRAIN, Run


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
