"""Images of other terrain, and wrong velocities, are not believed: `run`, `batch`, in Python."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.checks.velocity.velocity import VELOCITY_FAULTS
from odometry.recording.run import Run
from terrain.believed import ELSEWHERE, OF_STRETCHES, run_to_label
from terrain.checks.recording import _motion
from terrain.classification.classifier import TerrainClassifier
from terrain.cli.verbs.batch import batch
from terrain.cli.verbs.run import run
from terrain.config import Config
from terrain.errors import PatchError
from terrain.main_job import run_odometry
from terrain.results import write_results
from terrain.run_options import RunOptions

RUN = object()  # which is given back


def found(name):
    return Finding(name, Level.WARNING, "seen", "Images are of another drive", "look")


@pytest.fixture
def of_another_drive(monkeypatch):
    """What a check of images against the motion finds in any run."""
    answer = [found("images_unrelated")], ""
    monkeypatch.setattr("terrain.checks.recording.image_motion", lambda *_: answer)


@pytest.mark.parametrize("name", sorted(ELSEWHERE))
@pytest.mark.parametrize("source", [None, "camera"])
def test_vision_is_left_out(name, source):
    options = RunOptions(Config(), model=Path("a.model"), source=source)
    run, changed, said = options.believed(RUN, CheckReport(Path("a"), (found(name),)))
    assert run is RUN
    assert changed.terrain_source == "none"
    assert said.endswith("Images are of another drive")


@pytest.mark.parametrize("name", ["images_late", "camera_height"])
def test_what_moves_labels_by_a_little_is_no_reason(name):
    options = RunOptions(Config(), model=Path("a.model"))
    report = CheckReport(Path("a"), (found(name),))
    assert options.believed(RUN, report) == (RUN, options, "")


def test_a_published_system_keeps_its_camera():
    options = RunOptions(Config(), model=Path("a.model"), preset="chen2023")
    report = CheckReport(Path("a"), (found("images_reversed"),))
    assert options.believed(RUN, report) == (RUN, options, "")


@pytest.mark.parametrize("source", ["labels", "feel"])
def test_other_sources_stay(source):
    options = RunOptions(Config(), source=source, feel=Path("feel"))
    report = CheckReport(Path("a"), (found("images_unrelated"),))
    assert options.believed(RUN, report) == (RUN, options, "")


@pytest.mark.parametrize("name", sorted(VELOCITY_FAULTS))
@pytest.mark.parametrize("model", [None, Path("a.model")])
def test_wrong_velocities_are_left_out_and_right_ones_stay(name, model, across_run):
    options, of = RunOptions(Config(), model=model), Run.read(across_run)
    of = replace(of, velocity=of.odometry)
    report = CheckReport(across_run, (replace(found(name), cause="vx is in km/h"),))
    without, same, said = options.believed(of, report)
    assert (without.velocity, same) == (None, options)
    assert said == "velocity.csv is left out: vx is in km/h"
    assert options.believed(of, CheckReport(across_run, ()))[0].velocity is of.velocity


def test_in_python_the_velocities_of_a_folder_are_left_out_as_well(across_run, tmp_path):
    folder = tmp_path / "run"
    shutil.copytree(across_run, folder)
    of = Run.read(folder)
    mean = (of.odometry["v_left"] + of.odometry["v_right"]) / 2
    rows = zip(of.odometry["t"], -mean, strict=True)
    lines = ["t,vx,vy,wz", *(f"{at_s},{vx}," + "," for at_s, vx in rows)]
    (folder / "velocity.csv").write_text("\n".join(f"{line}" for line in lines) + "\n")
    with pytest.warns(UserWarning, match="vx points backwards"):
        wrong = run_odometry(folder)
    assert wrong.run.velocity is None
    assert wrong.replay.means.tobytes() == run_odometry(across_run).replay.means.tobytes()


@pytest.mark.parametrize("name", sorted(ELSEWHERE))
def test_no_patch_is_cut_from_them(name, across_run):
    of, report = Run.read(across_run), CheckReport(across_run, (found(name),))
    with pytest.raises(PatchError, match=r"no patch can be labelled .*: Images are of another"):
        run_to_label(of, report)


@pytest.mark.parametrize("name", sorted(OF_STRETCHES))
def test_of_a_frozen_or_covered_camera_only_the_other_images_are_labelled(name, across_run):
    of = Run.read(across_run)
    held = replace(found(name), spans_s=((1.0, 2.0), (3.0, 3.5)))
    times_s = of.images.stamps_s - of.odometry.stamps_s[0]
    other = (times_s < 1) | ((times_s > 2) & (times_s < 3)) | (times_s > 3.5)
    kept = run_to_label(of, CheckReport(across_run, (held, found("images_late"))))
    assert 0 < len(kept.images) < len(of.images)
    assert kept.images.stamps_s.tolist() == of.images.stamps_s[other].tolist()
    with pytest.raises(PatchError, match="frozen or covered all the time"):
        run_to_label(of, CheckReport(across_run, (replace(held, spans_s=((0.0, 1e9),)),)))


@pytest.mark.usefixtures("no_report", "of_another_drive")
def test_run_says_so_and_keeps_one_terrain(across_run, model_file, tmp_path):
    arguments = [across_run, "--out", tmp_path / "out", "--model", model_file]
    answer = CliRunner().invoke(run, [str(argument) for argument in arguments])
    assert answer.exit_code == 0, answer.output
    assert "vision is left out, as with --no-vision: Images are of another" in answer.stderr
    content = json.loads((tmp_path / "out" / "result.json").read_text())
    assert not content["vision"]
    assert "images_unrelated" in json.dumps(content)


@pytest.mark.usefixtures("no_report", "of_another_drive")
def test_batch_leaves_them_out_as_well(across_run, model_file, tmp_path):
    out = tmp_path / "out"
    arguments = [across_run, "--out", out, "--model", model_file, "--processes", "1"]
    answer = CliRunner().invoke(batch, [str(argument) for argument in arguments])
    assert answer.exit_code == 0, answer.output
    assert not json.loads((out / "across" / "result.json").read_text())["vision"]
    assert "across: vision is left out" in answer.stderr


@pytest.mark.usefixtures("of_another_drive")
def test_in_python_a_folder_is_checked_and_a_run_is_taken_as_it_is(
    across_run, classifier, tmp_path
):
    with pytest.warns(UserWarning, match="Images are of another drive") as warned:
        result = run_odometry(across_run, model=classifier, terrain="gravel")
    assert result.watcher is None
    messages = [str(each.message).removeprefix(f"{across_run}: ") for each in warned]
    assert messages == [
        "seen. Images are of another drive. look.",
        "vision is left out, as with vision=False: Images are of another drive",
    ]
    assert {each.filename for each in warned} == {__file__}
    assert result.report.findings[0].name == "images_unrelated"
    write_results(result, tmp_path)
    assert "images_unrelated" in (tmp_path / "result.json").read_text()
    taken = run_odometry(Run.read(across_run), model=classifier, terrain="gravel")
    assert taken.watcher is not None
    assert taken.report is None


@pytest.mark.usefixtures("of_another_drive")
def test_in_python_a_published_system_keeps_its_camera(across_run, training_patches, world):
    paper = TerrainClassifier("chen2023", metres_per_pixel=world.metres_per_pixel)
    paper.fit(*training_patches)
    result = run_odometry(across_run, model=paper, terrain="gravel", preset="chen2023")
    assert result.watcher is not None


def test_wrong_velocities_keep_images_from_no_check(across_run, monkeypatch):
    asked = []
    monkeypatch.setattr(
        "terrain.checks.recording.image_motion", lambda *of: asked.append(of) or ([], "")
    )
    of, backwards = Run.read(across_run), found("velocity_reversed")
    for report in (CheckReport(across_run, ()), CheckReport(across_run, (backwards,))):
        _motion(of, report)
    assert len(asked) == 2
    _motion(of, CheckReport(across_run, (backwards, found("scale"))))
    assert len(asked) == 2
