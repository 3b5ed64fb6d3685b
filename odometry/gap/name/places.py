"""Maps of what no name explains: candidates that follow where the robot is."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.effects.unknown.residual import TREADS, WORLD
from odometry.effects.unknown.residual_of_place import AXES, ResidualOfPlace
from odometry.gap.config import GapConfig
from odometry.windows.dense.dense import DenseWindows

FINER = np.sqrt(0.5)  # of one spacing to the next that is tried
ADDED_TO = (  # components, and what they grow with
    *((TREADS, "speed"), (WORLD, ""), (("v_x",), "v_x"), (("omega",), "omega")),
    *((("left",), "speed"), (("right",), "speed")),
)


def maps(scenes: Sequence[DenseWindows], config: GapConfig) -> tuple[ResidualOfPlace, ...]:
    """Functions of place, on grids of few nodes and of many.

    None where the robot seldom comes back: what follows the place follows run time as well.
    """
    return _of_grids(scenes, [(most, "") for most in config.nodes], config)


def finer_maps(scenes: Sequence[DenseWindows], config: GapConfig) -> tuple[ResidualOfPlace, ...]:
    """The same in more detail, and of x or of y alone."""
    of_axes = [(config.axis_nodes, axis) for axis in AXES]
    return _of_grids(scenes, [(config.further_nodes, ""), *of_axes], config)


def _of_grids(
    scenes: Sequence[DenseWindows], grids: Sequence[tuple[int, str]], config: GapConfig
) -> tuple[ResidualOfPlace, ...]:
    """Of each grid, given by its most nodes and its axis, one to each that it may be added to."""
    found: list[ResidualOfPlace] = []
    if any(scene.inputs.position_m is None for scene in scenes):
        return ()
    positions = np.concatenate([np.asarray(scene.inputs.position_m) for scene in scenes])
    pieces = _pieces(scenes, config.part_s)
    for most, axis in grids:
        grid = finest_grid(positions, most, config.least_spacing_m, axis)
        if grid is None or _revisited(grid, positions, pieces) < config.least_revisited:
            continue
        for components, by in ADDED_TO:
            terms = tuple((to, k) for to in components for k in range(len(grid.nodes)))
            found.append(replace(grid, terms=terms, by=by))
    return tuple(found)


def finest_grid(
    positions_m: FloatArray, most: int, least_m: float, axis: str = ""
) -> ResidualOfPlace | None:
    """The grid of the finest spacing that has so many nodes at most where the robot was."""
    if axis:
        positions_m = positions_m * [float(one == axis) for one in AXES]
    found: ResidualOfPlace | None = None
    spacing_m = float(np.ptp(positions_m, axis=0).max())
    while spacing_m >= least_m:
        nodes = _nodes(positions_m, spacing_m)
        grid = ResidualOfPlace(spacing_m=spacing_m, nodes=nodes, axis=axis)
        if len(grid.nodes) > most:
            break
        found, spacing_m = grid, spacing_m * float(FINER)
    return found


def _nodes(positions_m: FloatArray, spacing_m: float) -> tuple[tuple[int, int], ...]:
    """Nodes that are nearest to some position."""
    nearest = np.unique(np.rint(positions_m / spacing_m).astype(np.int64), axis=0)
    return tuple((int(i), int(j)) for i, j in nearest)


def _revisited(grid: ResidualOfPlace, positions_m: FloatArray, pieces: IntArray) -> float:
    """Share of the samples at nodes at which the robot was, elsewhere for a piece, and again."""
    near = grid.hats(positions_m).argmax(axis=1)
    visits = np.unique(np.column_stack([near, pieces]), axis=0)
    apart = (np.diff(visits[:, 0]) == 0) & (np.diff(visits[:, 1]) > 1)
    again = np.unique(visits[1:, 0][apart])
    return float(np.isin(near, again).mean())


def _pieces(scenes: Sequence[DenseWindows], part_s: float) -> IntArray:
    """Number of the piece of its run in which each sample of all is; no two runs share one."""
    numbers, begin = [], 0
    for scene in scenes:
        here = np.floor(scene.time_s / part_s).astype(np.int64)
        numbers.append(begin + here)
        begin += int(here.max(initial=0)) + 2
    return np.concatenate(numbers)
