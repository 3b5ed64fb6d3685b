"""Images beside the treads: stamps that are off, and cameras that look elsewhere."""

import shutil
from dataclasses import replace

import cv2
import numpy as np
import pytest

import terrain
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks import image_motion as image_motion_file
from terrain.checks import unrelated_images
from terrain.checks.ground_steps import GroundSteps, ground_steps
from terrain.checks.image_agreement import ImageMotion
from terrain.checks.image_motion import POOR, image_motion
from terrain.checks.terrain_views import TerrainViews
from tests.studies.recordings.check_image_motion import moved, with_images


def found(run, camera):
    findings, skipped = image_motion(run, camera)
    assert not skipped
    return {finding.name: finding for finding in findings}


def test_steps_by_the_terrain_are_those_of_the_truth(drive, camera):
    steps = ground_steps(drive, camera)
    assert len(steps) == steps.tried == 32
    stamps_s, true = drive.truth.stamps_s, drive.truth.stack("x", "y", "yaw")
    first, second = (
        np.column_stack([np.interp(s, stamps_s, of) for of in (*true.T[:2], np.unwrap(true[:, 2]))])
        for s in steps.stamps_s.T
    )
    moved = (second[:, 0] - first[:, 0]) + 1j * (second[:, 1] - first[:, 1])
    moved = moved * np.exp(-1j * first[:, 2])
    assert np.abs(steps.steps[:, 0] + 1j * steps.steps[:, 1] - moved).max() < 0.02
    assert np.abs(steps.steps[:, 2] - (second - first)[:, 2]).max() < 0.02


def test_near_terrain_is_looked_for_once_in_each_image_by_each_camera(drive, camera, monkeypatch):
    views, looked = TerrainViews(drive, camera.image_size), []
    look = Camera.pixels_to_ground
    monkeypatch.setattr(
        Camera, "pixels_to_ground", lambda self, of: looked.append(self) or look(self, of)
    )
    first, second, third = (str(name) for name in drive.images["file"][:3])
    other = moved(camera, 2, lambda z: 2.0 * z)
    for by in (camera, other):
        views.same(by, first, second)
        views.same(by, second, third)
    assert looked == 3 * [camera] + 3 * [other]


def test_nothing_is_odd_about_the_run_as_it_is(drive, camera):
    assert found(drive, camera) == {}


@pytest.mark.parametrize("late_s", [-2.0, -0.3, 0.3, 3.0])
def test_a_lag_of_the_images_is_measured(drive, camera, late_s):
    run = with_images(drive, t=drive.images.stamps_s + late_s)
    finding = found(run, camera)["images_late"]
    word = "Subtract" if late_s > 0 else "Add"
    assert finding.remedy.startswith(f"{word} {abs(late_s):.2f} s")


def test_a_lag_that_moves_labels_by_centimetres_is_none(drive, camera):
    assert found(with_images(drive, t=drive.images.stamps_s + 0.1), camera) == {}


@pytest.mark.parametrize("times", [0.5, 1.5])
def test_another_height_of_the_camera_is_measured(drive, camera, times):
    cause = found(drive, moved(camera, 2, lambda z: times * z))["camera_height"].cause
    fits_m = float(cause.split(": ")[1].split(" m fit")[0])
    assert fits_m == pytest.approx(1.2, rel=0.02)


def with_treads(drive, times):
    treads = {name: times * drive.odometry[name] for name in ("v_left", "v_right")}
    odometer = replace(drive.odometry, columns={**drive.odometry.columns, **treads})
    return replace(drive, odometry=odometer)


@pytest.mark.parametrize(("times", "words"), [(1.3, "1.3 times too large"), (0.7, "too small")])
def test_treads_that_positions_call_scaled_are_not_the_camera(drive, camera, times, words):
    finding = found(with_treads(drive, times), camera)["scale"]
    assert words in finding.cause
    assert "height of the camera fits" in finding.cause


def test_the_height_is_by_positions_where_both_are_wrong(drive, camera):
    other = moved(camera, 2, lambda z: 2.0 * z)
    finding = found(with_treads(drive, 1.3), other)["camera_height"]
    assert float(finding.cause.split(": ")[1].split(" m fit")[0]) == pytest.approx(1.2, rel=0.03)


def test_without_positions_scaled_treads_are_named_beside_the_height(drive, camera):
    blind = replace(with_treads(drive, 1.3), pose=None, truth=None)
    assert "tread speeds are 1.3 times too large" in found(blind, camera)["camera_height"].cause


@pytest.mark.parametrize(("degrees", "words"), [(20, "right"), (-90, "left"), (180, "reverse")])
def test_a_camera_that_looks_elsewhere_is_named(drive, camera, degrees, words):
    other = moved(camera, 5, lambda yaw: yaw + np.radians(degrees))
    cause = found(drive, other)["camera_yaw"].cause
    assert words in cause
    assert f"{abs(degrees)} degrees" in cause


def test_images_in_the_reverse_order_are_named(drive, camera):
    run = with_images(drive, file=drive.images["file"][::-1].copy())
    assert set(found(run, camera)) == {"images_reversed"}


def half_a_run_off(drive):
    return with_images(drive, file=np.roll(drive.images["file"], len(drive.images) // 2))


@pytest.fixture
def by_content(monkeypatch):
    """Names of the files say nothing of their order."""
    monkeypatch.setattr(unrelated_images, "_by_name", lambda _: None)


@pytest.mark.usefixtures("by_content")
def test_images_of_another_drive_are_named(drive, camera):
    finding = found(half_a_run_off(drive), camera)["images_unrelated"]
    assert "another drive" in finding.cause


@pytest.mark.usefixtures("by_content")
def test_a_camera_that_rocks_is_not_taken_for_another_drive(drive, camera, monkeypatch):
    monkeypatch.setattr(GroundSteps, "is_steady", False)
    findings, skipped = image_motion(half_a_run_off(drive), camera)
    assert findings == []
    assert "do not agree within 10 s" in skipped


@pytest.mark.parametrize("order", ["as text", "mixed"])
def test_another_order_than_that_of_the_names_is_named(drive, camera, order):
    files = drive.images["file"]
    places = np.array(sorted(range(len(files)), key=str))
    if order == "mixed":
        places = np.random.default_rng(3).permutation(len(files))
    finding = found(with_images(drive, file=files[places]), camera)["images_unordered"]
    assert "by their numbers" in finding.remedy


@pytest.mark.usefixtures("by_content")
def test_images_in_no_order_are_named_by_their_content(drive, camera):
    files = np.random.default_rng(3).permutation(drive.images["file"])
    finding = found(with_images(drive, file=files), camera)["images_unrelated"]
    assert "no order" in finding.cause


@pytest.mark.usefixtures("by_content")
def test_terrain_that_is_recognised_nowhere_is_not_judged(drive, camera, monkeypatch):
    files = np.random.default_rng(3).permutation(drive.images["file"])
    monkeypatch.setattr(unrelated_images, "FAR_M", 30.0)  # few pairs lie so far apart
    findings, skipped = image_motion(with_images(drive, file=files), camera)
    assert findings == []
    assert "of 32 pairs of images" in skipped


def test_mirrored_images_are_named_by_check(drive, tmp_path):
    folder = tmp_path / "mirrored"
    shutil.copytree(drive.folder, folder)
    for file in (folder / "images").iterdir():
        cv2.imwrite(str(file), cv2.flip(cv2.imread(str(file)), 1))
    assert [one.name for one in terrain.check_run(folder).findings] == ["images_mirrored"]


def test_what_other_warnings_explain_is_not_compared(drive):
    swapped = {name: drive.odometry[other] for name, other in
               (("v_left", "v_right"), ("v_right", "v_left"))}  # fmt: skip
    odometer = replace(drive.odometry, columns=drive.odometry.columns | swapped)
    report = terrain.check_run(replace(drive, odometry=odometer))
    assert report.misleads
    assert not any(one.name.startswith(("images_", "camera_")) for one in report.findings)
    assert any("see the warnings" in words for words in report.skipped)


@pytest.mark.parametrize(("axes", "cause"), [(-1, "the camera hangs"), (0, "top row is the last")])
def test_images_upside_down_are_named(drive, camera, tmp_path, axes, cause):
    folder = tmp_path / "run"
    shutil.copytree(drive.folder, folder)
    for path in sorted((folder / "images").iterdir()):
        cv2.imwrite(str(path), cv2.flip(cv2.imread(str(path)), axes))
    findings = found(Run.read(folder), camera)
    assert set(findings) == {"images_upside_down"}
    assert cause in findings["images_upside_down"].cause


def test_a_mount_that_is_rolled_by_half_a_turn_is_named(drive, camera):
    assert set(found(drive, moved(camera, 3, lambda roll: roll + np.pi))) == {"images_upside_down"}


def test_images_upside_down_that_move_nearly_as_the_treads_do_are_named(drive, camera, monkeypatch):
    monkeypatch.setattr(image_motion_file, "_doubt", lambda *_: "")
    assert set(found(drive, moved(camera, 3, lambda roll: roll + np.pi))) == {"images_upside_down"}


def test_images_upside_down_of_a_camera_that_rocks_are_named_by_the_size_of_the_terrain(
    drive, camera, monkeypatch
):
    hangs = moved(camera, 3, lambda roll: roll + np.pi)
    views = TerrainViews(drive, camera.image_size)
    changed = ground_steps(drive, hangs, views)
    monkeypatch.setattr(unrelated_images, "unexplained", lambda _: 0.65)
    assert [one.name for one in unrelated_images.upside_down(drive, hangs, views, changed)]
    kept = replace(changed, scales=np.ones(len(changed)))
    assert not list(unrelated_images.upside_down(drive, hangs, views, kept))


def test_motion_that_agrees_poorly_is_not_taken_for_checked(drive, camera, monkeypatch):
    monkeypatch.setattr(ImageMotion, "noise", POOR + 0.5)
    findings, skipped = image_motion(drive, camera)
    assert not findings
    assert "poorly" in skipped
