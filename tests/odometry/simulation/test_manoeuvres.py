"""Manoeuvres of given curvature: radius, curvature by the way, growth of the radius, rest."""

import numpy as np
import pytest

from odometry.errors import SimulationError
from odometry.simulation.manoeuvres import clothoid, outward_spiral, sinusoid, skidpad

STEP, WIDTH = 0.02, 1.1
PROGRAMMES = {
    "skidpad": skidpad(60.0, STEP, width_m=WIDTH, radius_m=1.5, speeds_m_s=(0.4, 0.8)),
    "clothoid": clothoid(50.0, STEP, width_m=WIDTH, speed_m_s=0.7, smallest_radius_m=1.4),
    "sinusoid": sinusoid(40.0, STEP, speed_m_s=0.6, difference_m_s=0.7, period_s=6.0),
    "spiral": outward_spiral(40.0, STEP, width_m=WIDTH, speed_m_s=0.8, radii_m=(1.0, 21.0)),
}


def curvature(speeds):
    """By kinematics: (right - left) / width by their mean, where they move."""
    mean = speeds.mean(axis=1)
    moving = mean > 0.01
    return np.where(moving, np.diff(speeds)[:, 0] / WIDTH / np.where(moving, mean, 1), np.nan)


@pytest.mark.parametrize("name", PROGRAMMES)
def test_manoeuvres_start_and_end_at_rest_and_do_not_jump(name):
    speeds = PROGRAMMES[name]
    np.testing.assert_allclose(speeds[[0, -1]], 0.0, atol=1e-12)
    assert np.abs(np.diff(speeds, axis=0)).max() <= 1.001 * STEP
    assert np.abs(speeds).max() > 0.5


def test_a_skidpad_has_one_radius_at_every_speed_from_rest_to_rest():
    speeds = PROGRAMMES["skidpad"]
    turned, mean = curvature(speeds) * 1.5, speeds.mean(axis=1)
    for number, (speed, side) in enumerate(((0.4, 1), (0.4, -1), (0.8, 1), (0.8, -1))):
        rows = slice(round(15 * number / STEP), round(15 * (number + 1) / STEP))
        np.testing.assert_allclose(mean[rows][[0, -1]], 0.0, atol=0.02)
        np.testing.assert_allclose(turned[rows][mean[rows] > 0.02], side)
        assert (np.abs(mean[rows] - speed) < 1e-9).mean() > 0.8


def test_a_skidpad_too_short_for_its_speeds_is_refused():
    """0.8 (1 + 1.1 / 3) m/s at 1 m/s2, twice, four times over."""
    settings = {"width_m": WIDTH, "radius_m": 1.5, "speeds_m_s": (0.4, 0.8)}
    with pytest.raises(SimulationError, match=r"skidpad of 8 s: expected 8\.75 s or more for 4"):
        skidpad(8.0, STEP, **settings)
    assert len(skidpad(8.75, STEP, **settings)) > 400


def test_the_curvature_of_a_clothoid_is_linear_in_the_way():
    speeds = PROGRAMMES["clothoid"]
    mean = speeds.mean(axis=1)
    way = np.concatenate([[0.0], np.cumsum(mean[1:] + mean[:-1]) * STEP / 2])
    turned = curvature(speeds)
    ramp = 0.7**2 / 2  # straight, at 1 m/s2
    quarter = (way[-1] - 2 * ramp) / 4
    np.testing.assert_allclose(turned[(mean > 0.01) & (way < ramp)], 0.0, atol=1e-12)
    for number, slope in enumerate((1, -1, -1, 1)):
        start = ramp + number * quarter
        rows = (way > start + 0.1) & (way < start + quarter - 0.1)
        rate = np.polyfit(way[rows], turned[rows], 1)
        assert rate[0] == pytest.approx(slope / 1.4 / quarter, rel=1e-6)
        np.testing.assert_allclose(np.polyval(rate, way[rows]), turned[rows], atol=1e-9)
    assert np.nanmax(turned) == pytest.approx(1 / 1.4, rel=1e-2)
    assert np.nanmin(turned) == pytest.approx(-1 / 1.4, rel=1e-2)


def test_a_sinusoid_is_one_sine_at_a_steady_speed():
    speeds = PROGRAMMES["sinusoid"]
    stamps = np.arange(len(speeds)) * STEP
    assert stamps[-1] == pytest.approx(37.2)  # six periods, and two ramps of 0.6 s
    steady = slice(31, 1830)
    np.testing.assert_allclose(speeds[steady].mean(axis=1), 0.6)
    expected = 0.7 * np.sin(2 * np.pi * (stamps[steady] - 0.6) / 6.0)
    np.testing.assert_allclose(np.diff(speeds[steady])[:, 0], expected, atol=1e-12)
    np.testing.assert_allclose(np.diff(speeds)[[*range(30), -2]], 0.0, atol=1e-12)


@pytest.mark.parametrize("side", [1, -1])
def test_the_radius_of_a_spiral_grows_at_a_constant_rate(side):
    speeds = outward_spiral(
        40.0, STEP, width_m=WIDTH, speed_m_s=0.8, radii_m=(1.0, 21.0), side=side
    )
    radius = side / curvature(speeds)[5:-5]
    np.testing.assert_allclose(np.diff(radius) / STEP, 0.5, rtol=1e-6)
    assert radius[0] == pytest.approx(1.05)
    mirrored = PROGRAMMES["spiral"][:, ::side]
    np.testing.assert_allclose(speeds, mirrored)


def test_what_needs_more_than_the_acceleration_is_refused():
    with pytest.raises(SimulationError, match="1 s are too short for two ramps"):
        clothoid(1.0, STEP, width_m=WIDTH, speed_m_s=0.7, smallest_radius_m=1.4)
    with pytest.raises(SimulationError, match=r"the treads change by 3\.1\d m/s2"):
        sinusoid(20.0, STEP, speed_m_s=0.6, difference_m_s=1.0, period_s=1.0)
