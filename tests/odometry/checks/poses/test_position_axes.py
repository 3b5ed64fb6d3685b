"""Positions of other axes are no yaw in degrees."""

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import drive, turning_all_round
from tests.odometry.checks.faulty import (
    gyroscope,
    positions,
    put,
    without_gyroscope,
    without_yaw,
    yaw,
)


def first_warning(run):
    return check_recording(run).at(Level.WARNING)[0]


def height(x):
    return np.random.default_rng(3).normal(0, 0.01, len(x))


@pytest.mark.parametrize("sensors", [lambda run: run, without_gyroscope])
@pytest.mark.parametrize(
    ("axis", "change"),
    [("y", lambda x, y: (-y, height(x))), ("x", lambda x, y: (height(y), x))],
)
def test_positions_of_a_camera_are_named_by_the_axis_that_is_missing(sensors, axis, change):
    found = first_warning(positions(sensors(turning_all_round()), change))
    assert found.name == "position_axes"
    assert f"hardly change along {axis} (" in found.seen
    assert "cannot be distinguished" in found.cause
    assert "degrees" not in found.cause


def test_a_column_that_was_not_measured_on_a_real_recording(shared_data):
    run = Run.read(shared_data / "motion" / "warthog_grass_20240808_1556")
    found = first_warning(put(run, "pose", y=0 * run.pose["y"]))
    assert found.name == "position_axes"


@pytest.mark.parametrize("of_gyroscope", [lambda rate: rate, np.degrees])
def test_yaw_in_degrees_is_still_named(of_gyroscope):
    run = gyroscope(turning_all_round(), of_gyroscope)
    names = [finding.name for finding in check_recording(yaw(run, np.degrees)).findings]
    assert "yaw_in_degrees" in names


def test_what_is_across_lanes_is_not_extrapolated():
    """Courses within 30 degrees of one axis: the same for a stretch as for a slip in turns."""
    at_s = 0.05 * np.arange(6000)
    run = drive(np.full(6000, 0.9), np.gradient(0.5 * np.sin(at_s / 9), 0.05))
    lanes = positions(without_yaw(run), lambda x, y: (x, 2.5 * y))
    assert "positions_stretched" not in warnings(lanes)
