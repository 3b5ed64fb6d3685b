"""Motion against Newton's and Euler's laws, energy, and closed forms."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.dynamics import VELOCITY, YAW_RATE, ContactDynamics
from odometry.simulation.contact.slope import Plane, Zones, gravity

G = 9.80665
LAWS = ("coulomb", "shear")
SYMMETRIC = {"x_cm": 0.0, "y_cm": 0.0, "places": [-0.4, 0.4]}


def held(left, right, duration_s, step_s=0.02):
    return np.tile([left, right], (round(duration_s / step_s) + 1, 1)).astype(float)


def rotations(drive):
    return Rotation.from_euler("ZYX", drive.poses_world[:, [5, 4, 3]])


def test_momentum_changes_by_the_contact_forces_and_gravity(make_vehicle):
    """Second differences of the path in space, against Coulomb forces from the motion itself."""
    vehicle = make_vehicle(height=0.0, rounding=0.02)
    step, speeds = 1e-3, held(0.3, 0.9, 0.8, 1e-3)
    drive = simulate_contact(vehicle, speeds, step, ground=Plane(0.15, 0.4), longest_step_s=step)
    turn = rotations(drive)
    arms = np.column_stack([vehicle.places_m.real, vehicle.places_m.imag, np.zeros(6)])
    centre = np.array([0.05, -0.03, 0.0])
    inner = slice(1, -1)
    places = drive.poses_world[:, None, :3] + np.stack([turn.apply(arm) for arm in arms], axis=1)
    over_ground = (places[2:] - places[:-2]) / (2 * step)
    forward = turn[inner].apply([1, 0, 0])
    treads = np.repeat([0.3, 0.9], 3)
    slips = over_ground - treads[None, :, None] * forward[:, None]
    normal = turn.apply([0, 0, 1])[0]
    balance = np.column_stack([np.ones(6), arms[:, :2]])
    weight = 120 * G * np.cos(0.15)
    loads = balance @ np.linalg.solve(balance.T @ balance, weight * np.array([1, *centre[:2]]))
    size = np.sqrt((slips**2).sum(axis=-1) + 0.02**2)
    forces = -0.6 * loads[:, None] * slips / size[..., None]
    mass_centre = drive.poses_world[:, :3] + turn.apply(centre)
    acceleration = (mass_centre[2:] - 2 * mass_centre[1:-1] + mass_centre[:-2]) / step**2
    pushed = forces.sum(axis=1) + np.array([0, 0, -120 * G]) + weight * normal
    np.testing.assert_allclose(120 * acceleration, pushed, atol=1.5)
    assert np.abs(pushed).max() > 100
    omega = drive.twists_body[:, 2]
    moment = np.cross(places[inner] - mass_centre[inner, None], forces).sum(axis=1) @ normal
    np.testing.assert_allclose(15 * (omega[2:] - omega[:-2]) / (2 * step), moment, atol=1.5)
    assert np.abs(moment).max() > 50


def test_the_body_turns_at_omega_about_its_own_z_while_the_ground_bends(make_vehicle):
    """Body rates from the rotations themselves; the ground's bending adds pitching and rolling."""
    ground = Zones((0.0, 0.3), (0.3,), uphill_rad=0.5, crease_m=0.4)
    vehicle = make_vehicle("shear")
    drive = simulate_contact(vehicle, held(0.5, 0.9, 2.0, 2e-3), 2e-3, ground=ground)
    turn = rotations(drive)
    rates = (turn[:-2].inv() * turn[2:]).as_rotvec() / 4e-3
    simpson = np.array([[1.0], [4.0], [1.0]]) / 6
    twists = np.stack([drive.twists_body[i : len(turn) - 2 + i] for i in range(3)], axis=1)
    means = (twists * simpson).sum(axis=1)
    np.testing.assert_allclose(rates[:, 2], means[:, 2], atol=2e-4)
    assert np.abs(rates[:, :2]).max() > 0.1
    body = turn[1:-1].inv().apply((drive.poses_world[2:, :3] - drive.poses_world[:-2, :3]) / 4e-3)
    np.testing.assert_allclose(body[:, :2], means[:, :2], atol=1e-4)
    np.testing.assert_allclose(body[:, 2], 0.0, atol=1e-4)


@pytest.mark.parametrize("law", LAWS)
def test_a_block_slides_down_a_slope_steeper_than_friction(make_vehicle, law):
    """g (sin b - mu cos b); the shear law has 1 - exp(-5) of its friction."""
    slope, share = np.deg2rad(40), {"coulomb": 1.0, "shear": 1 - np.exp(-5)}[law]
    vehicle = make_vehicle(law, **SYMMETRIC, friction=0.4)
    drive = simulate_contact(
        vehicle, held(0, 0, 2.0), 0.02, ground=Plane(slope, np.pi / 2), start_poses=(0, 0, 0.7)
    )
    expected = G * (np.sin(slope) - 0.4 * share * np.cos(slope))
    speed = np.hypot(*drive.twists_body[:, :2].T)
    np.testing.assert_allclose(np.diff(speed[60:]) / 0.02, expected, rtol=1e-4)
    np.testing.assert_allclose(drive.twists_body[:, 2], 0.0, atol=1e-9)
    assert drive.poses_world[-1, 2] < -3.0
    np.testing.assert_allclose(drive.poses_world[-1, 0], 0.0, atol=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_equal_treads_roll_without_loss(make_vehicle, law):
    drive = simulate_contact(make_vehicle(law), held(0.8, 0.8, 8.0), 0.02)
    np.testing.assert_allclose(drive.twists_body[-1], [0.8, 0.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(drive.accelerations_m_s2[-1], 0.0, atol=1e-5)


def test_straight_driving_across_a_slope_drifts_downhill(make_vehicle):
    """By more where the tyres shear; the closed forms are with the steady states."""
    drifts = {}
    for law in LAWS:
        drive = simulate_contact(
            make_vehicle(law, **SYMMETRIC), held(0.5, 0.5, 6.0), 0.02, ground=Plane(0.1, np.pi / 2)
        )
        x, drifts[law] = drive.poses_world[-1, :2]
        assert x == pytest.approx(3.0, abs=0.1)
    assert -0.1 < drifts["shear"] < -0.05 < drifts["coulomb"] < 0.0


def test_a_vehicle_stands_on_a_slope_by_shear(make_vehicle):
    drive = simulate_contact(make_vehicle("shear"), held(0, 0, 6.0), 0.02, ground=Plane(0.2, 1.0))
    np.testing.assert_allclose(drive.twists_body[-1], 0.0, atol=1e-6)
    assert 0.001 < np.hypot(*drive.poses_world[-1, :2]) < 0.02


def test_kinetic_energy_only_falls_while_locked_treads_skid(make_vehicle):
    """Coulomb friction; bristles would give some energy back at the end."""
    vehicle = make_vehicle()
    speeds = np.concatenate([held(1.0, 1.8, 3.0), held(0.0, 0.0, 2.0)])
    drive = simulate_contact(vehicle, speeds, 0.02)
    v_x, v_y, omega = drive.twists_body[152:].T
    energy = 60 * ((v_x + 0.03 * omega) ** 2 + (v_y + 0.05 * omega) ** 2) + 7.5 * omega**2
    skidding = energy > 0.05
    assert energy[0] > 80
    assert (np.diff(energy)[skidding[1:]] < 0).all()
    assert energy[-1] < 1e-5


def test_coulomb_forces_take_energy_at_every_contact(make_vehicle, rng):
    dynamics = ContactDynamics(make_vehicle(), Plane(0.1, 0.3))
    state = dynamics.start(np.zeros(200, complex), rng.uniform(-3, 3, 200))
    state[:, 2:5] += rng.normal(size=(200, 3)) * [0.5, 0.5, 50] + 0.5j * rng.normal(size=(200, 3))
    state[:, 3] = state[:, 3].real
    contacts = dynamics.contacts(state, rng.normal(size=(200, 2)), gravity(dynamics.tilt(state))[1])
    power = (contacts.forces_n.conj() * contacts.slips_m_s).real
    assert (power <= 0).all()
    np.testing.assert_allclose(
        np.abs(contacts.forces_n),
        0.6
        * contacts.loads_n
        * np.abs(contacts.slips_m_s)
        / np.hypot(np.abs(contacts.slips_m_s), 0.005),
        atol=1e-9,
    )


def test_work_of_the_treads_becomes_height_speed_and_heat(make_vehicle):
    """Energy of a climb with turns, Coulomb, from the forces at the recorded motion."""
    vehicle, step, ground = make_vehicle(height=0.0), 2e-3, Plane(0.1, 0.3)
    drive = simulate_contact(vehicle, held(0.5, 0.7, 3.0, step), step, ground=ground)
    dynamics = ContactDynamics(vehicle, ground)
    x, y, z, _, _, yaw = drive.poses_world.T
    state = dynamics.start(x + 1j * y, yaw)
    v_x, v_y, omega = drive.twists_body.T
    state[:, VELOCITY] = v_x + 1j * v_y + 1j * omega * (0.05 - 0.03j)
    state[:, YAW_RATE] = omega
    treads = np.tile([0.5, 0.7], (len(x), 1))
    contacts = dynamics.contacts(state, treads, gravity(dynamics.tilt(state))[1])
    heat = -(contacts.forces_n.conj() * contacts.slips_m_s).real.sum(axis=1)
    work = (contacts.forces_n.real * np.repeat(treads, 3, axis=1)).sum(axis=1)
    kinetic = 60 * np.abs(state[:, VELOCITY]) ** 2 + 7.5 * omega**2
    potential = 120 * G * (z + rotations(drive).apply([0.05, -0.03, 0.0])[:, 2])
    gain = (kinetic + potential)[-1] - (kinetic + potential)[500]
    assert gain > 100
    assert np.trapezoid((work - heat)[500:], dx=step) == pytest.approx(gain, rel=1e-4)
