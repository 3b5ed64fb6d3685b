"""Sources of terrain: the camera, the run's own labels, the motion, nothing, or one's own."""

import csv
import json
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest

from odometry.errors import ConfigError, RunFolderError
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import UNKNOWN
from odometry.replays.pipeline import ConstantTerrain
from terrain.cli.verbs import run as run_verb
from terrain.main_job import run_odometry
from terrain.report.page import write_report
from terrain.results import write_results
from terrain.sources.sources import SOURCES, source_name
from tests.odometry.modes.mode_drives import velocity_run
from tests.odometry.modes.models.test_terrain_source import NAMES, SET, A, B


@pytest.fixture(scope="module")
def labelled_run(tmp_path_factory, world):
    """Along x over both edges; odometry.csv names the terrain under the middle of the robot."""
    folder = world.drive_straight(tmp_path_factory.mktemp("labelled") / "run", world.across, 4.0)
    header, *rows = (folder / "odometry.csv").read_text().split()
    x = world.speed_m_s * np.array([float(row.split(",")[0]) for row in rows])
    names = np.where((x > world.edges_m[0]) & (x < world.edges_m[1]), "boards", "gravel")
    lines = [f"{row},{name}" for row, name in zip(rows, names, strict=True)]
    (folder / "odometry.csv").write_text("\n".join([f"{header},terrain", *lines]) + "\n")
    return folder


def switches(result):
    """Stamp and terrain of each switch."""
    pairs = pairwise(result.replay.estimates)
    return [(now.stamp_s, now.terrain) for old, now in pairs if now.terrain != old.terrain]


def test_true_labels_switch_at_the_edge(labelled_run, world):
    result = run_odometry(labelled_run, source="labels")
    edges_s = np.array(world.edges_m) / world.speed_m_s
    (first_s, boards), (second_s, gravel) = switches(result)
    assert (result.initial_terrain, boards, gravel) == ("gravel", "boards", "gravel")
    assert edges_s[0] <= first_s <= edges_s[0] + 0.1 + 1e-9  # the next row of odometry
    assert edges_s[1] <= second_s <= edges_s[1] + 0.1 + 1e-9
    assert result.watcher is None


def test_what_labels_put_in_force_is_written(labelled_run, tmp_path):
    result = run_odometry(labelled_run, source="labels")
    write_results(result, tmp_path)
    with (tmp_path / "terrain.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["terrain_in_force"] for row in rows] == ["gravel", "boards", "gravel"]
    assert [row["label"] for row in rows] == ["gravel", "boards", "gravel"]
    stamps_s = [float(row["t"]) for row in rows]
    assert stamps_s == [0.0, *(stamp_s for stamp_s, _ in switches(result))]
    content = json.loads((tmp_path / "result.json").read_text())
    assert content["terrain_source"] == "labels"
    told = [(switch["stamp_s"], switch["terrain"]) for switch in content["switches"]]
    assert told == switches(result)
    assert [switch["seen_s"] for switch in content["switches"]] == [None, None]


def test_the_page_names_the_source_of_the_terrain(labelled_run, tmp_path):
    write_report(run_odometry(labelled_run, source="labels"), tmp_path)
    page = (tmp_path / "report.html").read_text()
    assert "The source of the terrain was the run&#x27;s own labels" in page
    assert "in force throughout" not in page
    assert "boards</th>" in page


def test_without_a_source_no_terrain_is_written(labelled_run, tmp_path):
    result = run_odometry(labelled_run)
    write_results(result, tmp_path)
    assert not (tmp_path / "terrain.csv").exists()
    content = json.loads((tmp_path / "result.json").read_text())
    assert (content["terrain_source"], content["switches"]) == ("none", [])


def test_labels_leave_the_images_closed(labelled_run):
    result = run_odometry(labelled_run, model="no such model", source="labels")
    assert len(switches(result)) == 2


def test_a_run_without_labels_cannot_be_their_source(across_run):
    with pytest.raises(RunFolderError, match="names a terrain"):
        run_odometry(across_run, source="labels")


def test_by_the_motion_the_terrain_follows_the_change():
    labels = np.repeat(NAMES, 750).tolist()
    by_name = dict(zip(NAMES, A, strict=True)), dict(zip(NAMES, B, strict=True))
    run = velocity_run(np.random.default_rng(3), *by_name, labels)
    columns = {**run.velocity.columns, "vy": np.full(len(labels), np.nan)}
    run = replace(run, velocity=replace(run.velocity, columns=columns))
    result = run_odometry(run, source="modes", modes=SET, terrain="sand")
    assert result.initial_terrain == "sand"
    (first_s, ice), (second_s, tar) = switches(result)
    assert (ice, tar) == NAMES
    assert first_s < 10.0
    assert 15.0 < second_s < 20.0


def test_by_the_motion_a_start_that_nobody_named_is_unknown():
    """The first table of the set is the wrong one; its widths are far apart and stated sharply."""
    labels = ["ice"] * 750
    by_name = dict(zip(NAMES, A, strict=True)), dict(zip(NAMES, B, strict=True))
    run = velocity_run(np.random.default_rng(4), *by_name, labels)
    columns = {**run.velocity.columns, "vy": np.full(len(labels), np.nan)}
    run = replace(run, velocity=replace(run.velocity, columns=columns))
    parameters = ParameterSet({name: table_of(turn) for name, turn in (("tar", 1.2), ("ice", 0.8))})
    result = run_odometry(run, source="modes", modes=SET, parameters=parameters)
    assert result.initial_terrain == UNKNOWN
    assert switches(result)[0][1] == "ice"
    named = run_odometry(run, source="modes", modes=SET, parameters=parameters, terrain="tar")
    assert named.initial_terrain == "tar"
    of_run = replace(run, settings={**run.settings, "run": {"terrain": "ice"}})
    stated = run_odometry(of_run, source="modes", modes=SET, parameters=parameters)
    assert stated.initial_terrain == "ice"


def table_of(turn):
    """ICRs of a robot that turns by so much per difference of treads."""
    values = {"y_left": 0.5 / turn, "y_right": -0.5 / turn, "x_icr": 0.0}
    return TerrainParameters("icr", values, tuple(values), 1e-4 * np.eye(3))


def test_none_keeps_one_terrain(labelled_run, model_file):
    result = run_odometry(labelled_run, model=model_file, source="none")
    assert switches(result) == []
    assert result.watcher is None


def test_the_camera_is_the_source_where_there_is_a_model(across_result, across_run, classifier):
    result = run_odometry(across_run, model=classifier, terrain="gravel", source="camera")
    assert switches(result) == switches(across_result)


@dataclass
class AfterTwoSeconds:
    """A source of one's own."""

    initial: str = "gravel"

    def terrain(self, frame, estimate):  # noqa: ARG002 - the protocol's
        return "mud" if estimate.stamp_s >= 2.0 else self.initial


def test_a_source_may_be_ones_own(labelled_run):
    ((stamp_s, mud),) = switches(run_odometry(labelled_run, source=AfterTwoSeconds()))
    assert mud == "mud"
    assert stamp_s == pytest.approx(2.1)
    kept = run_odometry(labelled_run, source=ConstantTerrain("ice"))
    assert (kept.initial_terrain, switches(kept)) == ("ice", [])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"source": "camera"}, "'camera' needs a model"),
        ({"source": "modes"}, "'modes' needs a set of modes"),
        ({"source": "radar"}, "'radar' is not one of camera, labels, modes, feel, none"),
        ({"source": "camera", "vision": False}, "needs vision, which was turned off"),
    ],
)
def test_a_source_that_lacks_what_it_needs_is_an_error(labelled_run, given, words):
    with pytest.raises(ConfigError, match=words):
        run_odometry(labelled_run, **given)


def test_the_default_source():
    assert source_name(None, vision=True, has_model=True) == "camera"
    assert source_name(None, vision=True, has_model=False) == "none"
    assert source_name(None, vision=False, has_model=True) == "none"


def test_the_command_offers_every_source():
    assert run_verb.SOURCES == SOURCES
