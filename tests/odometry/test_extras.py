"""Optional packages that are there, and one that is not."""

import sys
from pathlib import Path

import numpy as np
import pytest

from odometry.errors import ExtraError
from odometry.installed import extra_module
from odometry.io.csv_table import read_csv_table, write_csv_table
from odometry.tables.table import Table


def test_a_missing_package_is_named_with_its_extra():
    with pytest.raises(ExtraError, match=r"Maps needs .* nowhere.*terrain-odometry\[maps\]"):
        extra_module("nowhere.at_all", "maps", "Maps")


def test_without_pandas_a_table_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    table = Table(Path("a.csv"), {"t": np.arange(2.0)}, np.array([2, 3]))
    with pytest.raises(ExtraError, match=r"pandas.*terrain-odometry\[tables\]"):
        table.to_pandas()


def test_a_table_as_pandas_is_what_pandas_reads(tmp_path):
    """pandas' own reader of the same file is the oracle: empty cells are missing to both."""
    pandas = pytest.importorskip("pandas")
    file = tmp_path / "a.csv"
    columns = {
        "t": np.array([1.0, 1.5, 2.25]),
        "x": np.array([0.5, np.nan, -3.0]),
        "label": np.array(["grass", "", "unknown"]),
    }
    write_csv_table(file, columns)
    ours, theirs = read_csv_table(file, ["t"]).to_pandas(), pandas.read_csv(file)
    pandas.testing.assert_frame_equal(ours.isna(), theirs.isna())
    named, named_too = (table.fillna({"label": "missing"}) for table in (ours, theirs))
    pandas.testing.assert_frame_equal(named, named_too, check_dtype=False)
    assert ours["label"].isna().tolist() == [False, True, False]
    assert ours.dtypes["x"] == np.float64
