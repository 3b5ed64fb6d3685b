"""`camera` and `run` on frames and calibration files of real robots, as they are."""

import csv
import shutil
import tomllib

import cv2
import numpy as np
import pytest

from terrain.classification.classifier import TerrainClassifier
from tests.terrain.calibration.rendered import unbend
from tests.terrain.cli.verb_calls import verb

__all__ = ["verb"]

ROBOTS = {"husky": (0.55, 0.99, 0.67), "marv": (0.5, 0.8, 0.6)}  # track width, length, width


def run_of(name, shared_data, tmp_path):
    """A run folder of one moment of a robot that drives straight on, and its calibration."""
    frames, run = shared_data / "camera-frames" / name, tmp_path / name
    (run / "images").mkdir(parents=True)
    shutil.copy(frames / "camera_front.jpg", run / "images" / "0.jpg")
    names = ("track_width", "length", "width")
    sizes = "".join(f"{key} = {v}\n" for key, v in zip(names, ROBOTS[name], strict=True))
    (run / "run.toml").write_text(f"[robot]\n{sizes}\n# of the moment\n[source]\nframes = 1\n")
    rows = "".join(f"{0.1 * k:.1f},0.8,0.8\n" for k in range(21))
    (run / "odometry.csv").write_text(f"t,v_left,v_right\n{rows}")
    (run / "images.csv").write_text("t,file\n1.0,images/0.jpg\n")
    return run, frames


@pytest.fixture(params=["husky", "marv"])
def robot(request, shared_data, tmp_path):
    return run_of(request.param, shared_data, tmp_path)


@pytest.fixture
def undrawn_husky(shared_data, tmp_path, monkeypatch, no_report):  # noqa: ARG001
    """Without pictures, which take most of the time."""
    monkeypatch.setattr("terrain.cli.texts.camera_outputs.write_ground_figures", lambda *_: [])
    return run_of("husky", shared_data, tmp_path)


def calibrated(verb, run, frames, out, camera="camera_front"):
    return verb(
        *("camera", run, "--file", frames / f"{camera}.yaml", "--out", out, "--write"),
        *("--transforms", frames / "transformations.yaml"),
    )


def nearest_m(table):
    """Where the lowest pixel that looks straight ahead meets the terrain, by its own arithmetic."""
    (fx, _, cx), (_, fy, cy), _ = table["matrix"]
    x, y, z = table["mount"][:3]
    columns = np.arange(0.0, table["image_size"][0])
    v = table["image_size"][1] - 1.0
    right, down = unbend(
        (columns - cx) / fx, np.full(len(columns), (v - cy) / fy), table["distortion"]
    )
    return x + float(np.interp(0.0, -(y - z / down * right), z / down))


@pytest.mark.drawn
def test_a_level_camera(verb, robot, tmp_path):
    """It sees no terrain below itself, and says from where on it does."""
    run, frames = robot
    answer = calibrated(verb, run, frames, tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    settings = tomllib.loads((run / "run.toml").read_text())
    assert settings["source"] == {"frames": 1}
    assert "# of the moment" in (run / "run.toml").read_text()
    nearest = nearest_m(settings["camera"])
    said = float(answer.output.partition("straight ahead is ")[2].split()[0])
    assert said == pytest.approx(nearest, abs=0.02)
    assert "all of the footprint" in answer.output
    begins = float(answer.output.partition("; x = ")[2].split()[0])
    assert nearest - 0.02 < begins < nearest + 0.2
    picture = cv2.imread(str(tmp_path / "out" / "figures" / "terrain_1.png"))
    assert picture.std() > 20


def test_run_looks_where_camera_says(verb, undrawn_husky, model_file, tmp_path):
    run, frames = undrawn_husky
    calibrated(verb, run, frames, tmp_path / "out")
    said = verb("camera", run, "--out", tmp_path / "out", "--model", model_file).output
    ahead = float(said.partition("of the footprint, after ")[2].split()[0])
    answer = verb("run", run, "--out", tmp_path / "results", "--model", model_file)
    assert answer.exit_code == 0, answer.output
    with (tmp_path / "results" / "terrain.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert row["label"]
    assert float(row["distance_ahead"]) == pytest.approx(ahead, abs=0.06)


def test_a_model_finer_than_the_image(verb, undrawn_husky, training_patches, tmp_path):
    """`camera` says what scale would do, `run` that it sees nothing and whom to ask."""
    run, frames = undrawn_husky
    calibrated(verb, run, frames, tmp_path / "out")
    fine = tmp_path / "fine.model"
    TerrainClassifier(metres_per_pixel=0.0003).fit(*training_patches).save(fine)
    said = verb("camera", run, "--out", tmp_path / "out", "--model", fine).output
    assert "no region straight ahead: the image is too coarse there" in said
    assert "train on photographs of" in said
    answer = verb("run", run, "--out", tmp_path / "results", "--model", fine)
    assert "the image is too coarse there (1)" in answer.output
    assert "terrain-odometry camera RUN" in answer.output


def test_a_camera_that_looks_back(verb, undrawn_husky, tmp_path):
    run, frames = undrawn_husky
    answer = calibrated(verb, run, frames, tmp_path / "out", "camera_rear")
    assert "no terrain straight ahead" in answer.output
    assert "points aside or back (yaw 180 degrees)" in answer.output.replace("yaw -180", "yaw 180")
