"""Attitude on slopes against SciPy's rotations and finite differences."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from odometry.simulation.contact.slope import HeldAttitude, Plane, Zones, gravity, tilt

ZONES = Zones((0.05, 0.2, -0.1), (-0.4, 1.0), uphill_rad=0.7, crease_m=0.4)
GROUNDS = [Plane(0.3, 2.0), ZONES]
POINTS = np.array([0.3 - 0.2j, -1.1 + 0.4j, 2.0 + 3.0j, 0.9 + 0.6j])
YAWS = np.array([0.4, -2.0, 3.0, 1.0])


def attitude(ground, points=POINTS, yaws=YAWS):
    held = tilt(ground.rise(points, np.exp(1j * yaws)))
    roll = np.arctan2(held.sin_roll, held.cos_roll)
    pitch = np.arctan2(held.sin_pitch, held.cos_pitch)
    return held, Rotation.from_euler("ZYX", np.column_stack([yaws, pitch, roll]))


def numeric_gradient(ground, points, step=1e-5):
    along_x = (ground.heights_m(points + step) - ground.heights_m(points - step)) / (2 * step)
    along_y = (ground.heights_m(points + step * 1j) - ground.heights_m(points - step * 1j)) / (
        2 * step
    )
    return along_x + 1j * along_y


@pytest.mark.parametrize("ground", GROUNDS)
def test_the_body_lies_flat_on_the_ground(ground):
    """z of Rz(yaw) Ry(pitch) Rx(roll) is the normal of the height's finite differences."""
    gradient = numeric_gradient(ground, POINTS)
    normal = np.column_stack([-gradient.real, -gradient.imag, np.ones(4)])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    _, rotation = attitude(ground)
    np.testing.assert_allclose(rotation.apply([0, 0, 1]), normal, atol=1e-9)


@pytest.mark.parametrize("ground", GROUNDS)
def test_gravity_is_turned_into_the_body(ground):
    held, rotation = attitude(ground)
    in_plane, into = gravity(held)
    expected = rotation.inv().apply([0, 0, -9.80665])
    np.testing.assert_allclose(in_plane, expected[:, 0] + 1j * expected[:, 1], atol=1e-9)
    np.testing.assert_allclose(into, -expected[:, 2], atol=1e-9)


@pytest.mark.parametrize(
    ("yaw", "roll", "pitch"),
    [(0.0, 0.0, -0.2), (np.pi, 0.0, 0.2), (np.pi / 2, -0.2, 0.0), (-np.pi / 2, 0.2, 0.0)],
)
def test_signs_of_the_conventions(yaw, roll, pitch):
    """Uphill along x: facing it the nose is up; with it to the right the left side is down."""
    held, _ = attitude(Plane(0.2, 0.0), np.zeros(1, complex), np.array([yaw]))
    np.testing.assert_allclose(
        [held.sin_roll[0], held.sin_pitch[0]], np.sin([roll, pitch]), atol=1e-12
    )


@pytest.mark.parametrize("ground", GROUNDS)
def test_rise_and_its_rate_are_derivatives_of_the_height(ground):
    np.testing.assert_allclose(
        ground.rise(POINTS, np.ones(4, complex)), numeric_gradient(ground, POINTS), atol=1e-8
    )
    heading = np.exp(1j * YAWS)
    np.testing.assert_allclose(
        ground.rise(POINTS, heading).real,
        (ground.heights_m(POINTS + 1e-5 * heading) - ground.heights_m(POINTS - 1e-5 * heading))
        / 2e-5,
        atol=1e-8,
    )
    velocity, step, east = 0.3 - 0.8j, 1e-5, np.ones(4, complex)
    ahead, behind = (ground.rise(POINTS + sign * step * velocity, east) for sign in (1, -1))
    np.testing.assert_allclose(
        ground.rise_rate(POINTS, np.full(4, velocity)), (ahead - behind) / (2 * step), atol=1e-8
    )


def test_zones_have_their_slopes_away_from_the_creases():
    ground = Zones((0.05, 0.2, -0.1), (0.0, 20.0), uphill_rad=0.7, crease_m=0.4)
    along = np.exp(0.7j) * np.array([-9.0, 10.0, 400.0])
    rise = ground.rise(along, np.full(3, np.exp(0.7j)))
    np.testing.assert_allclose(np.arctan(rise.real), ground.slopes_rad, atol=1e-9)
    np.testing.assert_allclose(rise.imag, 0.0, atol=1e-12)


def test_a_held_attitude_is_the_one_requested():
    roll, pitch = np.array([0.1, -0.2]), np.array([-0.3, 0.05])
    held, _ = attitude(HeldAttitude(roll, pitch), POINTS[:2], YAWS[:2])
    np.testing.assert_allclose(held.sin_roll, np.sin(roll), atol=1e-12)
    np.testing.assert_allclose(held.sin_pitch, np.sin(pitch), atol=1e-12)


@pytest.mark.parametrize("edges", [(1.0,), (2.0, 1.0)])
def test_edges_that_do_not_fit(edges):
    with pytest.raises(ValueError, match="3 zones need 2 increasing edges"):
        Zones((0.0, 0.1, 0.2), edges)
