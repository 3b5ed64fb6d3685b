"""Slip factors that change within seconds may walk faster for a while."""

import math

import numpy as np
import pytest

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.transition import STATES
from odometry.estimation.watches.slip_watch import LASTS_S, WALK, watched
from tests.odometry.estimation.sensor_drives import (
    ALPHAS,
    drive,
    estimates_of,
    frames_of,
    noisy_poses,
)

BEGIN, END = 600, 660  # 60 s to 66 s


@pytest.fixture(scope="module")
def driven():
    return drive(90.0)


def spinning(driven, times=1.8, config=None):
    """Estimates of a drive in which the right tread turns faster than the robot goes, for 6 s."""
    speeds = driven.speeds_m_s.copy()
    speeds[BEGIN:END, 1] *= times
    poses = noisy_poses(driven, np.random.default_rng(2))
    frames = frames_of(driven, poses=poses, yaw_rates=driven.yaw_rates_rad_s, speeds=speeds)
    return estimates_of(frames, config=config)


def off(estimate):
    """By how many deviations slip factors are off."""
    sigmas = np.sqrt(np.diag(estimate.covariance)[7:])
    return np.abs(estimate.alphas - ALPHAS) / sigmas


def test_after_a_tread_has_spun_its_factor_is_known_again(driven):
    after = spinning(driven)[END + 100]
    assert after.watch.slip.walk(after.stamp_s) == WALK
    assert off(after).max() < 3
    assert after.alphas == pytest.approx(ALPHAS, abs=0.1)


def test_a_drive_without_a_change_is_the_same(driven):
    estimates = spinning(driven, times=1.0)
    assert all(one.watch.slip is None or one.watch.slip.until_s == -math.inf for one in estimates)


def belief(left, right, sigma=0.02):
    mean, covariance = np.zeros(STATES), sigma**2 * np.eye(STATES)
    mean[7:] = left, right
    return mean, covariance


def test_a_change_counts_within_seconds_on_one_terrain():
    watch = watched(None, belief(0.9, 0.9), 10.0, "grass")
    assert watched(watch, belief(0.9, 0.97), 12.0, "grass") is watch
    changed = watched(watch, belief(0.9, 0.99), 12.0, "grass")
    assert changed.walk(12.0 + LASTS_S - 0.1) == WALK
    assert changed.walk(12.0 + LASTS_S + 0.1) == 1
    slow = watched(watch, belief(0.9, 0.99), 14.0, "grass")
    assert (slow.walk(14.0), slow.right) == (1, 0.99)
    assert watched(changed, belief(0.9, 0.99), 14.0, "grass").walk(14.0) == WALK
    assert watched(changed, belief(0.9, 0.7), 12.5, "ice").walk(12.5) == 1


def test_the_published_filter_watches_nothing(driven):
    estimates = spinning(driven, config=IcrEkfConfig(**PAPER))
    assert estimates[-1].watch is None
