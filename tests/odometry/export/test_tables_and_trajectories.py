"""Parquet tables and trajectory files of a result, read again."""

import json

import numpy as np
import pytest

from odometry.errors import ExportError
from odometry.export import parquet, trajectory_formats
from odometry.export.source import read_export_source
from odometry.io.csv_table import read_csv_table
from odometry.io.trajectory_files import FORMATS, read_trajectory
from tests.odometry.export.result_folder import STAMPS_S, circle, write_results


@pytest.fixture
def source(tmp_path):
    return read_export_source(write_results(tmp_path / "results"))


def test_parquet_holds_the_tables(source, tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    parquet.write(source, tmp_path)
    assert sorted(file.name for file in tmp_path.glob("*.parquet")) == [
        "estimate.parquet",
        "odometer.parquet",
        "terrain.parquet",
    ]
    for name in ("estimate", "odometer", "terrain"):
        again = pandas.read_parquet(tmp_path / f"{name}.parquet")
        table = read_csv_table(source.folder / f"{name}.csv", ["t"])
        assert list(again.columns) == list(table.columns)
        np.testing.assert_array_equal(again["t"], table.stamps_s)
    assert again["label"].tolist()[1:] == ["grass", "grass"]
    assert again["label"].isna().tolist() == [True, False, False]
    assert again["place_x"].dtype == np.float64


@pytest.mark.parametrize("name", FORMATS)
def test_trajectories_read_again(source, tmp_path, name):
    trajectory_formats.write(source, tmp_path / "out", name)
    files = sorted((tmp_path / "out").iterdir())
    for of in ("odometer", "estimate"):
        (file, *times) = [each for each in files if each.name.startswith(of)]
        again = read_trajectory(file, times=times[0] if times else None)
        np.testing.assert_allclose(again.stamps_s, STAMPS_S, atol=1e-9)
        np.testing.assert_allclose(again.plane.poses, circle(), atol=2e-9)


@pytest.mark.parametrize(
    ("content", "words"),
    [(None, "has no result.json"), ("{", "JSON"), ("[1]", "not a result"), ("{}", "not a result")],
)
def test_a_folder_without_a_result_is_refused(tmp_path, content, words):
    (tmp_path / "other").mkdir()
    if content is not None:
        (tmp_path / "other" / "result.json").write_text(content)
    with pytest.raises(ExportError, match=words):
        read_export_source(tmp_path / "other")


def test_a_robot_that_stood_is_exported(tmp_path):
    folder = write_results(tmp_path / "results")
    stood = json.loads((folder / "result.json").read_text()) | {"wheel_travel_m": 0.0, "errors": {}}
    (folder / "result.json").write_text(json.dumps(stood))
    assert len(read_export_source(folder).trajectory("odometer")) == len(STAMPS_S)
