"""Terrain under the treads and in images on a metric grid, as GeoJSON (RFC 7946) or CSV."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import ExportError
from odometry.export.ros_file import write_text
from odometry.export.source import ExportSource
from odometry.fixes.degrees import FARTHEST_M
from odometry.geometry import se2
from odometry.installed import extra_module
from odometry.io.csv_table import write_csv_table
from odometry.trajectory import Trajectory

DRIVEN, SEEN = "driven", "seen"


@dataclass(frozen=True)
class Cell:
    """One square of the grid.

    Attributes
    ----------
    x_m, y_m : float
        Its middle.
    kind : str
        "driven": the terrain in force where a tread passed. "seen": the label of an image whose
        region has its middle there.
    terrain : str
        The most frequent one.
    observations : int
    share : float
        Of the observations, that are of this terrain.
    """

    x_m: float
    y_m: float
    kind: str
    terrain: str
    observations: int
    share: float


def terrain_cells(source: ExportSource) -> list[Cell]:
    """Cells of a result, those driven first, each kind by x and then y.

    Raises
    ------
    ExportError
        If the run has no source of terrain, or the result is of an older version.
    """
    if not (source.folder / "terrain.csv").exists():
        raise ExportError(
            f"{source.path}: this run had no source of terrain, so there is no map of it; `run` "
            "with --model or --source"
        )
    table, estimate = source.table("terrain"), source.trajectory("estimate")
    if "place_x" not in table and source.content.get("vision"):
        raise ExportError(
            f"{table.file}: it does not say where images were classified (an older version wrote "
            "it); `run` again"
        )
    width_m = source.track_width_m or 0.0
    driven = _cells(*_driven(source, estimate, width_m), DRIVEN, source.cell_m)
    if "place_x" not in table:
        return driven
    labels = np.asarray(table["label"], dtype=str)
    places = table.stack("place_x", "place_y")
    located = np.isfinite(places).all(axis=1) & (labels != "") & estimate.covers(table.stamps_s)
    seen = se2.transform(estimate.at(table.stamps_s[located]).poses, places[located])
    return [*driven, *_cells(seen, labels[located], SEEN, source.cell_m)]


def _driven(
    source: ExportSource, estimate: Trajectory, width_m: float
) -> tuple[FloatArray, AnyArray]:
    """Places of both treads and the middle at every estimate, and the terrain in force there."""
    switches = source.content.get("switches", [])
    begins_s = np.array([-np.inf, *(float(switch["stamp_s"]) for switch in switches)])
    names = np.array(
        [
            str(source.content["initial_terrain"]),
            *(str(switch.get("terrain")) for switch in switches),
        ]
    )
    in_force = names[np.searchsorted(begins_s, estimate.stamps_s, side="right") - 1]
    across = np.array([[0.0, -width_m / 2], [0.0, 0.0], [0.0, width_m / 2]])
    places = se2.transform(estimate.poses[:, None], across)
    return places.reshape(-1, 2), np.repeat(in_force, len(across))


def _cells(places: FloatArray, names: AnyArray, kind: str, cell_m: float) -> list[Cell]:
    if not len(places):
        return []
    indices, cell_of = np.unique(np.floor(places / cell_m), axis=0, return_inverse=True)
    terrains, terrain_of = np.unique(names, return_inverse=True)
    counts = np.zeros((len(indices), len(terrains)), dtype=np.int64)
    np.add.at(counts, (cell_of.ravel(), terrain_of.ravel()), 1)
    most = counts.argmax(axis=1)
    found = zip(((indices + 0.5) * cell_m).tolist(), most.tolist(), counts, strict=True)
    return [
        Cell(x, y, kind, str(terrains[k]), int(row.sum()), float(row[k] / row.sum()))
        for (x, y), k, row in found
    ]


DECIMALS = 9  # of a degree: 0.1 mm
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]) / 2  # counter-clockwise, closed


def write(source: ExportSource, folder: Path) -> None:
    """Write terrain.geojson, or terrain_cells.csv where run.toml says no origin.

    Raises
    ------
    ExtraError
        If the origin is known and pymap3d is not installed.
    ExportError
        As `terrain_cells`; if a cell lies more than 100 km from the origin.
    """
    cells = terrain_cells(source)
    if source.origin is None:
        columns = {
            of.name: np.array([getattr(cell, of.name) for cell in cells]) for of in fields(Cell)
        }
        write_csv_table(folder / "terrain_cells.csv", columns)
        return
    collection = {
        "type": "FeatureCollection",
        "features": _features(cells, source.cell_m, source.origin),
    }
    write_text(folder / "terrain.geojson", json.dumps(collection, allow_nan=False) + "\n")


def _features(
    cells: Sequence[Cell], cell_m: float, origin: tuple[float, float, float]
) -> list[dict[str, Any]]:
    """A polygon a cell: x is east, y north of the origin."""
    pymap3d = extra_module("pymap3d", "bags", "GeoJSON")
    middles = np.array([[cell.x_m, cell.y_m] for cell in cells])
    farthest_m = float(np.hypot(*middles.T).max())
    if farthest_m > FARTHEST_M:
        raise ExportError(
            f"the cells lie {farthest_m / 1000:.0f} km from the origin that [source] of run.toml "
            "states: the poses are of a map (UTM, a national grid), or the origin is another one. "
            "Subtract its place from pose.csv, or leave the origin out for terrain_cells.csv"
        )
    east, north = np.moveaxis(middles[:, None] + cell_m * CORNERS, -1, 0)
    latitude, longitude, _ = pymap3d.enu2geodetic(east, north, np.zeros_like(east), *origin)
    rings = np.round(np.stack([longitude, latitude], axis=-1), DECIMALS).tolist()
    return [
        {
            "type": "Feature",
            "geometry": {"type": "Polygon", "coordinates": [ring]},
            "properties": {
                "terrain": cell.terrain,
                "kind": cell.kind,
                "observations": cell.observations,
                "share": cell.share,
            },
        }
        for cell, ring in zip(cells, rings, strict=True)
    ]
