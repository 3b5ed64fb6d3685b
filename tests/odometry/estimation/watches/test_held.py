"""Poses that are held with noise while the robot drives on and turns: its place is known after."""

import math

import numpy as np
import pytest

from odometry.estimation.watches.held_watch import with_pose
from tests.odometry.estimation.sensor_drives import (
    ALPHAS,
    drive,
    estimates_of,
    events_of,
    frames_of,
    noisy_poses,
)

BEGIN, LASTS = 400, 60  # at 40 s, for 6 s
END = BEGIN + LASTS
LEVER_M = (0.3, -0.2)


def circling(_):
    """Ahead and to the left."""
    return 0.4, 0.9


def pivoting(t):
    """On the spot to the left from 38 s to 48 s, else ahead."""
    return (-0.3, 0.3) if 38 < t < 48 else (0.7, 0.6)


def stopping(t):
    """Circling, with a stop from 43 s to 50 s."""
    return (0.0, 0.0) if 43 < t < 50 else (0.4, 0.9)


def held(driven, *, jump_m=(0.0, 0.0), has_yaw=True, lever_m=(0.0, 0.0)):
    """Poses that stay for 6 s, with noise, and then go on elsewhere by a jump."""
    poses = noisy_poses(driven, np.random.default_rng(2))
    cosine, sine = np.cos(driven.poses[:, 2]), np.sin(driven.poses[:, 2])
    poses[:, 0] += cosine * lever_m[0] - sine * lever_m[1]
    poses[:, 1] += sine * lever_m[0] + cosine * lever_m[1]
    draw = np.random.default_rng(3)
    poses[BEGIN:END] = poses[BEGIN] + draw.normal(0, 0.01, (LASTS, 3))
    poses[END:, :2] += jump_m
    poses[:, 2] = poses[:, 2] if has_yaw else math.nan
    return poses


def estimated(driven, poses, rates=None, lever_m=(0.0, 0.0)):
    rates = driven.yaw_rates_rad_s if rates is None else rates
    return estimates_of(frames_of(driven, poses=poses, yaw_rates=rates), lever_m=lever_m)


def off_m(estimates, driven, begin):
    """Distances from the truth from a step on."""
    rows = zip(estimates[begin:], driven.poses[begin:], strict=True)
    return np.array([np.hypot(*(one.mean[:2] - pose[:2])) for one, pose in rows])


def kinds(estimates):
    return [event.kind for event in events_of(estimates)]


@pytest.mark.parametrize("speeds_of", [circling, pivoting, stopping])
@pytest.mark.parametrize("lever_m", [(0.0, 0.0), LEVER_M])
def test_the_doubt_ends_and_nothing_was_learned(speeds_of, lever_m):
    driven = drive(80.0, speeds_of=speeds_of)
    estimates = estimated(driven, held(driven, lever_m=lever_m), lever_m=lever_m)
    after = estimates[END + 3]
    assert all(each.doubt is None for each in estimates[END + 3 :])
    assert np.sqrt(np.trace(after.covariance[:2, :2])) < 0.08
    assert after.alphas == pytest.approx(ALPHAS, abs=0.05)
    assert off_m(estimates, driven, END + 3).max() < 0.15
    event = events_of(estimates)[-1]
    assert event.kind == "held_poses"
    assert (event.begin_s, event.end_s) == pytest.approx((40.0, 46.1), abs=0.3)


def test_positions_alone_are_held_where_treads_lead_away():
    driven = drive(80.0, speeds_of=circling)
    estimates = estimated(driven, held(driven, has_yaw=False))
    assert kinds(estimates)[-1] == "held_poses"
    assert estimates[END + 3].doubt is None
    assert off_m(estimates, driven, END + 3).max() < 0.15


def test_meanwhile_the_covariance_covers_the_robot():
    driven = drive(80.0, speeds_of=circling)
    estimates = estimated(driven, held(driven))
    some = slice(BEGIN + 25, END)
    off = np.array([one.mean[:2] for one in estimates[some]]) - driven.poses[some, :2]
    covariances = [one.covariance[:2, :2] for one in estimates[some]]
    squared = [o @ np.linalg.solve(c, o) for o, c in zip(off, covariances, strict=True)]
    assert np.hypot(*off.T).max() > 0.8
    assert max(squared) < 9.21


def test_poses_that_go_on_elsewhere_stay_in_doubt():
    driven = drive(80.0, speeds_of=circling)
    estimates = estimated(driven, held(driven, jump_m=(4.0, -3.0)))
    assert "held_poses" not in kinds(estimates)
    assert estimates[END + 100].doubt is not None
    assert np.sqrt(np.trace(estimates[END + 100].covariance[:2, :2])) > 2.5


@pytest.mark.parametrize(("slip", "is_there"), [(0.1, False), (10.0, True)])
def test_a_pose_is_where_treads_led_by_as_much_as_they_slip(slip, is_there):
    driven = drive(80.0, speeds_of=circling)
    watch = estimated(driven, held(driven))[END - 1].watch.held
    before = watch.before[0], watch.before[1] * 1e-6
    scale = watch.scale._replace(slip_log=math.log(slip))
    watch = watch._replace(before=before, scale=scale, travel_m=10.0)
    pose = np.add(watch.led, (1.0, 0.0, 0.0))
    after = with_pose(watch, pose, watch.at_s, (0.0, 0.0), slip_noise=0.1)
    assert (after is not None) == is_there


def test_one_pose_where_treads_led_is_not_believed():
    driven = drive(80.0, speeds_of=circling)
    poses = held(driven, jump_m=(4.0, -3.0))
    poses[END, :2] -= (4.0, -3.0)
    estimates = estimated(driven, poses)
    assert "held_poses" not in kinds(estimates)


def test_a_robot_that_is_stuck_beside_a_gyroscope_that_drifts_was_not_held():
    driven = drive(80.0, speeds_of=circling)
    rows = np.r_[:BEGIN, np.full(LASTS, BEGIN), BEGIN : len(driven.stamps_s) - LASTS]
    still = type(driven)(driven.stamps_s, driven.poses[rows], driven.speeds_m_s, None)
    rates = driven.yaw_rates_rad_s[rows].copy()
    rates[BEGIN + 1 : END + 1] = 0.1
    estimates = estimated(still, noisy_poses(still, np.random.default_rng(2)), rates)
    assert "held_poses" not in kinds(estimates)
    assert off_m(estimates, still, END + 20).max() < 0.2


def test_positions_alone_say_nothing_of_turns_on_the_spot():
    driven = drive(80.0, speeds_of=pivoting)
    poses = noisy_poses(driven, np.random.default_rng(2))
    poses[:, 2] = math.nan
    estimates = estimated(driven, poses)
    assert all(each.watch.held is None or not each.watch.held.is_found for each in estimates)
