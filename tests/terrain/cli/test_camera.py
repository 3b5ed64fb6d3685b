"""The verb `camera`: what it says, what it draws, what it writes, and what it leaves alone."""

import shutil
import tomllib

import cv2
import numpy as np
import pytest

from odometry.checks.findings.finding import Finding, Level
from terrain.calibration import mount_sources
from terrain.calibration.mount_fit import MountFit
from terrain.calibration.mount_sources import MountSource
from terrain.camera.camera import Camera
from terrain.classification.classifier import TerrainClassifier
from terrain.cli.verbs.camera import _write
from terrain.errors import CalibrationError
from tests.terrain.calibration.rendered import marked
from tests.terrain.cli.verb_calls import verb

__all__ = ["verb"]

GROUND = np.array([[x, y] for x in (0.4, 0.7, 1.1, 1.7) for y in (-0.6, -0.3, 0.0, 0.25, 0.5)])


@pytest.fixture
def run(across_run, tmp_path):
    """A copy of a run with images, its [camera] at the end of run.toml."""
    return shutil.copytree(across_run, tmp_path / "run")


def without_camera(run):
    text = (run / "run.toml").read_text()
    (run / "run.toml").write_text(text.partition("[camera]")[0])
    return text


def ros_file(world, tmp_path, **changes):
    camera = world.camera | changes
    width, height = camera["image_size"]
    flat = [value for row in camera["matrix"] for value in row]
    text = (
        f"image_width: {width}\nimage_height: {height}\ncamera_name: front\n"
        f"camera_matrix: {{rows: 3, cols: 3, data: {flat}}}\ndistortion_model: plumb_bob\n"
        f"distortion_coefficients: {{rows: 1, cols: 4, data: {camera['distortion']}}}\n"
    )
    (tmp_path / "camera.yaml").write_text(text)
    return tmp_path / "camera.yaml"


def marks_file(world, tmp_path):
    rows = marked(world.camera, GROUND, 0.1, np.random.default_rng(1))
    world.write_csv(tmp_path / "marks.csv", "u,v,x,y", rows)
    return tmp_path / "marks.csv"


@pytest.mark.drawn
def test_the_camera_of_a_run(verb, run, tmp_path):
    before = (run / "run.toml").read_bytes()
    answer = verb("camera", run, "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    assert "fx 120.0, fy 118.0" in answer.output
    assert "pitch 48.70 degrees" in answer.output
    assert "A metre is" in answer.output
    assert "Next: look at" in answer.output
    assert (run / "run.toml").read_bytes() == before
    pictures = sorted((tmp_path / "out" / "figures").iterdir())
    assert [file.name for file in pictures] == [f"terrain_{k}.png" for k in (1, 2, 3, 4)]
    assert cv2.imread(str(pictures[0])).std() > 10
    table = tomllib.loads((tmp_path / "out" / "camera.toml").read_text())["camera"]
    assert table == tomllib.loads(before.decode())["camera"]


def test_lens_from_a_file_and_mount_from_points(verb, run, world, tmp_path):
    """The way of a new user: nothing known, then all of it in run.toml."""
    true = tomllib.loads(without_camera(run))["camera"]
    lens, marks = ros_file(world, tmp_path), marks_file(world, tmp_path)
    first = verb("camera", run, "--out", tmp_path / "one", "--file", lens)
    assert first.exit_code == 0, first.output
    assert "where the camera sits is not known" in first.output
    given = ("--file", tmp_path / "one" / "camera.toml", "--points", marks, "--write")
    second = verb("camera", run, "--out", tmp_path / "two", *given)
    assert second.exit_code == 0, second.output
    assert "reprojection error 0." in second.output
    assert "Wrote [camera] of" in second.output
    assert (tmp_path / "two" / "figures" / "points.png").exists()
    written = tomllib.loads((run / "run.toml").read_text())
    assert written["robot"] == world.robot
    np.testing.assert_allclose(written["camera"]["mount"], true["mount"], atol=0.01)
    np.testing.assert_array_equal(written["camera"]["matrix"], true["matrix"])


def test_marks_that_contradict_each_other_are_not_written(run):
    before = (run / "run.toml").read_bytes()
    camera = Camera.from_table(tomllib.loads(before.decode())["camera"])
    fit = MountFit(camera.mount, np.full(6, 0.01), np.ones(9), contradiction="row 4 is off")
    with pytest.raises(CalibrationError, match=r"run.toml is left as it was, row 4 is off"):
        _write(run, MountSource(camera, "marks.csv", fit))
    assert (run / "run.toml").read_bytes() == before


@pytest.mark.slow
def test_the_run_itself(verb, run, world, tmp_path):
    text = (run / "run.toml").read_text()
    mount = str(world.camera["mount"])
    assert mount in text
    (run / "run.toml").write_text(text.replace(mount, "[0.2, 0.0, 0.7, 0.0, 0.5, 0.0]"))
    answer = verb("camera", run, "--out", tmp_path / "out", "--from-motion")
    assert answer.exit_code == 0, answer.output
    found = tomllib.loads((tmp_path / "out" / "camera.toml").read_text())["camera"]["mount"]
    error = np.abs(np.array(found) - world.camera["mount"])
    assert np.degrees(error[3:5]).max() < 0.5
    assert error[2] < 0.01
    assert "features that move as terrain does" in answer.output
    assert (tmp_path / "out" / "figures" / "flow.png").exists()
    before = tomllib.loads((tmp_path / "out" / "camera_before.toml").read_text())
    assert before["camera"]["mount"][4] == 0.5


@pytest.mark.slow
def test_a_height_that_is_not_determined_leaves_no_file(verb, run, tmp_path, monkeypatch):
    found, sources = mount_sources.mount_of_motion, []

    def vague(*given, **more):
        if not sources:
            sources.append(found(*given, **more))
        (source,) = sources
        source.fit.half_interval[2] = np.nan
        return source

    monkeypatch.setattr(mount_sources, "mount_of_motion", vague)
    before = (run / "run.toml").read_bytes()
    for options in ((), ("--write",)):
        answer = verb("camera", run, "--out", tmp_path / "out", "--from-motion", *options)
        assert answer.exit_code == 1
        assert "does not determine the height" in answer.output
        assert (run / "run.toml").read_bytes() == before
        assert not (tmp_path / "out" / "camera.toml").exists()
    stated = ("--mount", 0.2, 0.0, 0.7, 0.0, 0.5, 0.0)
    assert verb("camera", run, "--out", tmp_path / "b", "--from-motion", *stated).exit_code == 0


def test_what_the_check_says_of_the_images_is_said_of_a_mount_from_motion(
    verb, run, tmp_path, monkeypatch
):
    late = Finding("images_late", Level.WARNING, "images are late", "A clock", "Look")
    monkeypatch.setattr("terrain.cli.texts.camera_text.image_motion", lambda *_: ([late], ""))
    answer = verb("camera", run, "--out", tmp_path / "out", "--from-motion")
    assert "Warning: images are late. A clock. Look" in answer.output


def test_a_camera_that_misses_the_region(verb, run, tmp_path):
    stated = ("--mount", 0.2, 0.0, 0.55, 0.0, -0.6, 0.0)
    answer = verb("camera", run, "--out", tmp_path / "out", *stated)
    assert answer.exit_code == 0, answer.output
    assert "shows no terrain straight ahead" in answer.output
    assert "would have no region straight ahead" in answer.output
    assert "Suggestion: a pitch of" in answer.output


def test_a_model_with_and_without_scale(verb, run, training_patches, model_file, tmp_path):
    TerrainClassifier().fit(*training_patches).save(tmp_path / "plain.model")
    plain = verb("camera", run, "--out", tmp_path / "a", "--model", tmp_path / "plain.model")
    assert "Warning: the model has no metric scale" in plain.output
    metric = verb("camera", run, "--out", tmp_path / "b", "--model", model_file)
    assert "metric scale" not in metric.output
    assert "patches have 6 mm a pixel" in metric.output


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--points", "a.csv", "--from-motion"), "--points and --from-motion"),
        (("--chessboard", "9x6"), "go together"),
        (("--chessboard", "nine", "--square-m", "0.03"), "inner corners such as 9x6"),
        (("--imu", *"000000"), "--imu needs --file"),
    ],
)
def test_options_that_contradict(verb, run, tmp_path, options, words):
    (tmp_path / "a.csv").write_text("u,v,x,y\n")
    made = [tmp_path / "a.csv" if option == "a.csv" else option for option in options]
    answer = verb("camera", run, "--out", tmp_path / "out", *made)
    assert answer.exit_code == 2
    assert words in " ".join(answer.output.split())


def test_a_lens_of_another_size(verb, run, world, tmp_path):
    lens = ros_file(world, tmp_path, image_size=[320, 240])
    answer = verb("camera", run, "--out", tmp_path / "out", "--file", lens)
    assert answer.exit_code == 1
    assert "multiply fx, fy, cx and cy by 0.5" in answer.output
    assert not (tmp_path / "out").exists()


def test_a_mount_is_needed_to_write(verb, run, world, tmp_path):
    without_camera(run)
    before = (run / "run.toml").read_bytes()
    options = ("--file", ros_file(world, tmp_path), "--write")
    answer = verb("camera", run, "--out", tmp_path / "out", *options)
    assert answer.exit_code == 1
    assert "nothing says where the camera sits" in answer.output
    assert (run / "run.toml").read_bytes() == before


def test_nothing_is_known_of_the_lens(verb, run, tmp_path):
    without_camera(run)
    answer = verb("camera", run, "--out", tmp_path / "out")
    assert answer.exit_code == 1
    assert "give a calibration file (--file)" in answer.output


@pytest.mark.parametrize(
    ("mount", "words"),
    [
        ((0.2, 0.0, 0.55, 0.6, 48.7, 1.1), "roll, pitch and yaw are in degrees"),
        ((200, 0, 550, 0.01, 0.85, 0.02), "x, y and z are in mm"),
        ((0.2, 0.0, 0.55, 0.01, -0.85, 0.02), "pitch has the wrong sign"),
    ],
)
def test_a_mount_in_other_units_is_doubted_and_not_written(verb, run, tmp_path, mount, words):
    before = (run / "run.toml").read_bytes()
    answer = verb("camera", run, "--out", tmp_path / "out", "--mount", *mount, "--write")
    assert answer.exit_code == 1
    said = answer.output.splitlines()
    assert any(line.startswith("Warning: ") and f"mount: {words}" in line for line in said)
    assert "no camera sits so; give x, y, z in metres" in answer.output
    assert (run / "run.toml").read_bytes() == before
