"""The map of terrain: cells by hand, and polygons of the earth measured by another formula."""

import json

import numpy as np
import pytest

from odometry.errors import ExportError
from odometry.export import terrain_map
from odometry.export.source import read_export_source
from odometry.export.terrain_map import terrain_cells
from odometry.io.csv_table import read_csv_table
from tests.odometry.export.result_folder import circle, write_results

ORIGIN = [48.137, 11.575, 519.0]
EARTH_M = {"equatorial": 6378137.0, "squared_eccentricity": 6.69437999014e-3}  # WGS 84


@pytest.fixture
def folder(tmp_path):
    return write_results(tmp_path / "results")


def metres_per_radian(latitude):
    """Along the meridian and the parallel of the ellipsoid, by its radii of curvature."""
    share = 1 - EARTH_M["squared_eccentricity"] * np.sin(latitude) ** 2
    prime = EARTH_M["equatorial"] / np.sqrt(share)
    along = EARTH_M["equatorial"] * (1 - EARTH_M["squared_eccentricity"]) / share**1.5
    return along, prime * np.cos(latitude)


def test_cells_that_were_driven_and_seen(folder):
    cells = terrain_cells(read_export_source(folder, cell_m=0.5))
    driven = {(cell.x_m, cell.y_m): cell for cell in cells if cell.kind == "driven"}
    start, end = driven[0.25, 0.25], circle()[-1, :2]
    assert (start.terrain, start.share) == ("gravel", 1.0)
    last = driven[tuple((np.floor(end / 0.5) + 0.5) * 0.5)]
    assert last.terrain == "grass"
    assert sum(cell.observations for cell in driven.values()) == 3 * 101
    treads = circle()[0, :2] + [[0, 0.3], [0, -0.3]]  # track width 0.6
    assert all(tuple((np.floor(place / 0.5) + 0.5) * 0.5) in driven for place in treads)
    assert {cell.terrain for cell in cells} == {"gravel", "grass"}
    seen = [cell for cell in cells if cell.kind == "seen"]
    places = []
    for row in (20, 60):  # at 2 and 6 s, of a place 2 m ahead and 0.5 m to the left
        yaw = circle()[row, 2]
        ahead = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]) @ [2.0, 0.5]
        places.append((np.floor((circle()[row, :2] + ahead) / 0.5) + 0.5) * 0.5)
    expected = sorted(tuple(place) for place in places)
    assert [(cell.x_m, cell.y_m) for cell in seen] == expected
    assert {(cell.terrain, cell.observations) for cell in seen} == {("grass", 1)}


def test_most_observations_name_a_cell(folder):
    """51 stamps of grass have three places each in a large cell; gravel has fewer there."""
    (cell,) = [
        cell
        for cell in terrain_cells(read_export_source(folder, cell_m=100.0))
        if (cell.kind, cell.x_m, cell.y_m) == ("driven", 50.0, 50.0)
    ]
    assert cell.terrain == "grass"
    assert 3 * 51 < cell.observations < 3 * 101  # the right tread begins in the cell below
    assert cell.share == 3 * 51 / cell.observations


def test_without_an_origin_it_is_a_table(folder, tmp_path):
    source = read_export_source(folder)
    terrain_map.write(source, tmp_path / "out")
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["terrain_cells.csv"]
    lines = (tmp_path / "out" / "terrain_cells.csv").read_text().splitlines()
    assert lines[0] == "x_m,y_m,kind,terrain,observations,share"
    assert len(lines) == 1 + len(terrain_cells(source))


def test_with_an_origin_polygons_lie_where_the_cells_do(tmp_path):
    pytest.importorskip("pymap3d")
    source = read_export_source(write_results(tmp_path / "results", ORIGIN))
    terrain_map.write(source, tmp_path)
    content = json.loads((tmp_path / "terrain.geojson").read_text())
    assert content["type"] == "FeatureCollection"
    north_m, east_m = metres_per_radian(np.radians(ORIGIN[0]))
    cells = terrain_cells(source)
    assert len(content["features"]) == len(cells)
    for feature, cell in zip(content["features"], cells, strict=True):
        (ring,) = feature["geometry"]["coordinates"]
        assert feature["geometry"]["type"] == "Polygon"
        assert ring[0] == ring[-1]
        longitude, latitude = np.radians(np.array(ring) - [ORIGIN[1], ORIGIN[0]]).T
        metres = np.column_stack([longitude * east_m, latitude * north_m])
        # the origin is 519 m above the ellipsoid: a metre there is 1.00008 below
        middle = metres[:4].mean(axis=0)
        np.testing.assert_allclose(middle, [cell.x_m, cell.y_m], rtol=2e-4, atol=1e-3)
        x, y = metres[:4].T
        area = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2  # positive: counter-clockwise
        assert area == pytest.approx(0.25, rel=1e-3)
        assert feature["properties"] == {
            "terrain": cell.terrain,
            "kind": cell.kind,
            "observations": cell.observations,
            "share": cell.share,
        }


def test_a_run_without_named_terrain_has_no_map(folder):
    (folder / "terrain.csv").unlink()
    with pytest.raises(ExportError, match="had no source of terrain"):
        terrain_cells(read_export_source(folder))


def test_a_result_that_does_not_say_where_is_refused(folder):
    table = read_csv_table(folder / "terrain.csv", ["t"])
    rows = [f"{t},{label}" for t, label in zip(table["t"], table["label"], strict=True)]
    (folder / "terrain.csv").write_text("\n".join(["t,label", *rows]) + "\n")
    with pytest.raises(ExportError, match="`run` again"):
        terrain_cells(read_export_source(folder))


def test_positions_of_a_national_grid_are_not_placed_on_earth(tmp_path):
    """They would lie near the pole, 5300 km north of the origin."""
    pytest.importorskip("pymap3d")
    folder = write_results(tmp_path / "results", ORIGIN)
    file = folder / "estimate.csv"
    header, *rows = (line.split(",") for line in file.read_text().splitlines())
    north = header.index("y")
    moved = [[*row[:north], repr(float(row[north]) + 5.3e6), *row[north + 1 :]] for row in rows]
    file.write_text("\n".join(map(",".join, [header, *moved])) + "\n")
    source = read_export_source(folder)
    with pytest.raises(ExportError, match=r"5300 km from the origin.*are of a map"):
        terrain_map.write(source, tmp_path)
    assert not (tmp_path / "terrain.geojson").exists()
