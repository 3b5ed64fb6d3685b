"""Poses and treads that disagree: the covariance covers both places until poses decide."""

import numpy as np
import pytest

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.other_places import LASTS_S
from tests.odometry.estimation.sensor_drives import (
    STEP_S,
    drive,
    estimates_of,
    events_of,
    frames_of,
    noisy_poses,
    standing,
    weaving,
)

BEGIN, END = 400, 520  # 40 s to 52 s
SHIFT_M = np.array([5.0, -4.0])
SURE = 9.21  # normalised square of a position that 0.99 of true ones have at most


@pytest.fixture(scope="module")
def driven():
    return drive(90.0)


def estimated(driven, poses, config=None):
    return estimates_of(
        frames_of(driven, poses=poses, yaw_rates=driven.yaw_rates_rad_s), config=config
    )


def shifted(driven, begin=BEGIN, end=END, *, has_yaw=True):
    poses = noisy_poses(driven, np.random.default_rng(2))
    poses[begin:end, :2] += SHIFT_M
    poses[:, 2] = poses[:, 2] if has_yaw else np.nan
    return poses


def off_squared(estimates, places):
    """Normalised squares of the positions against places (N, 2)."""
    return np.array(
        [
            (off := one.mean[:2] - place) @ np.linalg.solve(one.covariance[:2, :2], off)
            for one, place in zip(estimates, places, strict=True)
        ]
    )


@pytest.mark.parametrize("has_yaw", [True, False])
def test_a_reflection_is_covered_and_ends_at_once(driven, has_yaw):
    estimates = estimated(driven, shifted(driven, has_yaw=has_yaw))
    off_m = np.hypot(*(np.array([one.mean[:2] for one in estimates]) - driven.poses[:, :2]).T)
    assert off_m[BEGIN + 20 : END].min() > 5  # it follows the poses, and is as sure of them
    assert all(np.sqrt(one.doubt.covariance[0, 0]) < 0.1 for one in estimates[BEGIN + 20 : END])
    inside = slice(BEGIN, END + 10)
    assert off_squared(estimates[inside], driven.poses[inside, :2]).max() < SURE
    assert off_m[END + 2 :].max() < 0.15
    assert np.sqrt(estimates[-1].covariance[0, 0]) < 0.05
    *_, event = events_of(estimates)
    assert event.kind == "shifted_poses"
    assert (event.begin_s, event.end_s) == pytest.approx((40.9, 52.1), abs=0.05)
    assert event.values[0] == pytest.approx(np.hypot(*SHIFT_M), abs=0.3)
    assert "reflection" in event.text


def test_a_jump_that_stays_is_in_doubt_for_a_while_only():
    driven = drive(40.0 + LASTS_S + 5)
    poses = shifted(driven, end=None)
    estimates = estimated(driven, poses)
    seen = poses[:, :2] - SHIFT_M, poses[:, :2]
    for places in seen:
        some = slice(BEGIN, BEGIN + 600)
        assert np.mean(off_squared(estimates[some], places[some]) < SURE) > 0.98
    assert estimates[-1].doubt is None
    assert np.sqrt(estimates[-1].covariance[0, 0]) < 0.05
    assert [event.kind for event in events_of(estimates)] == ["reinitialised"]


def test_poses_that_come_back_little_by_little_are_no_reflection(driven):
    poses = shifted(driven, end=None)
    share = np.clip((driven.stamps_s - 60.0) / 0.7, 0, 1)
    poses[:, :2] -= share[:, None] * SHIFT_M
    estimates = estimated(driven, poses)
    assert {event.kind for event in events_of(estimates)} == {"reinitialised"}
    assert np.hypot(*(estimates[-1].mean[:2] - driven.poses[-1, :2])) < 0.15


def test_outliers_are_no_other_place(driven):
    poses = noisy_poses(driven, np.random.default_rng(2))
    plain = estimated(driven, poses)
    poses[300:800:50, :2] += SHIFT_M
    poses[325:800:50, :2] -= 3 * SHIFT_M
    estimates = estimated(driven, poses)
    assert all(one.doubt is None for one in estimates)
    assert estimates[-1].covariance[0, 0] == pytest.approx(plain[-1].covariance[0, 0], rel=0.5)


def stops(t):
    return standing(t) if 35 < t < 60 else weaving(t)


def test_a_reflection_at_rest_is_no_robot_that_was_moved():
    driven = drive(90.0, speeds_of=stops)
    estimates = estimated(driven, shifted(driven))
    assert off_squared(estimates[BEGIN:END], driven.poses[BEGIN:END, :2]).max() < SURE
    assert [event.kind for event in events_of(estimates)] == ["shifted_poses"]
    assert np.hypot(*(estimates[END + 5].mean[:2] - driven.poses[END + 5, :2])) < 0.15


def carried(lever_m):
    """A robot at rest that is lifted, moved by 3 m and turned by 1.5 rad within 12 s."""
    driven = drive(90.0, speeds_of=stops)
    share = np.clip((driven.stamps_s - 40.0) / 12.0, 0, 1)
    smooth = share - np.sin(2 * np.pi * share) / (2 * np.pi)
    turn = 1.5 * smooth
    at = driven.poses[BEGIN, 0] + 1j * driven.poses[BEGIN, 1]
    places = driven.poses[:, 0] + 1j * driven.poses[:, 1]
    places = at + (places - at) * np.exp(1j * turn) + (2.5 - 1.6j) * smooth
    yaw = driven.poses[:, 2] + turn
    measured = places + complex(*lever_m) * np.exp(1j * yaw)
    positions = np.stack([measured.real, measured.imag, np.full(len(yaw), np.nan)], axis=-1)
    positions[:, :2] += np.random.default_rng(0).normal(0, 0.01, (len(yaw), 2))
    rates = driven.yaw_rates_rad_s + np.append(np.nan, np.diff(turn)) / STEP_S
    speeds = driven.speeds_m_s + np.random.default_rng(5).normal(0, 0.005, driven.speeds_m_s.shape)
    resting = np.flatnonzero(np.all(driven.speeds_m_s == 0, axis=1))
    speeds[resting] = 0.0
    speeds[resting[:3], 0] = 0.002  # the left tread comes to stand last
    return yaw, frames_of(driven, poses=positions, yaw_rates=rates, speeds=speeds)


@pytest.mark.parametrize("lever_m", [(0.0, 0.0), (0.1, -0.15)])
def test_a_carried_robot_is_turned_by_its_gyroscope_and_no_encoder_is_stuck(lever_m):
    yaw, frames = carried(lever_m)
    estimates = estimates_of(frames, lever_m=lever_m)
    off = np.angle(np.exp(1j * (np.array([one.mean[2] for one in estimates]) - yaw)))
    assert np.abs(off[END:]).max() < 0.4
    kinds = {event.kind for event in events_of(estimates)}
    assert "moved_at_rest" in kinds
    assert not kinds & {"stuck_tread", "reinitialised"}


def test_the_published_filter_has_no_doubt(driven):
    estimates = estimated(driven, shifted(driven), IcrEkfConfig(**PAPER))
    assert all(one.doubt is None for one in estimates)
