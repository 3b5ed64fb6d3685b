"""A robot that is moved while its treads stand: the filter follows, says so, keeps its ICRs."""

import numpy as np
import pytest

from odometry.estimation.noise_scale import NoiseScale
from odometry.estimation.watches.rest_watch import RestWatch, watched
from odometry.replays.run_end import ongoing
from tests.odometry.estimation.sensor_drives import (
    STEP_S,
    drive,
    estimates_of,
    events_of,
    frames_of,
    noisy_poses,
    weaving,
)

STOP, PUSH, DONE, GO = 300, 340, 390, 430  # stands from 30 s on, is pushed from 34 to 39 s


@pytest.fixture(scope="module")
def driven():
    return drive(60.0, speeds_of=lambda t: (0.0, 0.0) if STOP <= round(t * 10) < GO else weaving(t))


def estimated(driven, rng, pushed_m, turned_rad=0.0):
    """The push is along x, and the rest of the drive begins where it ends."""
    poses, k = noisy_poses(driven, rng), np.arange(len(driven.stamps_s))
    share = np.clip((k - PUSH) / (DONE - PUSH), 0.0, 1.0)
    centre = driven.poses[STOP, :2]
    around = (poses[:, :2] - centre) @ [1, 1j] * np.exp(1j * turned_rad * share)
    place = np.column_stack([around.real, around.imag]) + centre
    poses = np.column_stack([place, poses[:, 2] + turned_rad * share])
    poses[:, 0] += pushed_m * share
    poses[:, 2] = np.angle(np.exp(1j * poses[:, 2]))
    rates = driven.yaw_rates_rad_s + np.gradient(turned_rad * share, STEP_S)
    return estimates_of(frames_of(driven, poses=poses, yaw_rates=rates)), poses


def test_a_robot_that_stands_is_left_alone(driven, rng):
    estimates, _ = estimated(driven, rng, 0.0)
    assert events_of(estimates) == []
    assert estimates[GO - 1].watch.rest.since_s == STOP * STEP_S
    assert estimates[GO + 1].watch.rest is None


def some_without_yaw(poses, rng):
    """Half of the yaws is not measured, as where a receiver of two antennas has no fix."""
    poses[rng.random(len(poses)) < 0.5, 2] = np.nan
    return poses


def test_a_robot_that_stands_may_have_poses_without_yaw(driven, rng):
    poses = some_without_yaw(noisy_poses(driven, rng), rng)
    events = events_of(estimates_of(frames_of(driven, poses=poses)))
    assert "moved_at_rest" not in [event.kind for event in events]


def test_poses_without_yaw_do_not_hide_that_a_robot_is_turned():
    rng, cov = np.random.default_rng(2), np.diag([1e-4, 1e-4, 1e-4])
    poses = some_without_yaw(rng.normal(0, 0.01, (40, 3)) + np.array([2.0, 1.0, 0.0]), rng)
    poses[20:, 2] += 0.8
    watch, moved = RestWatch(0.0, (np.zeros(9), np.eye(9)), NoiseScale()), []
    for place, pose in enumerate(poses):
        watch, now = watched(watch, pose, 2.0 + 0.1 * place, cov)
        moved.append(now)
    assert not any(moved[:20])
    assert any(moved[20:])


@pytest.mark.parametrize("pushed_m", [0.4, 1.0, 3.0])
def test_a_push_is_followed_and_flagged(driven, rng, pushed_m):
    estimates, poses = estimated(driven, rng, pushed_m)
    event = next(e for e in events_of(estimates) if e.kind == "moved_at_rest")
    assert PUSH * STEP_S < event.begin_s < DONE * STEP_S
    assert event.end_s == pytest.approx(GO * STEP_S, abs=0.11)
    assert event.values[0] == pytest.approx(pushed_m, abs=0.25)
    off = [np.hypot(*(e.mean - np.append(p, np.zeros(6)))[:2]) for e, p in
           zip(estimates[PUSH:], poses[PUSH:], strict=True)]  # fmt: skip
    assert max(off) < 0.45


def test_a_robot_that_rolls_on_for_a_second_is_not_moved():
    """Poses are looked at a second after the treads stopped: three give its place."""
    watch = RestWatch(10.0, (np.zeros(9), np.eye(9)), NoiseScale())
    for stamp_s, count in ((10.5, 0), (10.9, 0), (11.1, 1), (11.3, 2)):
        watch, _ = watched(watch, np.array([stamp_s, 0.0, 0.0]), stamp_s, 1e-4 * np.eye(3))
        assert len(watch.poses) == count


def test_a_push_teaches_nothing_of_the_icrs(driven, rng):
    """The estimate when it ends is the estimate of the moment when the treads came to stand."""
    estimates, _ = estimated(driven, rng, 1.0)
    found = next(k for k, e in enumerate(estimates) if not np.isnan(_moved_since(e)))
    at_rest, after = estimates[STOP], estimates[found]
    np.testing.assert_array_equal(after.mean[3:], at_rest.mean[3:])
    np.testing.assert_array_equal(after.covariance[3:, 3:], at_rest.covariance[3:, 3:])
    assert not after.covariance[:3, 3:].any()
    assert after.scale == at_rest.scale


def _moved_since(estimate):
    return np.nan if estimate.watch.rest is None else estimate.watch.rest.moved_since_s


def test_a_robot_that_is_turned_by_hand_is_flagged(driven, rng):
    estimates, poses = estimated(driven, rng, 0.0, turned_rad=0.6)
    assert "moved_at_rest" in [event.kind for event in events_of(estimates)]
    assert abs(np.angle(np.exp(1j * (estimates[-1].mean[2] - poses[-1, 2])))) < 0.05


def test_a_push_that_lasts_to_the_end_is_said(driven, rng):
    estimates, _ = estimated(driven, rng, 1.0)
    last = estimates[DONE]
    assert "moved_at_rest" in [event.kind for event in ongoing(last.watch, last.stamp_s)]
