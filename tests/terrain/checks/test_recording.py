"""The check of a recording with its camera."""

import numpy as np
import pytest

import odometry
from odometry.checks.findings.finding import Level
from odometry.recording.run_span import Span
from terrain.checks.recording import check_run, checked_run
from terrain.classification.classifier import TerrainClassifier
from tests.odometry.checks.copies.test_copied_turns import by_treads
from tests.odometry.checks.drives import winding


def test_a_run_without_images_is_checked_as_ever(curvy_run):
    report, of_odometry = check_run(curvy_run), odometry.check_recording(curvy_run)
    assert report.findings == of_odometry.findings
    assert set(of_odometry.skipped) < set(report.skipped)
    assert "no images" in report.skipped[-1]


def test_findings_of_odometry_and_camera_stand_side_by_side(faulty):
    file = faulty.folder / "odometry.csv"
    lines = file.read_text().split()
    t, _, right = lines[100].split(",")
    lines[100] = f"{t},50,{right}"
    file.write_text("\n".join(lines) + "\n")
    faulty.settings(camera={"mount": [0.2, 0.0, 0.55, 0.0, -0.85, 0.0]})
    assert {"absurd_speed", "region_outside"} <= set(faulty.found())


def test_images_without_camera(faulty, world):
    world.write_toml(faulty.folder / "run.toml", robot=world.robot)
    finding = faulty.found()["no_camera"]
    assert finding.level is Level.WARNING
    assert "24 images" in finding.seen


def test_camera_without_images(faulty):
    (faulty.folder / "images.csv").unlink()
    assert faulty.found()["no_images"].level is Level.NOTE


def test_a_camera_table_that_is_none(faulty):
    """What is no number is a finding with the reader's words, not a traceback."""
    faulty.settings(camera={"mount": ["a", 0, 1, 0, 0, 0]})
    finding = faulty.found()["camera_unreadable"]
    assert "mount must hold numbers" in finding.seen
    assert "not as the format says" in finding.cause


def test_a_folder_that_cannot_be_read_is_refused(tmp_path):
    report = check_run(tmp_path / "nowhere")
    assert [finding.level for finding in report.findings] == [Level.REFUSED]


def test_a_refused_recording_is_not_looked_at_further(faulty):
    file = faulty.folder / "odometry.csv"
    header, *rows = file.read_text().split()
    cells = [row.split(",") for row in rows]
    milliseconds = [f"{1000 * float(t)},{left},{right}" for t, left, right in cells]
    file.write_text("\n".join([header, *milliseconds]) + "\n")
    report = check_run(faulty.folder)
    assert report.at(Level.REFUSED)
    assert "refused" in report.skipped[-1]


def test_one_row_of_images_or_odometry(faulty):
    (faulty.folder / "images.csv").write_text("t,file\n1.0,images/02.jpg\n")
    assert faulty.found() == {}
    (faulty.folder / "images.csv").write_text("t,file\n")
    check_run(faulty.folder)  # an answer, no traceback


@pytest.mark.slow
def test_the_model_is_looked_at(faulty, classifier, training_patches):
    assert faulty.found(classifier) == {}
    without = TerrainClassifier().fit(*training_patches)
    finding = faulty.found(without)["model_without_scale"]
    assert finding.level is Level.NOTE
    assert "no metric scale" in finding.cause


def test_a_model_of_another_scale_will_label_nothing(faulty, classifier, monkeypatch):
    monkeypatch.setattr(classifier, "metres_per_pixel", 6.0)
    finding = faulty.found(classifier)["model_unsuited"]
    assert "smaller than a training patch" in finding.seen
    assert "mm" in finding.cause


def test_a_gyroscope_that_repeats_the_treads_is_left_out(tmp_path):
    """The commands estimate as if it were not there."""
    run = by_treads(winding())
    (tmp_path / "run.toml").write_text("[robot]\ntrack_width = 0.6\n")
    for name, columns in (("odometry", run.odometry.columns), ("pose", run.pose.columns)):
        values = np.column_stack(list(columns.values()))
        header = ",".join(columns)
        np.savetxt(tmp_path / f"{name}.csv", values, "%.9f", ",", header=header, comments="")
    read, report = checked_run(tmp_path, Span())
    assert [finding.name for finding in report.findings] == ["gyroscope_is_treads"]
    assert "gyro_z" in odometry.Run.read(tmp_path).odometry
    assert "gyro_z" not in read.odometry
