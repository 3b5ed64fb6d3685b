"""A gyroscope whose bias steps or drifts: poses show it, the open-loop odometer turns by it."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.filter_changes import drifted_bias
from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.watches.bias_watch import BiasWatch, Rates, changed_bias, watched
from odometry.estimation.watches.gyroscope_hold import GyroscopeHold
from odometry.geometry.angles import wrap
from odometry.replays.estimates import Replay
from tests.odometry.estimation.sensor_drives import (
    STEP_S,
    WIDTH,
    drive,
    estimates_of,
    frames_of,
    noisy_poses,
)

STEP_RAD_S, BEGIN = 0.08, 400


@pytest.fixture(scope="module")
def driven():
    return drive(80.0)


def estimated(driven, rates, poses):
    noise = np.random.default_rng(5).normal(0, 0.005, driven.speeds_m_s.shape)
    speeds = driven.speeds_m_s + noise
    return estimates_of(frames_of(driven, poses=poses, yaw_rates=rates, speeds=speeds))


def changes(estimates):
    return [e for each in estimates for e in each.events if e.kind == "gyroscope_bias_changed"]


def stepped(driven):
    return driven.yaw_rates_rad_s + STEP_RAD_S * (driven.stamps_s > driven.stamps_s[BEGIN])


def test_a_step_is_found_within_seconds(driven, rng):
    estimates = estimated(driven, stepped(driven), noisy_poses(driven, rng))
    event = changes(estimates)[0]
    assert 0 < event.begin_s - driven.stamps_s[BEGIN] < 6
    assert f"{event.values[0]:.4f}" in event.text
    assert estimates[BEGIN + 100].gyro_bias_rad_s == pytest.approx(STEP_RAD_S, abs=0.03)
    assert estimates[-1].gyro_bias_rad_s == pytest.approx(STEP_RAD_S, abs=0.01)
    turned = wrap(Replay(tuple(estimates)).odometer().poses[-1, 2] - driven.poses[-1, 2])
    assert abs(turned) < 8 * STEP_RAD_S  # what it turned wrongly until then; the drive lasts 40 s


def drifted(driven, by_rad_s):
    return driven.yaw_rates_rad_s + by_rad_s * driven.stamps_s / driven.stamps_s[-1]


@pytest.mark.parametrize("by_rad_s", [-0.03, 0.03])
def test_a_slow_drift_is_followed(by_rad_s, rng):
    driven = drive(240.0)
    poses = noisy_poses(driven, rng, yaw_rad=0.003)
    estimates = estimated(driven, drifted(driven, by_rad_s), poses)
    assert len(changes(estimates)) >= 1
    off = [e.gyro_bias_rad_s - by_rad_s * e.stamp_s / 240.0 for e in estimates[1200:]]
    assert np.abs(off).max() < 0.004  # the walk of the settings alone lags by 0.010


def test_a_drift_is_detected_once_it_is_surer_than_the_scatter_of_spans():
    drift = tuple(0.015 * k / 48 + 0.002 * (-1) ** k for k in range(48))
    watch = BiasWatch(biases_rad_s=drift, by_treads_rad_s=drift, since=48)
    (bias, sigma), walk = drifted_bias(watch, 0.0)
    assert bias == pytest.approx(0.0138, abs=0.001)  # of the last 8 spans
    assert 0 < sigma < 0.001
    assert walk == 10.0
    assert drifted_bias(watch._replace(since=15), 0.0) is None
    assert drifted_bias(watch, 0.012) is None
    noisy = tuple(bias + 0.03 * (-1) ** k for k, bias in enumerate(drift))
    assert drifted_bias(watch._replace(biases_rad_s=noisy), 0.0) is None


def test_the_walk_that_a_drift_set_outlives_what_is_forgotten(driven, rng):
    frames = frames_of(driven, poses=noisy_poses(driven, rng), yaw_rates=driven.yaw_rates_rad_s)
    start = estimates_of(frames[:BEGIN])[-1]
    drifting = start.watch._replace(bias=BiasWatch(walk=3.0))
    same = GyroscopeHold(0.1, 0.0, 0.0, (start.mean, start.covariance), "a", is_found=True)
    frame = replace(frames[BEGIN], yaw_rate_rad_s=0.1)
    held = replace(start, watch=drifting._replace(hold=same))
    after = IcrEkf(WIDTH).step(held, frame, "a")
    assert after.watch.is_gyroscope_held
    assert after.watch.bias == BiasWatch(walk=3.0)


def test_a_step_is_found_by_positions_alone(driven, rng):
    poses = noisy_poses(driven, rng)
    poses[1:, 2] = np.nan
    estimates = estimated(driven, stepped(driven), poses)
    assert estimates[-1].gyro_bias_rad_s == pytest.approx(STEP_RAD_S, abs=0.02)


def test_nothing_is_detected_without_poses(driven):
    assert changes(estimated(driven, stepped(driven), None)) == []


@pytest.mark.parametrize(("seed", "scale"), [(0, 0.97), (1, 1.0), (2, 1.03), (3, 1.0)])
def test_noise_and_scale_are_no_change(driven, seed, scale):
    rng = np.random.default_rng(seed)
    rates = scale * driven.yaw_rates_rad_s + rng.normal(0, 0.02, len(driven.stamps_s))
    assert changes(estimated(driven, rates, noisy_poses(driven, rng, yaw_rad=0.03))) == []


def test_spans_hold_the_difference_of_gyroscope_and_estimate(rng):
    bias, watch = 0.04, BiasWatch()
    for k, rate in enumerate(rng.normal(0, 0.3, 100)):
        rates = Rates(rate + bias, rate, rate + 0.01)
        watch = watched(watch, rates, STEP_S, k * STEP_S, posed=True)
    np.testing.assert_allclose(watch.biases_rad_s, bias, atol=1e-12)
    np.testing.assert_allclose(watch.by_treads_rad_s, bias - 0.01, atol=1e-12)
    assert len(watch.biases_rad_s) in (9, 10)
    silent = watched(watch, Rates(np.nan, 0.1, 0.1), STEP_S, 10.0, posed=True)
    assert silent.lasts_s == 0.0
    assert silent.biases_rad_s == watch.biases_rad_s


def test_a_bias_that_is_estimated_already_is_no_change():
    biases = tuple(0.04 + 0.01 * (-1) ** k for k in range(30))
    watch = BiasWatch(biases_rad_s=biases, by_treads_rad_s=biases, since=30)
    assert changed_bias(watch, 0.04) is None
    bias, sigma = changed_bias(watch, 0.0)
    assert bias == pytest.approx(0.04, abs=0.01)
    assert sigma < 0.01


def test_poses_that_leave_gyroscope_and_treads_determine_no_bias():
    biases = tuple(0.04 + 0.01 * (-1) ** k for k in range(30))
    watch = BiasWatch(biases_rad_s=biases, by_treads_rad_s=(0.0,) * 30, since=30)
    assert changed_bias(watch, 0.0) is None
