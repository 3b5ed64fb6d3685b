"""The verbs `train` and `classify`, from photographs to answers."""

import json
import re

import cv2
import numpy as np
import pytest
from click.testing import CliRunner
from joblib.externals.loky import get_reusable_executor

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.neighbours.validation import CrossValidation
from terrain.cli.texts.train_text import calibration_words
from terrain.cli.verbs.classify import classify
from terrain.cli.verbs.train import train
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
    answer = trained_by(photos, model, 1)
    assert answer.exit_code == 0, answer.output
    return model, answer


def trained_by(photos, model, processes):
    options = ["--patch-size", "32", "--metres-per-pixel", "0.006", "--processes", str(processes)]
    options += ["--picture", str(model.with_suffix(".png"))]
    return CliRunner().invoke(train, [str(photos), "--out", str(model), *options])


@pytest.mark.slow
def test_two_processes_train_the_same_file(trained, photos, tmp_path):
    assert trained_by(photos, tmp_path / "ground.model", 2).exit_code == 0
    get_reusable_executor().shutdown(wait=True)
    assert (tmp_path / "ground.model").read_bytes() == trained[0].read_bytes()


def test_train_draws_the_reliability(trained):
    model, answer = trained
    picture = model.with_suffix(".png")
    assert cv2.imread(str(picture)).std() > 10
    assert f"Wrote {picture}" in answer.stdout


def test_train_overwrites_no_picture_of_others(photos, tmp_path):
    picture = tmp_path / "mine.png"
    picture.write_bytes(b"a picture of another program")
    call = [str(photos), "--out", str(tmp_path / "ground.model"), "--picture"]
    assert "did not make it" in str(CliRunner().invoke(train, [*call, str(picture)]).exception)
    answer = CliRunner().invoke(train, [*call, str(tmp_path / "mine.jpg")])
    assert "expected a name that ends in .png" in answer.output


@pytest.mark.parametrize(
    ("shares_right", "words"),
    [
        (0.75, "chance explains this"),
        (0.25, "chance does not explain this: they are too high"),
        (1.0, "chance does not explain this: they are too low"),
    ],
)
def test_train_says_whether_chance_explains_the_error(shares_right, words):
    """400 answers of probability 0.75, each of a photograph of its own, some of them right."""
    codes = (np.arange(400) >= 400 * shares_right).astype(int)
    votes = np.tile([0.75, 0.25], (400, 1))
    found = CrossValidation(1, np.arange(400), codes, votes, np.zeros(400))
    assert words in calibration_words(found, np.arange(400))


def test_train_prints_confusion_k_and_threshold_and_what_comes_next(trained, photos):
    model, answer = trained
    loaded = TerrainClassifier.load(model)
    lines = answer.stdout.splitlines()
    assert lines[0].startswith(
        "216 patches of 32 px from 24 photographs in 12 groups, cross-validated by group"
    )
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


def test_train_prints_an_interval_of_so_few_photographs(trained, rng):
    """All right: of two terrains of 6 groups each (not of 12 photographs), by Jeffreys."""
    low = np.quantile(rng.beta(6.5, 0.5, (100_000, 2)).mean(axis=1), 0.025)
    said = re.search(r"patches 1\.000 \(95 % interval (0\.\d{3}) to 1\.000\)", trained[1].stdout)
    assert float(said[1]) == pytest.approx(low, abs=0.015)


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


def test_bad_images_become_rows_and_the_exit_code_says_so(trained, photos, tmp_path):
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


def test_k_and_the_share_that_may_be_refused_are_as_given(photos, trained, tmp_path):
    model, _ = trained
    options = ["--patch-size", "32", "--k", "3", "--reject", "0.3"]
    answer = CliRunner().invoke(train, [str(photos), "--out", str(tmp_path / "a"), *options])
    assert answer.exit_code == 0, answer.output
    strict, usual = TerrainClassifier.load(tmp_path / "a"), TerrainClassifier.load(model)
    assert (strict.n_neighbors_, strict.rejected_share) == (3, 0.3)
    assert usual.rejected_share == 0.05
    assert strict.rejection_distance_ < usual.rejection_distance_
    assert "given k 3, rejection threshold" in answer.stdout
    assert "(30 % of known terrain lies beyond)" in answer.stdout


@pytest.mark.parametrize("options", [["--k", "0"], ["--reject", "0"], ["--reject", "1"]])
def test_numbers_out_of_range_are_a_wrong_command_line(photos, tmp_path, options):
    answer = CliRunner().invoke(train, [str(photos), "--out", str(tmp_path / "a"), *options])
    assert answer.exit_code == 2


def test_more_neighbours_than_patches_are_refused(photos, tmp_path):
    options = ["--patch-size", "32", "--k", "500"]
    answer = CliRunner().invoke(train, [str(photos), "--out", str(tmp_path / "a"), *options])
    assert answer.exit_code == 1
    assert "k = 500" in str(answer.exception)


@pytest.fixture
def fresh(tmp_path, photos):
    """New ground in class folders, one terrain that the model does not know, one old image."""
    rng = np.random.default_rng(5)
    images = {
        "boards": np.tile(np.where(np.arange(64) % 10 < 6, 190, 60), (64, 1)),
        "gravel": np.kron(rng.integers(30, 226, (32, 32)), np.ones((2, 2))),
        "ice": np.full((64, 64), 200),
    }
    for name, image in images.items():
        (tmp_path / "fresh" / name).mkdir(parents=True)
        for k in range(3):
            noisy = np.clip(image + rng.normal(0, 3, image.shape), 0, 255).astype(np.uint8)
            assert cv2.imwrite(str(tmp_path / "fresh" / name / f"{k}.png"), noisy)
    old = tmp_path / "fresh/gravel/old.png"
    old.write_bytes((photos / "gravel/060.png").read_bytes())
    return tmp_path / "fresh"


def test_a_folder_of_labelled_images_gives_their_confusion(trained, fresh):
    model, _ = trained
    answer = CliRunner().invoke(classify, [str(model), str(fresh), "--json"])
    assert answer.exit_code == 0, answer.output
    content = json.loads(answer.stdout)
    assert len(content["images"]) == 10
    counted = {name: sum(row.values()) for name, row in content["confusion"].items()}
    assert counted == {"boards": 3, "gravel": 3, "ice": 3}
    for image in content["images"]:
        assert image["in_training"] == image["image"].endswith("old.png")
    said = [i["label"] for i in content["images"] if i["true"] == "ice"]
    assert content["confusion"]["ice"]["unknown"] == said.count("unknown")
    text = CliRunner().invoke(classify, [str(model), str(fresh)])
    assert text.stdout.splitlines()[0].startswith("9 images")
    assert f"balanced accuracy {content['balanced_accuracy']:.3f}, 95 %" in text.stdout
    assert f"unknown: {said.count('unknown')} of 3 images of foreign terrains" in text.stdout
    assert "was trained on 1 of 10 images" in text.stderr


def test_another_scale_than_that_of_the_model_is_said(trained, fresh):
    model, _ = trained
    for scale, said in ((0.006, False), (0.012, True)):
        rows = [f"ice/{k}.png,{k},{scale}" for k in range(3)]
        text = "\n".join(["path,photo_id,metres_per_pixel", *rows])
        (fresh / "manifest.csv").write_text(text)
        answer = CliRunner().invoke(classify, [str(model), str(fresh)])
        assert ("trained at 0.006" in answer.stderr) == said


def test_images_that_were_all_trained_on_are_no_test(trained, photos):
    model, _ = trained
    answer = CliRunner().invoke(classify, [str(model), str(photos)])
    assert answer.exit_code == 1
    assert "nothing is held out: the model was trained on" in str(answer.exception)


def test_a_folder_stands_alone(trained, fresh):
    model, _ = trained
    answer = CliRunner().invoke(classify, [str(model), str(fresh), str(fresh / "ice/0.png")])
    assert answer.exit_code == 2
    assert "give one folder alone" in answer.output


def test_a_broken_image_is_left_out_and_the_exit_code_says_so(trained, fresh):
    model, _ = trained
    (fresh / "ice/broken.png").write_bytes(b"no image")
    answer = CliRunner().invoke(classify, [str(model), str(fresh)])
    assert answer.exit_code == 1
    assert answer.stdout.splitlines()[0].startswith("9 images")
    assert "left out: " in answer.stderr
