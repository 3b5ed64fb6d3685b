"""What follows the place, drawn where it is: a map of each component of the motion."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from scipy.spatial import cKDTree

from odometry.arrays import FloatArray
from odometry.effects.unknown.residual_of_place import ResidualOfPlace
from odometry.gap.answer.result import GapResult, NamedEffect
from odometry.report.drawing.figure import save_figure
from odometry.report.drawing.html import Picture

WIDTH_IN, HEIGHT_IN = 7.0, 3.2
CELLS = 120  # of a map, along its longer side
NEAR = 0.7  # of the spacing of nodes: nothing is drawn farther from where the robot was
COMPONENTS = {
    "left": "left tread",
    "right": "right tread",
    "world_x": "velocity along x",
    "world_y": "velocity along y",
}


def place_picture(
    result: GapResult, effect: NamedEffect, residual: ResidualOfPlace, file: Path
) -> Picture:
    """Maps of what is added to the motion, where the measured runs were."""
    positions_m = np.concatenate([scene.poses[:, :2] for scene in result.measured_scenes])
    edges_m = _edges(positions_m)
    values = map_of(residual, effect.added.values, positions_m, edges_m)
    parameters = zip(residual.terms, residual.parameters, strict=True)
    units = {component: parameter.unit or "share" for (component, _), parameter in parameters}

    def draw(figure: Figure) -> None:
        panels = figure.subplots(1, len(values), squeeze=False)[0]
        for axes, (component, of) in zip(panels, values.items(), strict=True):
            mesh = _draw_map(axes, edges_m, of)
            for scene in result.measured_scenes:
                axes.plot(*scene.poses[:, :2].T, color="#555555", linewidth=0.5)
            figure.colorbar(mesh, ax=axes)
            name = COMPONENTS.get(component, component)
            axes.set_title(f"{name} [{units[component]}]", loc="left")
        panels[0].set_ylabel("y [m]")
        figure.subplots_adjust(left=0.1, right=0.95, bottom=0.16, top=0.9, wspace=0.35)

    return Picture(
        save_figure(file, (WIDTH_IN, HEIGHT_IN), draw),
        "Map of what is added to the motion, where the robot was.",
        "What the motion has beside the model, by place; grey: the measured paths. Nodes are "
        f"{residual.spacing_m:.2g} m apart: nothing smaller is resolved.",
    )


def map_of(
    residual: ResidualOfPlace,
    coefficients: FloatArray,
    positions_m: FloatArray,
    edges_m: tuple[FloatArray, FloatArray],
) -> dict[str, FloatArray]:
    """Each component (J, I) of what is added, in cells between edges along x (I + 1) and y (J + 1).

    NaN where no position (N, 2) is near.
    """
    x, y = ((edges[1:] + edges[:-1]) / 2 for edges in edges_m)
    cells = np.stack(np.meshgrid(x, y), axis=-1)
    apart_m, _ = cKDTree(positions_m).query(cells)
    hats = residual.hats(cells.reshape(-1, 2))
    found: dict[str, FloatArray] = {}
    for (component, node), coefficient in zip(residual.terms, coefficients, strict=True):
        added = (hats[:, node] * coefficient).reshape(apart_m.shape)
        found[component] = found.get(component, 0.0) + added
    far = apart_m > NEAR * residual.spacing_m
    return {component: np.where(far, np.nan, of) for component, of in found.items()}


def _edges(positions_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Edges of square cells, along x and along y, over all positions (N, 2)."""
    low, size = positions_m.min(axis=0), np.ptp(positions_m, axis=0)
    cell_m = float(size.max()) / CELLS
    x, y = (
        at + cell_m * np.arange(-1, int(of / cell_m) + 3) for at, of in zip(low, size, strict=True)
    )
    return x, y


def _draw_map(axes: Axes, edges_m: tuple[FloatArray, FloatArray], values: FloatArray) -> QuadMesh:
    most = max(float(np.nanmax(np.abs(values))), 1e-9)
    shown = np.ma.masked_invalid(values)
    mesh = axes.pcolormesh(*edges_m, shown, vmin=-most, vmax=most, cmap="PuOr", rasterized=True)
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("x [m]")
    return mesh
