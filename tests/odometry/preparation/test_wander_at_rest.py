"""Positions that wander while the treads stand."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from odometry.estimation.config import IcrEkfConfig
from odometry.preparation.pose_noise import with_pose_noise
from odometry.preparation.wander_at_rest import wander_sigma_m
from tests.odometry.checks.drives import PERIOD_S, drive

LASTS_S = 40.0


def stopping(seed=0, stops=12, rest_s=8.0, sigma_m=1e-3):
    """A drive that stops again and again, its positions exact but for a scatter."""
    at_s = PERIOD_S * np.arange(int(stops * 30 / PERIOD_S))
    drives = at_s % 30 > rest_s
    run = drive(0.6 * drives, 0.3 * np.sin(at_s / 7) * drives, sigma_m=sigma_m, seed=seed)
    return without_yaw(run)


def each_second(run):
    """Its positions at 1 Hz."""
    return replace(run, pose=run.pose.rows(np.arange(0, len(run.pose), 10)))


def without_yaw(run):
    columns = {**run.pose.columns, "yaw": np.full(len(run.pose), np.nan)}
    return replace(run, pose=replace(run.pose, columns=columns))


def moved(run, by_m):
    columns = {name: run.pose[name] + by_m[:, axis] for axis, name in enumerate(("x", "y"))}
    return replace(run, pose=replace(run.pose, columns={**run.pose.columns, **columns}))


def wandering(run, sigma_m, seed):
    """The run, its positions with errors that last (Gauss-Markov)."""
    rng = np.random.default_rng(seed)
    keeps = np.exp(-2 * PERIOD_S / LASTS_S)
    pushes = np.sqrt(1 - keeps**2) * rng.normal(size=(len(run.pose), 2))
    pushes[0] = rng.normal(size=2)
    return moved(run, sigma_m * lfilter([1.0], [1.0, -keeps], pushes, axis=0))


def scattering(run, sigma_m, seed):
    return moved(run, sigma_m * np.random.default_rng(seed).normal(size=(len(run.pose), 2)))


def found_m(run):
    return wander_sigma_m(run, run.pose.stamps_s, run.pose.stack("x", "y"))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("sigma_m", [0.3, 1.0])
def test_positions_that_wander_are_off_by_as_much(sigma_m, seed):
    assert 0.5 * sigma_m < found_m(wandering(stopping(seed), sigma_m, seed)) < 2 * sigma_m


@pytest.mark.parametrize("seed", range(6))
def test_scatter_alone_is_nothing_that_lasts(seed):
    assert found_m(scattering(stopping(seed), 0.3, seed)) < 0.15


def test_positions_that_stay_where_they_are_do_not_wander():
    assert found_m(stopping()) < 0.01


def test_a_robot_that_is_pushed_at_one_stop_does_not_wander():
    run = stopping(stops=5)
    pushed = np.where(run.pose.stamps_s > 35.0, 2.0, 0.0)
    assert found_m(moved(run, np.stack([pushed, 0 * pushed], axis=1))) < 0.01


def test_white_noise_is_rarely_taken_for_wander():
    """In one of twenty, and as many again by chance: 0.10 before, 0.04 of 1500 now."""
    few = each_second(stopping(stops=8))
    assert np.mean([found_m(scattering(few, 0.3, seed)) > 0 for seed in range(200)]) < 0.075


def repeated(way_m):
    return np.repeat(way_m, 10, axis=0)


def interpolated(way_m):
    rows = np.arange(10 * len(way_m))
    return np.stack([np.interp(rows, 10 * np.arange(len(way_m)), way) for way in way_m.T], axis=1)


@pytest.mark.parametrize("between", [repeated, interpolated])
def test_scatter_that_later_poses_repeat_does_not_last(between):
    run = stopping(sigma_m=0.0)
    way_m = each_second(run).pose.stack("x", "y")
    found = []
    for seed in range(10):
        noisy_m = between(way_m + 0.3 * np.random.default_rng(seed).normal(size=way_m.shape))
        found.append(found_m(moved(run, noisy_m - run.pose.stack("x", "y"))))
    assert np.median(found) == 0


def test_a_receiver_that_holds_its_position_at_rest_says_nothing():
    assert found_m(stopping(sigma_m=0.0)) is None


@pytest.mark.parametrize("poses", [lambda run: run, each_second], ids=["10 Hz", "1 Hz"])
def test_three_stops_of_ten_seconds_decide(poses):
    run = poses(wandering(stopping(stops=3, rest_s=10.0), 1.0, 0))
    assert found_m(run) > 0.3


def test_two_stops_do_not_decide():
    assert found_m(wandering(stopping(stops=2, rest_s=25.0), 1.0, 0)) is None


def test_the_filter_holds_what_wanders_in_its_sigmas_and_says_so():
    config, events = with_pose_noise(wandering(stopping(), 0.5, 0), IcrEkfConfig())
    assert config.lasting_sigma_m > 0.25
    assert [event.kind for event in events] == ["wandering_positions"]
    config, events = with_pose_noise(stopping(), IcrEkfConfig())
    assert config == IcrEkfConfig()
    assert events == ()
