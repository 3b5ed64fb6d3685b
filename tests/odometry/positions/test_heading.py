"""Yaw found from positions, against the yaw that was driven."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import OdometryError
from odometry.geometry.angles import wrap
from odometry.positions.carrier import carrier_of
from odometry.positions.heading import found_heading, headed
from odometry.positions.smoother import smoothed_poses
from odometry.windows.measured_poses import YAW_FOUND, lacks_yaw
from tests.odometry.positions_drives import drive, emptied


def errors_rad(run, **moved):
    found = found_heading(emptied(run, **moved))
    errors = wrap(found.run.pose["yaw"] - run.pose["yaw"] - moved.get("turned_rad", 0.0))
    known = np.isfinite(errors)
    assert known.mean() > 0.99
    return found, errors[known]


@pytest.mark.parametrize("gyroscope", [False, True])
def test_without_noise_the_yaw_is_the_driven_one(gyroscope):
    _, errors = errors_rad(drive(1, gyroscope=gyroscope))
    assert np.sqrt(np.mean(errors**2)) < np.radians(0.2)
    assert np.abs(errors).max() < np.radians(1.5)  # at the very first position


@pytest.mark.parametrize("gyroscope", [False, True])
def test_with_noise_it_is_as_good_as_stated(gyroscope):
    """Over 300 s at 5 positions in a second; errors of neighbours are alike."""
    found, errors = errors_rad(drive(2, gyroscope=gyroscope, noise_m=0.3, duration_s=300.0))
    sigma = found.run.pose[YAW_FOUND]
    assert found.position_sigma_m == pytest.approx(0.3, rel=0.1)
    assert np.sqrt(np.mean(errors**2)) < np.radians(4.0)
    assert np.mean(errors**2 / sigma[np.isfinite(sigma)] ** 2) < 2.5


def test_turning_the_positions_turns_the_yaw():
    run = drive(3, noise_m=0.05, gyroscope=True)
    _, here = errors_rad(run)
    _, there = errors_rad(run, turned_rad=1.7, moved_m=(40.0, -7.0))
    np.testing.assert_allclose(there, here, atol=1e-4)


def test_an_antenna_off_the_origin_points_as_the_robot_does():
    _, errors = errors_rad(drive(4, arm_m=(0.5, -0.3)))
    assert np.abs(errors).max() < np.radians(0.5)


def test_one_bad_position_moves_the_yaw_little():
    run = drive(5, noise_m=0.05, gyroscope=True)
    bad = emptied(run)
    x = bad.pose["x"].copy()
    x[len(x) // 2] += 30.0
    bad = replace(bad, pose=replace(bad.pose, columns={**bad.pose.columns, "x": x}))
    change = wrap(found_heading(bad).run.pose["yaw"] - found_heading(emptied(run)).run.pose["yaw"])
    assert np.nanmax(np.abs(change)) < np.radians(5.0)


def test_positions_stay_and_the_yaw_is_known_as_found():
    run = emptied(drive(6, noise_m=0.02))
    found = found_heading(run).run
    np.testing.assert_array_equal(found.pose["x"], run.pose["x"])
    assert lacks_yaw(found)
    again = headed([found])
    assert again.runs == (found,)
    assert not again.found


def test_runs_with_yaw_pass_through():
    run = drive(7, duration_s=20.0)
    assert headed([run]).runs[0] is run


def test_no_positions_are_an_error():
    run = emptied(drive(8, duration_s=20.0))
    with pytest.raises(OdometryError, match="measured positions"):
        found_heading(replace(run, pose=run.pose.rows(slice(2))))


def test_the_smoother_is_the_least_squares_of_all_positions():
    """A short drive with small errors, solved at once as one linear problem."""
    carrier = carrier_of(emptied(drive(9, noise_m=0.01, duration_s=30.0)))
    count = 12
    record = replace(
        carrier.record,
        poses=carrier.record.poses[:count],
        breaks=carrier.record.breaks[: count - 1],
    )
    few = replace(
        carrier,
        record=record,
        steps=carrier.steps[: count - 1],
        step_variances=np.full((count - 1, 3), 1e-6),
    )
    found = smoothed_poses(few)
    poses = found.poses.copy()
    for _ in range(3):  # Gauss and Newton
        rows, information = [], []
        for i in range(count - 1):
            c, s = np.cos(poses[i, 2]), np.sin(poses[i, 2])
            swung = np.array([[c, -s], [s, c]]) @ few.steps[i, :2]
            ahead = np.append(poses[i, :2] + swung, poses[i, 2] + few.steps[i, 2])
            jacobian = np.zeros((3, 3 * count))
            jacobian[:, 3 * i : 3 * i + 3] = -np.eye(3)
            jacobian[0, 3 * i + 2], jacobian[1, 3 * i + 2] = swung[1], -swung[0]
            jacobian[:, 3 * i + 3 : 3 * i + 6] = np.eye(3)
            rows.append(np.column_stack([jacobian, poses[i + 1] - ahead]))
            information += [1e3] * 3
        for i in range(count):
            jacobian = np.zeros((2, 3 * count))
            jacobian[[0, 1], [3 * i, 3 * i + 1]] = 1.0
            rows.append(np.column_stack([jacobian, poses[i, :2] - record.poses[i, :2]]))
            information += [1 / np.sqrt(few.position_variance_m2)] * 2
        first = np.zeros((1, 3 * count + 1))
        first[0, 2], first[0, -1] = 1.0, poses[0, 2] - few.first_yaw_rad
        information.append(1 / 0.3)
        weighted = np.vstack([*rows, first]) * np.array(information)[:, None]
        step = np.linalg.lstsq(weighted[:, :-1], -weighted[:, -1], rcond=None)[0]
        poses += step.reshape(-1, 3)
    np.testing.assert_allclose(found.poses, poses, atol=2e-3)
