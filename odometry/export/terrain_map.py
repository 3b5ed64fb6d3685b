"""The cells of terrain as GeoJSON (RFC 7946) where the origin is known, else as CSV."""

import json
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from odometry.export.ros_file import write_text
from odometry.export.source import ExportSource
from odometry.export.terrain_cells import Cell, terrain_cells
from odometry.extras import extra_module
from odometry.io.csv_table import write_csv_table

DECIMALS = 9  # of a degree: 0.1 mm
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]) / 2  # counter-clockwise, closed


def write(source: ExportSource, folder: Path) -> None:
    """Write terrain.geojson, or terrain_cells.csv where run.toml says no origin.

    Raises
    ------
    ExtraError
        If the origin is known and pymap3d is not installed.
    ExportError
        As `terrain_cells`.
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
