"""Run folders of simulated drives: round trip, noise, bytes."""

from pathlib import Path

import numpy as np
import pytest

from odometry.errors import SimulationError
from odometry.recording.run import Run
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.slope import Plane, Zones
from odometry.simulation.contact.vehicle import read_contact_vehicle
from odometry.simulation.record import ContactSensors, write_contact_run

J8 = Path(__file__).parents[3] / "data" / "vehicles" / "j8.toml"
SILENT = ContactSensors(10.0, *[0.0] * 7)


@pytest.fixture(scope="module")
def drive():
    """40 s of a bend on a slope, from a yaw near pi."""
    speeds = np.tile([0.3, 0.6], (2001, 1))
    return simulate_contact(
        read_contact_vehicle(J8), speeds, 0.02, ground=Plane(0.08, 0.9), start_poses=(1, 2, 3.0)
    )


def write(folder, drive, sensors, seed=5, **settings):
    rng = np.random.default_rng(seed)
    return write_contact_run(folder, drive, sensors, rng, terrain="concrete", settings=settings)


def test_without_noise_the_truth_comes_back(tmp_path, drive):
    run = Run.read(write(tmp_path / "run", drive, SILENT, seed_of_all=7))
    assert run.robot.track_width == 1.2
    assert run.robot.mass == 1090.0
    assert run.terrain == "concrete"
    assert run.settings["simulation"]["seed_of_all"] == 7
    assert run.settings["simulation"]["ground"] == {
        "kind": "Plane",
        "slope_rad": 0.08,
        "uphill_rad": 0.9,
    }
    assert run.settings["simulation"]["vehicle"]["law"]["kind"] == "Shear"
    odometry = run.odometry
    np.testing.assert_allclose(odometry.stamps_s, drive.stamps_s)
    np.testing.assert_allclose(odometry.stack("v_left", "v_right"), drive.tread_speeds_m_s)
    np.testing.assert_allclose(
        odometry.stack("roll", "pitch"), drive.poses_world[:, 3:5], atol=1e-9
    )
    np.testing.assert_allclose(odometry["gyro_z"], drive.twists_body[:, 2], atol=1e-9)
    np.testing.assert_allclose(
        odometry.stack("accel_x", "accel_y"), drive.accelerations_m_s2, atol=1e-9
    )
    rows = drive.poses_world[::5]
    np.testing.assert_allclose(run.pose.stack("x", "y", "z"), rows[:, :3], atol=1e-9)
    turned = run.pose["yaw"] - rows[:, 5]
    np.testing.assert_allclose(np.exp(1j * turned), 1.0, atol=1e-8)
    assert np.abs(run.pose["yaw"]).max() <= np.pi
    np.testing.assert_allclose(
        run.truth.stack("x", "y", "yaw"), drive.poses_world[:, [0, 1, 5]], atol=1e-9
    )


def test_noise_has_its_sigma_in_every_column(tmp_path, drive):
    sensors = ContactSensors(50.0, 0.02, 0.03, 0.005, 0.004, 0.006, 0.007, 0.08)
    run = Run.read(write(tmp_path / "run", drive, sensors))
    truth = {
        "v_left": drive.tread_speeds_m_s[:, 0],
        "v_right": drive.tread_speeds_m_s[:, 1],
        "roll": drive.poses_world[:, 3],
        "pitch": drive.poses_world[:, 4],
        "gyro_z": drive.twists_body[:, 2],
        "accel_x": drive.accelerations_m_s2[:, 0],
        "accel_y": drive.accelerations_m_s2[:, 1],
    }
    errors = {name: run.odometry[name] - values for name, values in truth.items()}
    errors |= {name: run.pose[name] - drive.poses_world[:, i] for i, name in enumerate("xyz")}
    errors["yaw"] = np.angle(np.exp(1j * (run.pose["yaw"] - drive.poses_world[:, 5])))
    sigmas = [0.004] * 2 + [0.006] * 2 + [0.007] + [0.08] * 2 + [0.02] * 2 + [0.03, 0.005]
    for (name, error), sigma in zip(errors.items(), sigmas, strict=True):
        assert error.std() == pytest.approx(sigma, rel=0.06), name
        assert abs(error.mean()) < 4 * sigma / np.sqrt(len(error)), name
    spread = np.corrcoef(np.array(list(errors.values())))
    assert np.abs(spread - np.eye(11)).max() < 0.1


def test_the_same_seed_gives_the_same_bytes(tmp_path, drive):
    names = ("run.toml", "odometry.csv", "pose.csv", "truth.csv")
    one, same, other = (
        [
            (write(tmp_path / name, drive, ContactSensors(), seed) / file).read_bytes()
            for file in names
        ]
        for name, seed in (("one", 5), ("same", 5), ("other", 6))
    )
    assert one == same
    assert [a == b for a, b in zip(one, other, strict=True)] == [True, False, False, True]


def test_zones_are_written(tmp_path, drive):
    zones = Zones((0.1, 0.2), (1.0,))
    short = simulate_contact(drive.vehicle, drive.tread_speeds_m_s[:20], 0.02, ground=zones)
    ground = Run.read(write(tmp_path / "run", short, SILENT)).settings["simulation"]["ground"]
    assert ground["slopes_rad"] == [0.1, 0.2]


def test_poses_must_fall_on_stamps(tmp_path, drive):
    with pytest.raises(SimulationError, match="30 Hz do not fall on stamps"):
        write(tmp_path / "run", drive, ContactSensors(pose_rate_hz=30.0))


def test_a_stack_is_refused(tmp_path, drive):
    stack = simulate_contact(drive.vehicle, np.zeros((2, 3, 2)), 0.02)
    with pytest.raises(SimulationError, match="one drive is a run"):
        write(tmp_path / "run", stack, SILENT)
