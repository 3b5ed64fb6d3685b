"""terrain.csv: what was recognised where, and the numbers from which labels follow."""

import re
from pathlib import Path

import numpy as np
import pytest

from odometry.recording.run import Run
from terrain.classification.classifier import TerrainClassifier
from terrain.config import Config
from terrain.main_job import run_odometry
from terrain.region.region import RegionConfig
from terrain.results import write_results
from tests.terrain.output_tables import TERRAIN, columns, strict


@pytest.mark.slow
def test_the_terrain_table_says_what_was_seen_and_where(across_out, across_run, world):
    _, table = columns(across_out / "terrain.csv")
    images = (across_run / "images.csv").read_text().split()[1:]
    stamps_s = [float(line.split(",")[0]) for line in images]
    np.testing.assert_allclose(np.array(table["t"], float), stamps_s, atol=1e-9)
    assert set(table["label"]) <= {"gravel", "boards", "unknown"}
    confidence = np.array(table["confidence"], float)
    assert ((confidence >= 0) & (confidence <= 1)).all()
    ahead = np.array(table["distance_ahead"], float)
    assert np.ptp(ahead) < 0.05  # the same motion again and again
    assert 0.4 < ahead[0] < 0.8
    on_boards = [name == "boards" for name in table["terrain_in_force"]]
    x = world.speed_m_s * np.array(stamps_s)
    half = world.robot["length"] / 2 + 0.12
    inside = (x > world.edges_m[0] + half) & (x < world.edges_m[1] - half)
    outside = (x < world.edges_m[0] - half) | (x > world.edges_m[1] + half)
    assert np.array(on_boards)[inside].all()
    assert not np.array(on_boards)[outside].any()


def test_labels_follow_from_the_numbers_in_the_terrain_table(across_out, classifier):
    """So that another threshold can be tried on a finished run."""
    _, table = columns(across_out / "terrain.csv")
    given = np.column_stack([table["probability_boards"], table["probability_gravel"]])
    given, distance = given.astype(float), np.array(table["class_distance"], float)
    names = np.array(["boards", "gravel"])[given.argmax(axis=1)]
    beyond = distance > classifier.rejection_distance_
    tied = np.isclose(*given.T, atol=1e-8)  # the table's digits do not show which one is first
    asked = (np.array(table["label"]) != "") & (beyond | ~tied)
    expected = np.where(beyond, "unknown", names)[asked]
    assert expected.tolist() == np.array(table["label"])[asked].tolist()
    np.testing.assert_allclose(
        given[asked].max(axis=1), np.array(table["confidence"], float)[asked]
    )


def test_the_threshold_of_the_readme(across_result, classifier, tmp_path, monkeypatch, capsys):
    """What terrain/README.md shows does run, and the share that it prints lies beyond."""
    text = (Path(__file__).parents[3] / "terrain/README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    (code,) = [block for block in blocks if "rejection_distance_" in block]
    write_results(across_result, tmp_path / "results")
    classifier.save(tmp_path / "terrain.model")
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "terrain/README.md", "exec"), {})  # noqa: S102
    _, table = columns(tmp_path / "results/terrain.csv")
    given = np.array([value for value in table["class_distance"] if value], float)
    for line in capsys.readouterr().out.splitlines():
        share, _, distance = line.split()
        assert (given > float(distance)).mean() == pytest.approx(float(share), abs=0.06)
    lenient = TerrainClassifier.load(tmp_path / "lenient.model")
    assert lenient.rejection_distance_ == 1.2 * classifier.rejection_distance_


def test_an_image_without_a_label_is_an_empty_cell_with_a_reason(tmp_path, world, classifier):
    run = world.drive_straight(tmp_path / "run", world.across, 0.5)
    (run / "images" / "001.png").write_bytes(b"")
    write_results(run_odometry(Run.read(run), model=classifier), tmp_path / "out")
    _, table = columns(tmp_path / "out" / "terrain.csv")
    assert table["label"][1] == table["confidence"][1] == ""
    assert table["reason"][1] == "the image cannot be read"
    assert table["image"][1] == "images/001.png"
    assert table["label"][0] == table["label"][2] == "gravel"
    content = strict((tmp_path / "out" / "result.json").read_text())
    assert content["sightings"]["no label: the image cannot be read"] == 1


def test_the_tread_strips_have_columns_of_their_own(astride_run, classifier, tmp_path):
    config = Config(region=RegionConfig(per_tread=True))
    write_results(run_odometry(astride_run, model=classifier, config=config), tmp_path)
    header, table = columns(tmp_path / "terrain.csv")
    assert header[:5] == TERRAIN
    assert "gravel" in table["left"]
    assert "boards" in table["right"]
