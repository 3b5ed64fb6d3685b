"""Clean recordings of other robots, and oddities that have no name in the catalogue."""

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.statistics.outliers import pose_outliers
from odometry.checks.statistics.relation import relation
from tests.odometry.checks.drives import PERIOD_S, drive, winding
from tests.odometry.checks.faulty import gyroscope, put, treads, without_gyroscope

CLEAN = {
    "winding": winding,
    "one circle": lambda: drive(np.full(1200, 0.8), np.full(1200, 0.3)),
    "one straight row": lambda: drive(np.full(1200, 0.8), np.zeros(1200), yaw_sigma=0.03),
    "a row without gyroscope": lambda: without_gyroscope(
        drive(np.full(1200, 0.5), np.zeros(1200), yaw_sigma=0.03)
    ),
    "turns on the spot": lambda: drive(
        np.zeros(2400), 0.6 * np.sign(np.sin(PERIOD_S * np.arange(2400) / 3))
    ),
    "noisy positions": lambda: drive(
        np.full(1200, 0.5), 0.3 * np.sin(PERIOD_S * np.arange(1200) / 3), sigma_m=1.0
    ),
    "stationary": lambda: drive(np.zeros(600), np.zeros(600)),
    "much turning": lambda: drive(*turning_much()),
    "two short moves": lambda: drive(
        np.where(np.abs(np.arange(2400) % 1200 - 600) < 30, 1.0, 0.0), np.zeros(2400)
    ),
}


@pytest.mark.parametrize("name", CLEAN)
def test_a_clean_drive_has_no_warning(name):
    report = check_recording(CLEAN[name]())
    assert not report.misleads, [finding.line for finding in report.findings]


UNNAMED = {
    "gyroscope scaled": lambda run: gyroscope(run, lambda rate: 0.85 * rate),
    "yaw of the poses drifts from their course": lambda run: put(
        gyroscope(run, lambda rate: rate + 0.01), "pose", yaw=run.pose["yaw"] + 0.01 * run.pose["t"]
    ),
}


@pytest.mark.parametrize("name", UNNAMED)
def test_what_has_no_name_is_a_disagreement(name):
    run = drive(*turning_much())
    (warning,) = check_recording(UNNAMED[name](run)).at(Level.WARNING)
    assert warning.name == "sensors_disagree"
    assert "cannot be determined" in warning.cause


def turning_much():
    at_s = PERIOD_S * np.arange(3600)
    return 0.8 + 0.2 * np.sin(at_s / 5), 0.3 + 0.4 * np.sin(at_s / 6)


def test_shares_of_steady_treads_are_not_certain(rng):
    left = 1 + 0.01 * rng.standard_normal(200)
    right = 2 + 0.01 * rng.standard_normal(200)
    found = relation(0.5 + 0.01 * rng.standard_normal(200), left, right)
    assert not found.distinct
    assert not found.certain(0, 0.0)


def test_small_differences_that_explain_the_target_are_certain(rng):
    difference = 0.01 * rng.standard_normal(200)
    found = relation(2 * difference, 1 - difference, 1 + difference)
    assert found.distinct
    assert found.coefficients == pytest.approx([-1.0, 1.0])


def test_a_drive_between_two_stops_is_no_outlier():
    x = np.concatenate([np.zeros(40), [1.5, 3.0], np.full(40, 4.5)])
    positions = np.stack([x, np.zeros_like(x)], axis=-1)
    assert not pose_outliers(positions).any()
    positions[20] = 9.0
    assert np.flatnonzero(pose_outliers(positions)).tolist() == [20]


def test_a_scale_of_the_treads_does_not_accuse_the_track_width():
    """It lengthens the way of the treads and widens the robot by the same factor."""
    run = treads(winding(), lambda left, right: (7.3 * left, 7.3 * right))
    names = {finding.name for finding in check_recording(run).at(Level.WARNING)}
    assert names & {"scale", "slip", "tread_unit"}
    assert "track_width" not in names
