"""What holds between two moments, by spans and by the files of a run."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import RunFolderError
from odometry.recording.run import Run
from odometry.tables.table import Table
from terrain.labelling.given_terrain import TerrainSpan, given_by_spans, given_terrain


@pytest.fixture
def run(curvy_run):
    return Run.read(curvy_run)


def table(**columns):
    lines = np.arange(len(columns["t"])) + 2
    return Table("a.csv", {name: np.array(of) for name, of in columns.items()}, lines)


def test_spans_count_from_a_stamp_and_determine_nothing_between_them(run):
    spans = [TerrainSpan(7, 9, "sand"), TerrainSpan(1, 4, "grass"), TerrainSpan(4, 5, "ice")]
    given = given_by_spans(run, spans, 100.0)
    assert given.terrains == ("grass", "ice", "sand")
    for begin_s, end_s, names in (
        (100.0, 100.9, {""}),
        (100.5, 101.0, {"", "grass"}),
        (101.0, 103.9, {"grass"}),
        (103.0, 104.0, {"grass", "ice"}),
        (104.5, 106.0, {"ice", ""}),
        (107.0, 108.9, {"sand"}),
        (109.0, 200.0, {""}),
        (0.0, 200.0, {"", "grass", "ice", "sand"}),
    ):
        assert given.between(begin_s, end_s) == names, (begin_s, end_s)


def test_spans_that_overlap_are_refused(run):
    spans = [TerrainSpan(0, 5, "sand"), TerrainSpan(4.5, 6, "ice")]
    with pytest.raises(RunFolderError, match=r"'ice' from 4\.5 s begins before .* at 5 s"):
        given_by_spans(run, spans, 0.0)


@pytest.mark.parametrize("times", [(-1, 2), (3, 3), (3, 2), (0, np.inf), (np.nan, 2)])
def test_spans_run_ahead(times):
    with pytest.raises(RunFolderError, match="an end after it"):
        TerrainSpan(*times, "ice")


def test_a_stamp_before_the_first_name_has_no_terrain(run):
    truth = table(t=[2.0, 3.0], terrain=["ice", "unknown"])
    given = given_terrain(replace(run, truth=truth))
    assert given.between(1.0, 2.5) == {"", "ice"}
    assert given.between(2.0, 2.9) == {"ice"}
    assert given.between(3.0, 9.0) == {""}


def test_the_first_file_that_names_a_terrain_tells_it(run):
    images = table(t=[0.0], file=["a.png"], terrain=["moss"])
    settings = {**run.settings, "run": {"terrain": "lawn"}}
    run = replace(run, settings=settings)
    assert given_terrain(run).source == "run.toml"
    assert given_terrain(run).between(0.0, 9.0) == {"lawn"}
    run = replace(run, images=images)
    assert (given_terrain(run).source, given_terrain(run).of_images) == ("images.csv", True)
    odometry = replace(run.odometry, columns={**run.odometry.columns})
    odometry.columns["terrain"] = np.array(["", *["mud"] * (len(odometry) - 1)], dtype=object)
    run = replace(run, odometry=odometry)
    given = given_terrain(run)
    assert (given.source, given.terrains) == ("odometry.csv", ("lawn", "mud"))
    run = replace(run, truth=table(t=[0.0], terrain=["ice"]))
    assert given_terrain(run).source == "truth.csv"
    assert given_terrain(run, "run.toml").terrains == ("lawn",)


@pytest.mark.parametrize("source", [None, "truth.csv", "odometry.csv", "images.csv", "run.toml"])
def test_a_run_that_names_none_is_refused(run, source):
    with pytest.raises(RunFolderError, match=source or "any file"):
        given_terrain(run, source)


@pytest.mark.parametrize("name", ["../away", "a/b", "a\\b", ".hidden", ".."])
def test_a_name_that_cannot_be_a_folder_is_refused(run, name):
    with pytest.raises(RunFolderError, match="cannot name a folder"):
        given_by_spans(run, [TerrainSpan(0, 1, name)], 0.0)
