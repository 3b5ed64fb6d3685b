"""Courses that suit a vehicle: eights close, tours cross zones."""

from pathlib import Path

import numpy as np
import pytest

from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.slope import Plane
from odometry.simulation.contact.vehicle import read_contact_vehicle
from odometry.simulation.courses import COURSE_NAMES, STEP_S, make_course, slope_paths, turn_rate

VEHICLES = Path(__file__).parents[3] / "data" / "vehicles"


@pytest.fixture(scope="module")
def j8():
    return read_contact_vehicle(VEHICLES / "j8.toml")


@pytest.fixture(scope="module")
def husky():
    return read_contact_vehicle(VEHICLES / "husky_like.toml")


def course(name, vehicle, slope=0.0, duration=60.0, uphill=0.0):
    return make_course(
        name,
        vehicle,
        duration_s=duration,
        max_speed_m_s=0.8,
        slope_rad=slope,
        uphill_rad=uphill,
        rng=np.random.default_rng(1),
    )


@pytest.mark.parametrize("name", COURSE_NAMES)
def test_courses_last_about_their_time_within_their_speed(husky, name):
    speeds = course(name, husky).tread_speeds_m_s
    assert 45.0 < len(speeds) * STEP_S < 75.0
    assert 0.4 < np.abs(speeds).max() <= 0.8 + 1e-12


def test_a_figure_eight_closes_on_level_ground(husky):
    """Each loop is a full turn but for its ramps."""
    eight = course("figure_eight", husky, duration=2 * 2 * np.pi / turn_rate(husky, 0.48, 0.64))
    drive = simulate_contact(husky, eight.tread_speeds_m_s, STEP_S)
    yaw = drive.poses_world[:, 5]
    assert yaw.max() == pytest.approx(2 * np.pi, abs=0.6)
    assert yaw[-1] == pytest.approx(0.0, abs=0.4)
    assert np.hypot(*drive.poses_world[-1, :2]) < 0.15 * np.ptp(drive.poses_world[:, 1])


@pytest.mark.parametrize("uphill", [0.0, 2.0])
def test_a_tour_crosses_three_slopes(husky, uphill):
    tour = course("tour", husky, slope=0.06, duration=50.0, uphill=uphill)
    drive = simulate_contact(husky, tour.tread_speeds_m_s, STEP_S, ground=tour.ground)
    points = drive.poses_world[:, 0] + 1j * drive.poses_world[:, 1]
    slopes = np.arctan(np.abs(tour.ground.rise(points, np.ones(len(points), complex))))
    for slope in (0.06, 0.03, 0.09):
        assert (np.abs(slopes - slope) < 0.003).mean() > 0.05


def test_the_three_paths_of_martinez_2024(j8):
    paths = slope_paths(j8)
    assert [round(len(p.tread_speeds_m_s) * STEP_S) for p in paths.values()] == [48, 69, 89]
    spin = paths["spin"]
    assert spin.ground == Plane(np.deg2rad(3.6), np.pi / 2)
    np.testing.assert_allclose(spin.tread_speeds_m_s[1000], [0.3, -0.3])
    drive = simulate_contact(j8, spin.tread_speeds_m_s, STEP_S, ground=spin.ground)
    assert drive.poses_world[-1, 5] < -2 * np.pi  # clockwise
    assert drive.poses_world[-1, 1] < -0.5  # slides downhill
