"""`evaluate --with`: odometry of other programs as rows beside ours."""

import json
import shutil

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.io.trajectory_files import read_trajectory, to_optical
from odometry.io.tum import write_spatial_tum
from odometry.run import Run
from odometry.spatial_trajectory import SpatialTrajectory
from terrain.cli.evaluate import evaluate
from terrain.main_job import run_odometry
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


def test_a_camera_path_is_told_to_be_one(finished, tmp_path):
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
