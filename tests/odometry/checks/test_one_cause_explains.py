"""A cause that explains what others seemed to be is named, and these are not."""

import re

import numpy as np
import pytest

from odometry.checks.confirmed import alone
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.unit_tables import POSITION_UNITS, matching
from odometry.checks.recording import check_recording
from odometry.checks.treads.sides import sides
from odometry.checks.units.factor_along import farther_along, slip_along
from odometry.checks.units.unit_findings import gyroscope_unit
from odometry.checks.units.units import ONE_AXIS_STRETCHED
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import (
    AT_REST_S,
    PERIOD_S,
    drive,
    pausing,
    winding,
)
from tests.odometry.checks.faulty import gyroscope, positions, put, treads, width

AT_S = PERIOD_S * np.arange(4000)


def first(run):
    return check_recording(run).at(Level.WARNING)[0]


def test_poses_that_were_held_until_the_robot_stood_are_no_second_recording():
    run = pausing()
    at_s = run.pose.stamps_s
    rows = np.arange(len(at_s))
    lost = (at_s > 70) & (at_s < AT_REST_S[0] + 5)
    held = np.where(lost, np.flatnonzero(lost)[0], rows)
    columns = {name: run.pose[name][held] for name in ("x", "y", "yaw")}
    assert warnings(put(run, "pose", **columns)) == ["frozen_poses"]


def test_a_sensor_far_from_the_centre_makes_no_scale():
    """To the right of a robot that turns to the left: it is faster all the time."""
    run = drive(0.5 + 0.1 * np.sin(AT_S / 5), 0.35 + 0.15 * np.sin(AT_S / 3.3))
    yaw = run.pose["yaw"]
    far = positions(run, lambda x, y: (x + 2 * np.sin(yaw), y - 2 * np.cos(yaw)))
    assert warnings(far) == ["far_sensor"]


@pytest.mark.parametrize("ahead_m", [-2.4, 1.2])
def test_a_sensor_that_swings_farther_than_the_robot_drives_is_found_where_it_is(ahead_m):
    """The course of a robot that pivots is that of the swing, across its yaw."""
    pivots = np.sin(AT_S / 3) + 0.5 * np.sin(AT_S / 1.3)
    run = drive(0.12 + 0.08 * np.sin(AT_S / 5), 0.5 * pivots, sigma_m=0.005)
    yaw = run.pose["yaw"]
    far = positions(run, lambda x, y: (x + ahead_m * np.cos(yaw), y + ahead_m * np.sin(yaw)))
    (found,) = check_recording(far).at(Level.WARNING)
    assert found.name == "far_sensor"
    ((x, _, _),) = re.findall(r"pose = \[([-.0-9]+), ([-.0-9]+), ([-.0-9]+)\]", found.remedy)
    assert float(x) == pytest.approx(ahead_m, abs=0.1)


def test_a_yaw_rate_whose_unit_explains_all_is_not_unrelated():
    """Turns that are small in rad and slip much are no warning in their own unit."""
    evidence = Evidence(gyroscope(winding(), np.degrees))
    unrelated = Finding("gyroscope_unrelated", Level.WARNING, "seen", "cause", "remedy")
    found = [unrelated, gyroscope_unit(evidence, 180 / np.pi)]
    assert [one.name for one in alone(evidence, found, lambda _: iter(()))] == ["gyroscope_unit"]
    assert alone(evidence, found, lambda _: iter([unrelated])) == found


def test_treads_too_fast_make_a_robot_slow_and_wide():
    run = treads(width(winding(4000), 0.5), lambda left, right: (1.5 * left, 1.5 * right))
    found = first(run)
    assert found.name == "track_width"
    assert "tread speeds are too large (a unit, a wheel radius)" in found.cause


def test_a_twist_of_a_robot_that_pulls_to_one_side_is_one_by_the_way():
    def twist(left, right):
        return (left + right) / 2, (right - left) / 0.9 - 0.2 * (left + right) / 2

    found = first(treads(winding(4000), twist))
    assert found.name == "treads_are_twist"
    assert [one.name for one in sides(Evidence(winding(4000)))] == []


@pytest.mark.parametrize(("metres", "words"), [(0.9, "degrees"), (1.7, "degrees"), (2.1, "")])
def test_degrees_that_are_longer_in_the_north_are_still_degrees(metres, words):
    """A drive along both axes, of which one is stretched by up to 2 at 60 degrees north."""
    forward = metres / 111_320.0
    found = matching(POSITION_UNITS, lambda unit: forward / unit.factor, most=ONE_AXIS_STRETCHED)
    assert words in ("" if found is None else found.words)
    assert (found is None) == (not words)


def test_no_slip_makes_a_robot_go_farther_than_its_treads():
    assert slip_along("seen", 0.5, tight=False, radius_m=None, opposed=0.0).name == "slip"
    farther = farther_along("seen")
    assert farther.name == "scale"
    assert "far from the centre" in farther.cause
