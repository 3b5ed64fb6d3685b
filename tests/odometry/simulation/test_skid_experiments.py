"""Experiments as runs: modes in the truth alone, calibration runs that state their mode, noise."""

from pathlib import Path

import numpy as np
import pytest

from odometry.recording.run import Run
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.slope import Plane
from odometry.simulation.contact.vehicle import read_contact_vehicle
from odometry.simulation.courses import STEP_S, Course
from odometry.simulation.manoeuvres import outward_spiral
from odometry.simulation.record import contact_run, write_contact_run
from odometry.simulation.skid_experiments import (
    SENSORS,
    calibration_courses,
    calibration_runs,
    drives_on,
    ground_traction,
    terrain_experiment,
    wheel_experiment,
    wheel_traction,
)

HUSKY = Path(__file__).parents[3] / "data" / "vehicles" / "husky_like.toml"


@pytest.fixture(scope="module")
def husky():
    return read_contact_vehicle(HUSKY)


@pytest.fixture(scope="module")
def spiral():
    speeds = outward_spiral(12.0, STEP_S, width_m=1.03, speed_m_s=0.8, radii_m=(1.2, 8.0))
    return Course(speeds, Plane())


def test_terrains_follow_each_other_in_the_truth_alone(husky, spiral, rng):
    run = terrain_experiment(
        husky, [("crushed_concrete", 4), ("grass", 4), ("asphalt", 4)], spiral, rng
    )
    names, counts = np.unique(run.truth["terrain"], return_counts=True)
    assert dict(zip(names, counts, strict=True)) == {
        "asphalt": 201,
        "crushed_concrete": 200,
        "grass": 200,
    }
    assert run.truth["terrain"][[0, 200, 400]].tolist() == ["crushed_concrete", "grass", "asphalt"]
    assert run.terrain is None
    assert "terrain" not in run.odometry
    made = run.settings["simulation"]["traction"]
    assert [(piece["name"], piece["from_s"]) for piece in made] == [
        ("crushed_concrete", 0.0),
        ("grass", 4.0),
        ("asphalt", 8.0),
    ]
    yaw, stamps = np.unwrap(run.truth["yaw"]), run.truth.stamps_s
    gain = np.gradient(yaw, stamps) * 0.55 / np.diff(spiral.tread_speeds_m_s)[:, 0].clip(1e-6)
    means = [gain[rows].mean() for rows in (slice(125, 195), slice(300, 395), slice(475, 540))]
    assert means[0] > means[1] + 0.05 > means[2] + 0.07


def test_wheels_slip_when_their_time_comes(husky, spiral, rng):
    right = ("front_right", "rear_right")
    run = wheel_experiment(
        husky, [(right, 5.0), (("front_left", *right, "rear_left"), 7.0)], spiral, rng
    )
    names = run.truth["terrain"]
    assert names[[0, 249, 250, -1]].tolist() == ["front_right-rear_right"] * 2 + ["all"] * 2
    made = run.settings["simulation"]["traction"]
    assert made[0]["friction"] == [[0.6, 0.6], [0.3, 0.3]]
    assert made[1]["friction"] == [[0.3, 0.3], [0.3, 0.3]]


def test_the_sensors_are_those_of_the_issue(husky, spiral):
    drive = drives_on(husky, [wheel_traction(husky, [])], spiral)[0]
    runs = [
        contact_run("r", drive, SENSORS, np.random.default_rng(i), terrain=None) for i in range(8)
    ]
    gyro = np.concatenate([run.odometry["gyro_z"] - drive.twists_body[:, 2] for run in runs])
    poses = np.concatenate([run.pose.stack("x", "y") - drive.poses_world[::5, :2] for run in runs])
    turned = np.concatenate([run.pose["yaw"] - drive.poses_world[::5, 5] for run in runs])
    assert gyro.std() == pytest.approx(0.02, rel=0.05)
    assert poses.std() == pytest.approx(0.02, rel=0.05)
    assert np.angle(np.exp(1j * turned)).std() == pytest.approx(np.deg2rad(0.5), rel=0.08)
    np.testing.assert_allclose(np.diff(runs[0].pose.stamps_s), 0.1)


def test_a_run_in_memory_is_the_run_of_the_folder(husky, spiral, tmp_path):
    drive = simulate_contact(
        husky, spiral.tread_speeds_m_s, STEP_S, traction=[wheel_traction(husky, ["rear_left"])]
    )
    memory = contact_run("run", drive, SENSORS, np.random.default_rng(3), terrain="mud")
    write_contact_run(tmp_path / "run", drive, SENSORS, np.random.default_rng(3), terrain="mud")
    read = Run.read(tmp_path / "run")
    assert (memory.robot, memory.terrain, memory.name) == (read.robot, read.terrain, read.name)
    assert memory.settings == read.settings
    for kind in ("odometry", "pose", "truth"):
        ours, theirs = getattr(memory, kind), getattr(read, kind)
        assert list(ours.columns) == list(theirs.columns)
        np.testing.assert_array_equal(ours.lines, theirs.lines)
        for name in ours.columns:
            if name == "terrain":
                assert ours[name].tolist() == theirs[name].tolist() == ["rear_left"] * len(ours)
            else:
                np.testing.assert_allclose(ours[name], theirs[name], atol=1e-9)


@pytest.mark.slow
def test_calibration_runs_know_their_mode_and_drive_as_alone(husky, rng):
    courses = calibration_courses(husky, 0.8, duration_s=12.0)
    modes = [
        ground_traction(husky, "grass"),
        wheel_traction(husky, ["front_left"]),
        wheel_traction(husky, []),
    ]
    runs = calibration_runs(husky, modes, courses, rng)
    assert list(runs) == ["grass", "front_left", "none"]
    for mode in modes:
        assert [run.terrain for run in runs[mode.name]] == [mode.name] * 3
        for run, course in zip(runs[mode.name], courses, strict=True):
            alone = simulate_contact(husky, course.tread_speeds_m_s, STEP_S, traction=[mode])
            np.testing.assert_allclose(
                run.truth.stack("x", "y", "yaw"), alone.poses_world[:, [0, 1, 5]], atol=1e-7
            )
            assert set(run.truth["terrain"]) == {mode.name}
