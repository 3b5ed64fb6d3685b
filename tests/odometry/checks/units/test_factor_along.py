"""Rates of wheels taken for speeds, where positions alone leave open what the factor is."""

from dataclasses import replace

import pytest

from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import shunting
from tests.odometry.checks.faulty import treads, without_gyroscope, without_yaw

RADIUS_M = 0.165


def said(radius_m, factor):
    run = without_yaw(shunting())
    run = replace(run, robot=replace(run.robot, wheel_radius=radius_m))
    found = check_recording(treads(run, lambda *speeds: tuple(factor * of for of in speeds)))
    (cause,) = (f.cause for f in found.findings if f.name in {"slip", "scale"})
    return cause


@pytest.mark.parametrize("radius_m", [None, RADIUS_M])
def test_rad_per_second_comes_first(radius_m):
    cause = said(radius_m, 1 / RADIUS_M)
    assert cause.startswith("Tread speeds are in rad/s, of wheels of 0.16")
    assert "heavy slip" in cause
    assert "cannot be distinguished" in cause


@pytest.mark.parametrize(("radius_m", "factor"), [(RADIUS_M, 2.5), (0.08, 6.0), (None, 3.2)])
def test_slip_comes_first_where_no_wheel_makes_the_factor(radius_m, factor):
    """On ice real robots moved 0.24 to 0.4 m for each metre."""
    assert said(radius_m, factor).startswith("Heavy slip")


@pytest.mark.parametrize("seed", [1, 3, 8])
def test_a_tread_of_the_wrong_sign_is_among_the_causes(seed):
    run = without_gyroscope(without_yaw(shunting(seed)))
    found = check_recording(treads(run, lambda left, right: (left, -right)))
    (cause,) = (f.cause for f in found.findings if f.name == "slip")
    assert cause.startswith("One tread has the wrong sign (they run against each other on ")
