"""Yaw found from positions, against the yaw that was driven."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import OdometryError
from odometry.geometry.angles import wrap
from odometry.positions.carrier import carrier_of
from odometry.positions.heading import found_heading, headed
from odometry.positions.positions_yaw import yaw_at_positions
from odometry.positions.smoother import Way, filtered, smoothed
from odometry.windows.recorded.measured_poses import YAW_FOUND, lacks_yaw
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
    assert np.sqrt(np.mean(errors**2)) < np.radians(0.3)
    assert np.abs(errors).max() < np.radians(1.5)  # at the very first position


@pytest.mark.parametrize("gyroscope", [False, True])
def test_with_noise_it_is_as_good_as_stated(gyroscope):
    """Over 160 s at 5 positions in a second; errors of neighbours are correlated."""
    found, errors = errors_rad(drive(2, gyroscope=gyroscope, noise_m=0.3, duration_s=160.0))
    sigma = found.run.pose[YAW_FOUND]
    assert found.position_sigma_m == pytest.approx(0.3, rel=0.1)
    assert np.sqrt(np.mean(errors**2)) < np.radians(4.0)
    assert np.mean(errors**2 / sigma[np.isfinite(sigma)] ** 2) < 2.5


def test_turning_the_positions_turns_the_yaw():
    run = drive(3, noise_m=0.05, gyroscope=True, duration_s=50.0)
    _, here = errors_rad(run)
    _, there = errors_rad(run, turned_rad=1.7, moved_m=(40.0, -7.0))
    np.testing.assert_allclose(there, here, atol=1e-4)


def test_an_antenna_off_the_origin_points_as_the_robot_does():
    _, errors = errors_rad(drive(4, arm_m=(0.5, -0.3)))
    assert np.abs(errors).max() < np.radians(0.5)


def test_one_bad_position_moves_the_yaw_little():
    run = drive(5, noise_m=0.05, gyroscope=True, duration_s=50.0)
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
    positions = carrier.record.poses[:count, :2]
    steps = carrier.steps[0, : count - 1]
    way = Way(
        positions,
        steps[None],
        np.full((count - 1, 3), 1e-6),
        np.zeros((count - 1, 2)),
        carrier.drift_sigmas,
        carrier.position_variance_m2,
        np.zeros(count - 1, dtype=bool),
    )
    found = smoothed(filtered(way, np.array([carrier.first_yaw_rad]))).poses[:, 0]
    poses = found.copy()
    for _ in range(3):  # Gauss and Newton
        rows, information = [], []
        for i in range(count - 1):
            c, s = np.cos(poses[i, 2]), np.sin(poses[i, 2])
            swung = np.array([[c, -s], [s, c]]) @ steps[i, :2]
            ahead = np.append(poses[i, :2] + swung, poses[i, 2] + steps[i, 2])
            jacobian = np.zeros((3, 3 * count))
            jacobian[:, 3 * i : 3 * i + 3] = -np.eye(3)
            jacobian[0, 3 * i + 2], jacobian[1, 3 * i + 2] = swung[1], -swung[0]
            jacobian[:, 3 * i + 3 : 3 * i + 6] = np.eye(3)
            rows.append(np.column_stack([jacobian, poses[i + 1] - ahead]))
            information += [1e3] * 3
        for i in range(count):
            jacobian = np.zeros((2, 3 * count))
            jacobian[[0, 1], [3 * i, 3 * i + 1]] = 1.0
            rows.append(np.column_stack([jacobian, poses[i, :2] - positions[i]]))
            information += [1 / np.sqrt(carrier.position_variance_m2)] * 2
        first = np.zeros((1, 3 * count + 1))
        first[0, 2], first[0, -1] = 1.0, poses[0, 2] - carrier.first_yaw_rad
        information.append(1 / 0.3)
        weighted = np.vstack([*rows, first]) * np.array(information)[:, None]
        step = np.linalg.lstsq(weighted[:, :-1], -weighted[:, -1], rcond=None)[0]
        poses += step.reshape(-1, 3)
    np.testing.assert_allclose(found, poses, atol=2e-3)


def test_a_bias_that_is_left_in_the_carrier_does_not_turn_the_yaw():
    """0.03 rad/s would be 100 degrees in 60 s."""
    carrier = carrier_of(emptied(drive(11, gyroscope=True, noise_m=0.3, duration_s=60.0)))
    steps = carrier.steps.copy()
    steps[..., 2] += 0.03 * np.diff(carrier.record.pose_s)
    here, biased = yaw_at_positions(carrier), yaw_at_positions(replace(carrier, steps=steps))
    assert np.nanmax(np.abs(wrap(biased.yaw_rad - here.yaw_rad))) < np.radians(1.0)


def test_positions_that_do_not_tell_the_yaw_are_refused():
    """The robot stays within its noise, so that any heading agrees with them."""
    with pytest.raises(OdometryError, match="do not determine it"):
        found_heading(emptied(drive(12, noise_m=8.0, duration_s=60.0)))


def test_a_start_headed_elsewhere_is_not_followed():
    """The likeliest of the starts is found wherever the first guess points."""
    carrier = carrier_of(emptied(drive(13, noise_m=0.1, duration_s=60.0)))
    here = yaw_at_positions(carrier)
    away = yaw_at_positions(replace(carrier, first_yaw_rad=carrier.first_yaw_rad + 2.5))
    assert np.abs(wrap(away.yaw_rad - here.yaw_rad)).max() < np.radians(0.5)


def test_the_way_back_of_the_way_back_is_the_way():
    carrier = carrier_of(emptied(drive(14, duration_s=60.0)))
    way = Way(
        carrier.record.poses[:, :2],
        carrier.steps,
        carrier.step_variances,
        carrier.drifts,
        carrier.drift_sigmas,
        carrier.position_variance_m2,
        np.zeros(len(carrier.drifts), dtype=bool),
    )
    for there, again in zip(way, way.backwards().backwards(), strict=True):
        np.testing.assert_allclose(again, there, atol=1e-12)
