"""Drives: one or many, what they record, and what they refuse."""

import numpy as np
import pytest

from odometry.errors import SimulationError
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.slope import Plane, Zones
from odometry.simulation.contact.traction import Traction

G = 9.80665


@pytest.fixture
def speeds(rng):
    """Six drives of 3 s, in a stack (2, 3)."""
    ramp = np.minimum(np.arange(151) / 50, 1.0)
    return rng.uniform(-1, 1, (2, 3, 1, 2)) * ramp[:, None]


@pytest.mark.parametrize("law", ["coulomb", "shear"])
def test_a_stack_gives_what_its_drives_give_alone(make_vehicle, speeds, rng, law):
    vehicle, ground = make_vehicle(law), Plane(0.1, 0.5)
    starts = rng.normal(size=(2, 3, 3))
    stack = simulate_contact(vehicle, speeds, 0.02, ground=ground, start_poses=starts)
    assert stack.poses_world.shape == (2, 3, 151, 6)
    for index in np.ndindex(2, 3):
        alone = simulate_contact(
            vehicle, speeds[index], 0.02, ground=ground, start_poses=starts[index]
        )
        one = stack[index]
        assert one.poses_world.shape == (151, 6)
        np.testing.assert_allclose(one.poses_world, alone.poses_world, atol=1e-9)
        np.testing.assert_allclose(one.twists_body, alone.twists_body, atol=1e-9)
        np.testing.assert_allclose(one.accelerations_m_s2, alone.accelerations_m_s2, atol=1e-6)
        np.testing.assert_array_equal(one.tread_speeds_m_s, speeds[index])
        np.testing.assert_allclose(one.poses_world[0, [0, 1, 5]], starts[index])


def test_poses_follow_the_twists(make_vehicle):
    """On level ground: the rate of the pose, by finite differences, is the turned twist."""
    ramp = np.minimum(np.arange(1001) / 500, 1.0)[:, None] * [0.3, 0.8]
    drive = simulate_contact(make_vehicle(), ramp, 0.002)
    x, y, z, roll, pitch, yaw = drive.poses_world.T
    heading = np.exp(1j * yaw)
    rate = (x + 1j * y)[2:] - (x + 1j * y)[:-2]
    body = drive.twists_body[1:-1, 0] + 1j * drive.twists_body[1:-1, 1]
    np.testing.assert_allclose((rate / 0.004)[20:], (heading[1:-1] * body)[20:], atol=2e-4)
    np.testing.assert_allclose((yaw[2:] - yaw[:-2]) / 0.004, drive.twists_body[1:-1, 2], atol=5e-4)
    assert not np.any([z, roll, pitch])


def test_at_rest_the_accelerometer_feels_gravity(make_vehicle):
    """data/README.md: accel_x = -g sin(pitch), accel_y = +g cos(pitch) sin(roll)."""
    drive = simulate_contact(
        make_vehicle("shear"),
        np.zeros((200, 2)),
        0.02,
        ground=Plane(0.15, 0.0),
        start_poses=(0, 0, 0.7),
    )
    roll, pitch = drive.poses_world[:, 3], drive.poses_world[:, 4]
    assert roll[0] < -0.09  # uphill to the right: its side is up, the left one down
    assert pitch[0] < -0.1
    felt = np.stack([-G * np.sin(pitch), G * np.cos(pitch) * np.sin(roll)], axis=-1)
    np.testing.assert_allclose(drive.accelerations_m_s2[[0, -1]], felt[[0, -1]], atol=1e-3)


def test_in_a_turn_the_accelerometer_feels_the_centripetal_push(make_vehicle):
    held = np.tile([0.4, 1.0], (400, 1))
    drive = simulate_contact(make_vehicle(), held, 0.02)
    v_x, v_y, omega = drive.twists_body[-1]
    np.testing.assert_allclose(drive.accelerations_m_s2[-1], [-omega * v_y, omega * v_x], atol=1e-4)
    assert omega * v_x > 0.2


def test_accelerations_add_up_to_the_change_of_speed(make_vehicle):
    """Straight ahead on level ground, through the skids of the start."""
    drive = simulate_contact(make_vehicle(x_cm=0.0, y_cm=0.0), np.tile([0.7, 0.7], (50, 1)), 0.02)
    gained = 0.02 * drive.accelerations_m_s2[1:, 0].cumsum()
    np.testing.assert_allclose(gained, drive.twists_body[1:, 0], atol=1e-9)


def test_the_robot_stays_on_the_ground(make_vehicle):
    ground = Zones((0.0, 0.2, 0.05), (0.5, 1.5), uphill_rad=0.3)
    drive = simulate_contact(make_vehicle(), np.tile([0.6, 0.6], (250, 1)), 0.02, ground=ground)
    points = drive.poses_world[:, 0] + 1j * drive.poses_world[:, 1]
    np.testing.assert_allclose(drive.poses_world[:, 2], ground.heights_m(points), atol=1e-12)
    assert np.ptp(drive.poses_world[:, 4]) > 0.1


@pytest.mark.parametrize("wrong", [np.zeros(4), np.zeros((4, 3)), np.full((4, 2), np.nan)])
def test_wrong_speeds_are_named(make_vehicle, wrong):
    with pytest.raises(SimulationError, match=r"expected \(\.\.\., N, 2\)"):
        simulate_contact(make_vehicle(), wrong, 0.02)


def test_a_vehicle_too_high_for_its_slope_tips_over(make_vehicle):
    with pytest.raises(SimulationError, match="tips over"):
        simulate_contact(
            make_vehicle(height=1.5, friction=1.5), np.zeros((9, 2)), 0.02, ground=Plane(0.5, 1.5)
        )


def test_accelerations_are_means_since_the_stamp_before(make_vehicle):
    """Of 20 ms against those of 1 ms, in a turn on a slope that still speeds up."""
    ramp = np.linspace(0, 1, 101)[:, None] * [0.3, 1.2]
    vehicle, ground = make_vehicle("shear"), Plane(0.2, 0.4)
    coarse = simulate_contact(vehicle, ramp, 0.02, ground=ground, longest_step_s=1e-3)
    fine = simulate_contact(vehicle, ramp.repeat(20, axis=0), 1e-3, ground=ground)
    means = fine.accelerations_m_s2[1:2001].reshape(100, 20, 2).mean(axis=1)
    np.testing.assert_allclose(coarse.accelerations_m_s2[20:], means[19:], atol=1e-3)
    assert np.ptp(means[19:], axis=0).max() > 0.3


class Bowl:
    """Ground of somebody else: it rises by 0.05 m^-1 times the distance from the origin."""

    def rise(self, points, heading):
        return 0.05 * points * heading.conj()

    def rise_rate(self, points, velocity):  # noqa: ARG002
        return 0.05 * velocity

    def heights_m(self, points):
        return 0.025 * np.abs(points) ** 2


@pytest.mark.parametrize("law", ["coulomb", "shear"])
@pytest.mark.parametrize(
    "ground", [Plane(0.12, 2.0), Zones((0.0, 0.2, -0.1), (0.3, 0.9), 0.4, 0.2), Bowl()]
)
def test_one_drive_in_plain_numbers_is_that_of_a_stack(make_vehicle, speeds, rng, law, ground):
    """One drive alone takes another program; wheels lift off, and the traction changes."""
    vehicle = make_vehicle(law, height=0.5, patch_length=None, track_length=1.2)
    friction, other = rng.uniform(0.3, 0.9, (2, 2, 3)), make_vehicle("shear").law
    traction = [
        Traction("a", 0.0, friction[0], vehicle.law, 0.7),
        Traction("b", 1.5, friction[1], other, 1.3),
    ]
    many = speeds.reshape(6, 151, 2)[:2]
    stack = simulate_contact(vehicle, many, 0.02, ground=ground, traction=traction)
    alone = simulate_contact(vehicle, many[1], 0.02, ground=ground, traction=traction)
    for name in ("poses_world", "twists_body"):
        np.testing.assert_allclose(
            getattr(alone, name), getattr(stack[1], name), rtol=0, atol=1e-11
        )


@pytest.mark.parametrize("speed_m_s", [1e3, 1e308])
def test_a_drive_that_runs_away_says_so_alone_as_in_a_stack(make_vehicle, speed_m_s):
    """What overflows in plain numbers raises other errors than in arrays."""
    speeds = np.full((2, 40, 2), speed_m_s) * [1.0, -0.5]
    said = []
    for of in (speeds, speeds[0]):
        with pytest.raises(SimulationError, match="runs away") as error:
            simulate_contact(make_vehicle("shear"), of, 0.5)
        said.append(str(error.value))
    assert said[0] == said[1]
