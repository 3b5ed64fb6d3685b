"""The verbs `train` and `classify`, from photographs to answers."""

import json

import cv2
import numpy as np
import pytest
from click.testing import CliRunner

from terrain.classification.classifier import TerrainClassifier
from terrain.cli.classify import classify
from terrain.cli.train import train
from terrain.images import read_image


@pytest.fixture(scope="module")
def photos(tmp_path_factory, training_patches):
    """root/<class>/<photo>.png of 64 px, grouped in pairs by a manifest."""
    root = tmp_path_factory.mktemp("photos")
    rows = ["path,photo_id"]
    images, labels, _ = training_patches
    for i in range(0, len(images), 4):
        path = root / labels[i] / f"{i:03d}.png"
        path.parent.mkdir(exist_ok=True)
        parts = images[i : i + 4]
        assert cv2.imwrite(str(path), np.block([parts[:2], parts[2:]]))
        rows.append(f"{path.relative_to(root)},{i // 8}")
    (root / "manifest.csv").write_text("\n".join(rows))
    cv2.imwrite(str(root / "gravel/small.png"), np.zeros((20, 90), np.uint8))
    return root


@pytest.fixture(scope="module")
def trained(photos, tmp_path_factory):
    model = tmp_path_factory.mktemp("models") / "ground.model"
    options = ["--patch-size", "32", "--metres-per-pixel", "0.006"]
    answer = CliRunner().invoke(train, [str(photos), "--out", str(model), *options])
    assert answer.exit_code == 0, answer.output
    return model, answer


def test_train_prints_confusion_k_and_threshold_and_what_comes_next(trained, photos):
    model, answer = trained
    loaded = TerrainClassifier.load(model)
    lines = answer.stdout.splitlines()
    assert lines[0].startswith("216 patches of 32 px from 24 photographs, cross-validated")
    header = next(i for i, line in enumerate(lines) if line.split()[-1:] == ["patches"])
    assert lines[header].split() == ["boards", "gravel", "patches"]
    assert lines[header + 1].split()[0] == "boards"
    assert lines[header + 1].split()[-1] == "108"
    assert f"chosen k {loaded.n_neighbors_}," in answer.stdout
    assert f"rejection threshold {loaded.rejection_distance_:.4g}" in answer.stdout
    assert f"Wrote {model}. Next: terrain-odometry classify {model}" in lines[-1]
    assert "left out, smaller than 32 x 32 pixels" in answer.stderr
    assert str(photos / "gravel/small.png") in answer.stderr
    assert (loaded.patch_size_px, loaded.metres_per_pixel) == (32, 0.006)


def test_classify_prints_what_the_classifier_says(trained, photos):
    model, _ = trained
    paths = [photos / "boards/000.png", photos / "gravel/060.png"]
    expected = TerrainClassifier.load(model).classify([read_image(path) for path in paths])
    answer = CliRunner().invoke(classify, [str(model), *map(str, paths), "--json"])
    assert answer.exit_code == 0
    rows = json.loads(answer.stdout)
    for row, path, said in zip(rows, paths, expected, strict=True):
        assert row["image"] == str(path)
        assert row["label"] == said.label
        assert row["confidence"] == pytest.approx(said.confidence)
        assert row["distance"] == pytest.approx(said.distance)
        assert row["probabilities"] == pytest.approx(said.probabilities)
    table = CliRunner().invoke(classify, [str(model), *map(str, paths)]).stdout.splitlines()
    assert table[1].split()[:2] == [str(paths[0]), expected[0].label]
    assert float(table[2].split()[3]) == pytest.approx(expected[1].distance, rel=1e-3)
    assert table[-1].endswith(" the label is unknown.")


def test_bad_images_become_rows_and_the_exit_code_tells(trained, photos, tmp_path):
    model, _ = trained
    (tmp_path / "broken.jpg").write_bytes(b"not an image")
    images = [tmp_path / "broken.jpg", tmp_path / "absent.jpg", photos / "gravel/small.png"]
    arguments = [str(model), *map(str, images), str(photos / "gravel/060.png")]
    answer = CliRunner().invoke(classify, [*arguments, "--json"])
    assert answer.exit_code == 1
    rows = json.loads(answer.stdout)
    assert [sorted(row) for row in rows[:3]] == [["error", "image"]] * 3
    assert "smaller than" in rows[2]["error"]
    assert rows[3]["label"] in {"gravel", "unknown"}
    table = CliRunner().invoke(classify, arguments)
    assert table.exit_code == 1
    assert table.stdout.count("error: ") == 3
