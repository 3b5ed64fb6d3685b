"""`evaluate --with`: odometry of other programs as rows beside ours."""

import json
import shutil

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.evaluation.other_odometry import Judge
from odometry.evaluation.relative import EvaluationConfig
from odometry.geometry import se3
from odometry.io.trajectory_files import read_trajectory, to_optical, write_trajectory
from odometry.io.tum import write_spatial_tum
from odometry.recording.run import Run
from odometry.trajectory import SpatialTrajectory, Trajectory
from terrain.cli.verbs.evaluate import evaluate
from terrain.main_job import run_odometry
from terrain.other_odometry.other_headings import pose_fault
from terrain.other_odometry.other_stamps import late_by_s
from terrain.results import write_results


@pytest.fixture(scope="module")
def finished(curvy_run, tmp_path_factory):
    """A finished run, and what made it: the run folder, with an odometry that a bag had."""
    out = tmp_path_factory.mktemp("others")
    run = out / "run"
    shutil.copytree(curvy_run, run)
    result = run_odometry(curvy_run, terrain="sand")
    made = {"made": {"inputs": [{"role": "RUN", "path": str(run)}]}}
    write_results(result, out / "results", made)
    kept = run / "other_odometry"
    kept.mkdir()
    text = (out / "results" / "odometer.csv").read_text().splitlines()
    (kept / "wheels.csv").write_text("\n".join(line for line in text[: len(text) // 2]))
    return out


@pytest.fixture(scope="module")
def winding(tmp_path_factory):
    """A finished run of a minute whose turns never repeat."""
    run = tmp_path_factory.mktemp("winding") / "run"
    run.mkdir()
    rng = np.random.default_rng(2)
    t = np.arange(0.0, 60.0, 0.05)
    turn = np.interp(t, np.arange(0.0, 62.0, 1.5), rng.uniform(-0.8, 0.8, 42))
    yaw = np.concatenate([[0.0], np.cumsum(turn[:-1] * 0.05)])
    x, y = (np.cumsum(0.5 * 0.05 * of(yaw)) for of in (np.cos, np.sin))
    rows = zip(t, 0.5 - 0.3 * turn, 0.5 + 0.3 * turn, turn, strict=True)
    (run / "run.toml").write_text("[robot]\ntrack_width = 0.6\n")
    lines = [",".join(f"{cell:.9g}" for cell in row) for row in rows]
    (run / "odometry.csv").write_text("\n".join(["t,v_left,v_right,gyro_z", *lines]))
    poses = zip(t[::2], x[::2], y[::2], yaw[::2], strict=True)
    lines = [",".join(f"{cell:.9g}" for cell in row) for row in poses]
    (run / "pose.csv").write_text("\n".join(["t,x,y,yaw", *lines]))
    made = {"made": {"inputs": [{"role": "RUN", "path": str(run)}]}}
    write_results(run_odometry(Run.read(run), terrain="sand"), run.parent / "results", made)
    return run.parent


def answer(*arguments):
    return CliRunner().invoke(evaluate, [str(each) for each in arguments])


def others(finished, *arguments):
    said = answer(finished / "results", *arguments, "--json")
    return said.exit_code, json.loads(said.stdout)[str(finished / "results")]


def test_our_own_odometer_as_another_has_our_errors(finished):
    """What `run` computed in memory is the oracle."""
    code, result = others(finished, "--with", f"ours={finished / 'results' / 'odometer.tum'}")
    assert code == 0
    ours, other = result["errors"]["odometer"], result["others"]["other/ours"]
    for name in ("translation_m_per_m", "rotation_deg_per_m", "position_m"):
        assert other[name]["mean"] == pytest.approx(ours[name]["mean"], rel=1e-5), name
    assert other["windows"] == ours["windows"]
    assert (other["share"], other["notes"]) == (1, [])


def test_what_the_run_folder_keeps_is_a_row_and_ours_at_its_stamps(finished):
    said = answer(finished / "results")
    assert said.exit_code == 0
    rows = [line for line in said.stdout.splitlines() if "other/wheels" in line]
    first, second = (line.split()[-7:] for line in rows)
    assert first == second  # it is our odometer
    assert "stamps of other/wheels" in rows[1]
    assert "% of the reference's stamps" in said.stderr


def test_a_camera_path_is_reported_as_one(finished, tmp_path):
    """Optical axes at half the scale: doubted as they stand; right, but small, once named."""
    ours = read_trajectory(finished / "results" / "odometer.tum")
    small = ours.poses.copy()
    small[:, :3, 3] *= 0.5
    slam = tmp_path / "slam.tum"
    write_spatial_tum(slam, to_optical(SpatialTrajectory(ours.stamps_s, small)))
    notes = others(finished, "--with", f"slam={slam}")[1]["others"]["other/slam"]["notes"]
    assert any("--axes optical" in note for note in notes)
    named = others(finished, "--with", f"slam={slam}", "--axes", "optical")[1]["others"]
    (note,) = named["other/slam"]["notes"]
    assert "Nothing is scaled" in note
    assert named["other/slam"]["scale"] == pytest.approx(2, rel=0.1)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("9e9 0 0 0 0 0 0 1\n9.1e9 0 0 0 0 0 0 1\n", "fewer than two"),
        ("1 2 3\n", "no known format"),
        ("# only a comment\n", "no pose"),
        ("1 0 0 0 0 1 0 0 0 0 1 0\n", "no stamps"),
    ],
)
def test_what_cannot_be_judged_is_a_row_and_the_exit_code_1(finished, tmp_path, content, words):
    (tmp_path / "slam.tum").write_text(content)
    said = answer(finished / "results", "--with", f"slam={tmp_path / 'slam.tum'}")
    assert said.exit_code == 1
    (row,) = [line for line in said.stdout.splitlines() if "other/slam" in line]
    assert "failed: " in row
    assert words in row
    (ours,) = [line for line in said.stdout.splitlines() if " odometer " in line]
    assert ours.index(" pose ") < len(row)  # the reason makes no column wider


def test_a_result_without_a_reference_table_says_what_to_do(finished, tmp_path):
    old = tmp_path / "old"
    shutil.copytree(finished / "results", old)
    (old / "reference.csv").unlink()
    said = answer(old, "--with", f"ours={old / 'odometer.tum'}")
    assert said.exit_code == 1
    assert "`run` again" in said.stdout


def test_a_name_without_a_file_is_a_usage_error(finished):
    assert answer(finished / "results", "--with", "slam").exit_code == 2
    assert answer(finished / "results", "--with", "a=b", "--with", "a=c").exit_code == 2


def test_reference_csv_has_the_wheel_travel_of_the_run(finished, curvy_run):
    run = Run.read(curvy_run)
    table = np.genfromtxt(finished / "results" / "reference.csv", delimiter=",", names=True)
    expected = np.interp(table["t"], run.odometry.stamps_s, run.wheel_travel_m)
    np.testing.assert_allclose(table["wheel_travel"], expected, atol=1e-8)


def test_a_kitti_file_comes_with_its_times(finished, tmp_path):
    """The oracle is the same path as TUM; a KITTI file has optical axes unless it is said."""
    ours = read_trajectory(finished / "results" / "odometer.tum")
    write_trajectory(tmp_path, "slam", ours, "kitti")
    poses, times = sorted(tmp_path.glob("slam*"), key=lambda file: "times" in file.name)
    same, kitti = (
        others(finished, "--with", f"slam={file}", *more)[1]["others"]["other/slam"]
        for file, more in (
            (finished / "results" / "odometer.tum", ()),
            (poses, ("--times", times)),
        )
    )
    assert kitti["translation_m_per_m"]["mean"] == pytest.approx(
        same["translation_m_per_m"]["mean"], rel=1e-3
    )
    assert kitti["notes"] == []


@pytest.mark.parametrize(("shift_s", "way"), [(0.8, "late by 0.8"), (-0.8, "early by 0.8")])
def test_a_shift_of_its_clock_is_suspected_where_it_is_plain(winding, tmp_path, shift_s, way):
    ours = read_trajectory(winding / "results" / "odometer.tum")
    slam = tmp_path / "slam.tum"
    write_spatial_tum(slam, SpatialTrajectory(ours.stamps_s + shift_s, ours.poses))
    (note,) = [
        note
        for note in others(winding, "--with", f"slam={slam}")[1]["others"]["other/slam"]["notes"]
        if "stamps seem" in note
    ]
    assert way in note
    assert "Nothing is shifted" in note


@pytest.mark.parametrize("shift_s", [0.4, 0.0])
def test_a_shift_of_a_short_run_is_suspected(shift_s):
    at_s = np.arange(0, 19, 0.05)
    rates = sum(np.sin(at_s / length_s + length_s) for length_s in (0.5, 0.9, 1.7))
    yaw = 0.05 * np.cumsum(rates)
    noisy = yaw + np.random.default_rng(0).normal(0, 0.005, len(yaw))
    flat = np.zeros_like(yaw)
    ours = Trajectory(at_s, np.column_stack([flat, flat, yaw]))
    late_s = late_by_s(Trajectory(at_s + shift_s, np.column_stack([flat, flat, noisy])), ours)
    assert late_s == (pytest.approx(shift_s, abs=0.05) if shift_s else None)


def test_no_shift_is_suspected_of_noise_or_of_a_straight_drive(winding, tmp_path):
    ours = read_trajectory(winding / "results" / "odometer.tum")
    rng = np.random.default_rng(3)
    noisy = ours.poses.copy()
    turns = np.cumsum(rng.normal(0, 0.02, len(noisy)))
    angles = np.column_stack([np.zeros((len(noisy), 2)), turns])
    noisy[:, :3, :3] = noisy[:, :3, :3] @ se3.rotation_from_roll_pitch_yaw(angles)
    straight = np.tile(np.eye(4), (len(noisy), 1, 1))
    straight[:, 0, 3] = np.linspace(0.0, 10.0, len(noisy))
    for poses in (noisy, straight):
        write_spatial_tum(tmp_path / "slam.tum", SpatialTrajectory(ours.stamps_s, poses))
        found = others(winding, "--with", f"slam={tmp_path / 'slam.tum'}")[1]["others"]
        assert not any("stamps seem" in note for note in found["other/slam"]["notes"])


@pytest.mark.parametrize("other", ["drive", "mirrored"])
def test_a_path_of_another_drive_has_no_shift_scale_or_turn(winding, tmp_path, other):
    """One sentence says why its errors mean nothing; a fit to it would mean as little."""
    ours = read_trajectory(winding / "results" / "odometer.tum").plane
    sign, start = (1, 4) if other == "drive" else (-1, 2)
    turn = np.random.default_rng(start).uniform(-0.8, 0.8, 42)
    yaw = np.cumsum(np.interp(ours.stamps_s, np.arange(0.0, 62.0, 1.5), sign * turn)) * 0.05
    x, y = (np.cumsum(0.5 * 0.05 * of(yaw)) for of in (np.cos, np.sin))
    poses = Trajectory(ours.stamps_s, np.column_stack([x, y, yaw]))
    write_spatial_tum(tmp_path / "slam.tum", SpatialTrajectory.from_plane(poses))
    found = others(winding, "--with", f"slam={tmp_path / 'slam.tum'}")[1]["others"]
    (note,) = found["other/slam"]["notes"]
    assert ("the file is of another drive" if other == "drive" else "opposite") in note
    assert found["other/slam"]["translation_m_per_m"]["mean"] > 0.1


def test_headings_that_are_too_rare_for_their_turns_are_not_in_degrees():
    """Whole turns are counted, and more than half of one lies between two rows."""
    at_s = np.arange(0.0, 120.0, 0.05)
    rates = np.random.default_rng(1).uniform(-2.5, 2.5, 41)
    yaw = np.cumsum(np.interp(at_s, np.arange(0.0, 121.0, 3.0), rates)) * 0.05
    ours = Trajectory(at_s, np.column_stack([at_s, 0 * at_s, yaw]))
    rare = Trajectory(at_s[::40], ours.poses[::40] * [1.01, 1.0, 1.0])
    judge = Judge(ours, at_s, ours, ours, np.zeros(2), EvaluationConfig())
    assert pose_fault(rare, judge, {}) is None
    fault = pose_fault(Trajectory(at_s, ours.poses * [1, 1, 57.3]), judge, {})
    assert "degrees, not in radians" in fault.note


def test_odometry_of_a_run_folder_that_moved_is_named_and_can_be_given(finished, tmp_path):
    moved = tmp_path / "results"
    shutil.copytree(finished / "results", moved)
    file = moved / "result.json"
    content = json.loads(file.read_text()) | {"other_odometry": ["wheels"]}
    content["made"]["inputs"][0]["path"] = str(tmp_path / "gone")
    file.write_text(json.dumps(content))
    kept = finished / "run" / "other_odometry" / "wheels.csv"
    assert "--with wheels=RUN/other_odometry/wheels.csv" in answer(moved).stderr
    said = answer(moved, "--with", f"wheels={kept}", "--json")
    given = json.loads(said.stdout)[str(moved)]["others"]["other/wheels"]
    assert given["share"] < 1
    assert given["odometer"]["translation_m_per_m"] == given["translation_m_per_m"]
