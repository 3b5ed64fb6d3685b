"""Labels against the terrain that images.csv and truth.csv name."""

from types import SimpleNamespace

import numpy as np
import pytest

from terrain.main_job import run_odometry
from terrain.report.page import label_table
from terrain.result.label_confusion import LabelConfusion, label_confusion_table, label_confusions
from tests.odometry.modes.mode_drives import run_of_tables

LABELS = ["ice", "mud", "", "unknown", "ice", "ice"]


def seen(labels, ahead_m=0.0):
    region = SimpleNamespace(distance_ahead_m=ahead_m) if ahead_m else None
    return [
        SimpleNamespace(stamp_s=float(k), label=label, region=region)
        for k, label in enumerate(labels)
    ]


def result_of(labels, ahead_m=0.0, **tables):
    """A drive of 1 m/s for ten seconds with an image each second."""
    t = np.arange(11.0)
    run = run_of_tables({"t": t, "v_left": np.ones(11), "v_right": np.ones(11)}, **tables)
    return SimpleNamespace(run=run, watcher=SimpleNamespace(image_labels=seen(labels, ahead_m)))


def of_images(*names):
    t = np.arange(float(len(names)))
    return {"t": t, "terrain": np.array(names, dtype=object)}


def test_pairs_of_name_and_label_are_counted():
    images = of_images("ice", "ice", "ice", "mud", "mud", "")
    (found,) = label_confusions(result_of(LABELS, images=images)).values()
    assert found.true == ("ice", "mud")
    assert found.labels == ("ice", "mud", "unknown", "no label")
    np.testing.assert_array_equal(found.counts, [[1, 1, 0, 1], [1, 0, 1, 0]])
    assert found.right_share == pytest.approx(1 / 3)  # ice as ice, of ice, mud and ice


def test_a_label_that_never_is_true_is_wrong():
    found = LabelConfusion(("ice",), ("ice", "tar"), np.array([[3, 1]]))
    assert found.right_share == 0.75
    assert LabelConfusion(("ice",), ("no label",), np.array([[3]])).right_share is None


def test_the_truth_counts_where_the_robot_is_when_it_gets_there():
    """Mud from 5 s on, in images 2 m before: that of 3 s shows it, that of 2.9 s does not."""
    truth = {"t": np.arange(11.0), "terrain": np.repeat(["ice", "mud"], [5, 6]).astype(object)}
    labels = ["ice"] * 3 + ["mud"] * 8
    found = label_confusions(result_of(labels, 2.0, truth=truth))["truth.csv"]
    assert found.labels == ("ice", "mud")
    np.testing.assert_array_equal(found.counts, [[3, 0], [0, 6]])  # the last two are never reached
    here = label_confusions(result_of(labels, 0.0, truth=truth))["truth.csv"]
    np.testing.assert_array_equal(here.counts, [[3, 2], [0, 6]])


def test_nothing_is_named_without_vision_or_names():
    assert label_confusions(SimpleNamespace(watcher=None)) == {}
    assert label_confusions(result_of(LABELS)) == {}
    assert label_table(result_of(LABELS)) is None
    assert label_confusions(result_of(LABELS, images=of_images(*["unknown"] * 6))) == {}


def test_the_tables_of_json_and_page_hold_the_same_numbers():
    result = result_of(LABELS, images=of_images("ice", "ice", "ice", "mud", "mud", ""))
    table = label_confusion_table(result)["images.csv"]
    assert table["counts"]["mud"] == {"ice": 1, "mud": 0, "unknown": 1, "no label": 0}
    grid = label_table(result)
    assert grid.header == ("true terrain", "ice", "mud", "unknown", "no label")
    assert grid.rows[1] == ("mud", "1", "0", "1", "0")
    assert "33 % of the labels that are names are right" in grid.caption


def test_a_run_that_names_its_images_is_judged(tmp_path, world, classifier):
    """The robot drives along x; what an image is named here is what its region lies on."""
    folder = world.drive_straight(tmp_path / "run", world.across, 2.4)
    first = run_odometry(folder, model=classifier, terrain="gravel")
    header, *rows = (folder / "images.csv").read_text().split()
    names = []
    for image_label in first.watcher.image_labels:
        x = world.speed_m_s * image_label.stamp_s + image_label.region.place[0]
        names.append("boards" if world.edges_m[0] < x < world.edges_m[1] else "gravel")
    lines = [f"{row},{name}" for row, name in zip(rows, names, strict=True)]
    (folder / "images.csv").write_text("\n".join([f"{header},terrain", *lines]) + "\n")
    (found,) = label_confusions(run_odometry(folder, model=classifier)).values()
    assert found.counts.sum() == len(rows)
    assert found.right_share > 0.85
