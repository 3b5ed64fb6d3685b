"""Compare and gap on positions without yaw, and the lever arm of `[sensors]`."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.comparison.compare import compare
from odometry.comparison.config import ComparisonConfig
from odometry.effects.measurement.measured import robot_run
from odometry.gap.gap import find_gap
from odometry.geometry.angles import wrap
from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.models.icr import Icr
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of
from tests.odometry.positions_drives import ICR, drive, emptied

CONFIG = ComparisonConfig(solver=SolverConfig(starts=1), draws=100)


@pytest.mark.slow
def test_compare_says_what_it_found_and_judges_longer_windows_under_more_noise():
    runs = [
        emptied(drive(seed, noise_m=0.3, gyroscope=True, name=name))
        for seed, name in ((1, "a"), (2, "b"))
    ]
    found = compare(runs, ["icr_symmetric", "differential_drive"], config=CONFIG)
    assert found.config.horizons_m == (pytest.approx(28 * 0.3, rel=0.1),)
    assert sum("yaw was not measured" in note for note in found.notes) == 2
    assert "errors are evaluated over" in found.notes[-1]
    (place,) = found.places
    fitted, ideal = found.summaries_at(place)
    assert fitted.means["rotation"] < 0.5 * ideal.means["rotation"]
    assert fitted.means["translation"] < ideal.means["translation"]


def test_compare_with_little_noise_keeps_the_horizon():
    runs = [emptied(drive(s, noise_m=0.01, duration_s=60.0, name=f"{s}")) for s in (1, 2)]
    found = compare(runs, ["icr_symmetric"], config=CONFIG)
    assert found.config.horizons_m == (2.0,)


@pytest.mark.slow
def test_gap_finds_slower_wheels_from_positions_alone():
    """Both treads move 20 % less on the measured runs than on the calibration."""
    known = [emptied(drive(3, noise_m=0.01, gyroscope=True, duration_s=80.0, name="yard"))]
    run = emptied(drive(4, noise_m=0.01, gyroscope=True, duration_s=80.0, name="hill"))
    odometry = {
        name: column / 0.8 if name in ("v_left", "v_right") else column
        for name, column in run.odometry.columns.items()
    }
    slower = replace(run, odometry=replace(run.odometry, columns=odometry))
    found = find_gap([slower], known, model=Icr())
    assert found.verdict == "wheel_scale"
    assert len(found.notes) == 2


def test_full_poses_of_an_antenna_are_moved_to_the_robot():
    arm_m = (0.4, -0.25)
    found = identify([drive(5, arm_m=arm_m)], "icr", solver_config=SolverConfig(starts=1))
    (ground,) = found.terrains.values()
    for name, value in ICR.items():
        assert ground.fit.values[name] == pytest.approx(value, abs=1e-3), name


def test_a_lever_arm_is_undone_once():
    """At the door, or where windows are cut; not both."""
    run = drive(6, arm_m=(0.4, -0.25))
    moved = robot_run(run, ())
    assert moved.sensors.pose_m is None
    at_origin = drive(6)
    for name in ("x", "y", "yaw"):
        np.testing.assert_allclose(wrap(moved.pose[name] - at_origin.pose[name]), 0, atol=1e-9)
    config = WindowConfig()
    np.testing.assert_allclose(
        windows_of([run], config).measured, windows_of([moved], config).measured, atol=1e-9
    )
