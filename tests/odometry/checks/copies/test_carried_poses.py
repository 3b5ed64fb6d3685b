"""Poses of a filter that goes on by the treads from fix to fix are no reference."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import table, turning_all_round
from tests.odometry.checks.faulty import put


def filtered(run, every_rows, gain=0.3):
    """Its pose, at the rows of odometry.csv: drawn to a measured one now and then."""
    t, pose = run.odometry.stamps_s, run.pose
    measured = [np.interp(t, pose.stamps_s, of) for of in (pose["x"], pose["y"])]
    measured.append(np.interp(t, pose.stamps_s, np.unwrap(pose["yaw"])))
    left, right, rate = (run.odometry[name] for name in ("v_left", "v_right", "gyro_z"))
    at = np.array([one[0] for one in measured])
    rows = [at]
    for row, step_s in enumerate(np.diff(t)):
        way_m, turn = (left[row] + right[row]) / 2 * step_s, rate[row] * step_s
        middle = at[2] + turn / 2
        at = at + np.array([way_m * np.cos(middle), way_m * np.sin(middle), turn])
        if row % every_rows == 0:
            at = at + gain * (np.array([one[row + 1] for one in measured]) - at)
        rows.append(at)
    x, y, yaw = np.array(rows).T
    return replace(run, pose=table("pose.csv", t=t, x=x, y=y, yaw=yaw))


@pytest.mark.parametrize("every_rows", [5, 20, 60])
def test_a_filter_that_mixes_the_treads_in_is_no_reference(every_rows):
    (found,) = check_recording(filtered(turning_all_round(), every_rows)).at(Level.WARNING)
    assert found.name == "poses_are_wheel_odometry"
    assert "carries its pose on by these treads" in found.cause


def exact(run, scale, sigma_m):
    """Poses of treads that slip all the time alike."""
    rng, carried = np.random.default_rng(0), filtered(run, 10**9)
    pose = carried.pose
    noise = sigma_m * rng.standard_normal((2, len(pose)))
    return put(carried, "pose", x=scale * pose["x"] + noise[0], y=scale * pose["y"] + noise[1])


@pytest.mark.parametrize(("scale", "sigma_m"), [(0.97, 0.0), (1.0, 1e-4)])
def test_a_sensor_of_a_robot_that_hardly_slips_is_one(scale, sigma_m):
    report = check_recording(exact(turning_all_round(), scale, sigma_m))
    assert "carries" not in " ".join(found.cause for found in report.findings)
