"""Positions without yaw, an antenna off the centre, and a heading that nobody measured."""

import numpy as np
import pytest

from odometry.estimation import filter_start
from odometry.estimation.config import IcrEkfConfig
from tests.odometry.estimation.sensor_drives import (
    distance,
    drive,
    estimates_of,
    frames_of,
    noisy_poses,
    standing,
    turned,
)

START = (4.0, -2.0, 2.2)


def positions_of(poses):
    return np.column_stack([poses[:, :2], np.full(len(poses), np.nan)])


@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize("with_gyroscope", [True, False])
def test_the_heading_is_found_from_the_course(direction, with_gyroscope, rng):
    """Forward and backward, within 3 degrees and as sure as it says."""
    driven = drive(20.0, start=START, direction=direction)
    rates = driven.yaw_rates_rad_s if with_gyroscope else None
    poses = positions_of(noisy_poses(driven, rng))
    estimates = estimates_of(frames_of(driven, poses=poses, yaw_rates=rates))
    (event,) = (event for e in estimates for event in e.events)
    assert event.kind == "initial_yaw"
    assert event.text.startswith("the yaw at the start was found: ")
    yaw, sigma = event.values
    off = abs(np.angle(np.exp(1j * (yaw - START[2]))))
    assert off < 3 * sigma
    assert off < np.radians(3) or not with_gyroscope
    assert event.begin_s == 0
    assert event.end_s < 12
    found = next(k for k, e in enumerate(estimates) if e.course is None)
    travelled = np.abs(driven.speeds_m_s[:found]).mean(axis=1).sum() * 0.1
    assert 5 < travelled < 9
    assert distance(estimates[-1], driven) < 0.1
    assert abs(turned(estimates[-1], driven)) < 0.05


def test_while_the_robot_stands_no_heading_is_estimated(rng):
    driven = drive(20.0, speeds_of=standing, start=START)
    poses = positions_of(noisy_poses(driven, rng))
    last = estimates_of(frames_of(driven, poses=poses))[-1]
    assert last.course is not None
    assert np.sqrt(last.covariance[2, 2]) > 1.5
    assert last.events == ()


def test_noise_of_a_metre_takes_a_longer_way(rng):
    """Residuals give the noise, whatever the setting says."""
    driven = drive(60.0, start=START)
    poses = positions_of(noisy_poses(driven, rng, position_m=0.5))
    estimates = estimates_of(frames_of(driven, poses=poses, yaw_rates=driven.yaw_rates_rad_s))
    (event,) = (event for e in estimates for event in e.events if event.kind == "initial_yaw")
    yaw, sigma = event.values
    assert abs(np.angle(np.exp(1j * (yaw - START[2])))) < 3 * sigma
    assert event.end_s > 6


def test_a_pose_with_yaw_ends_the_search(rng):
    driven = drive(10.0, speeds_of=standing, start=START)
    poses = positions_of(noisy_poses(driven, rng))
    poses[50:, 2] = START[2]
    estimates = estimates_of(frames_of(driven, poses=poses))
    assert estimates[49].course is not None
    assert estimates[50].course is None
    assert estimates[50].mean[2] == pytest.approx(START[2], abs=0.01)
    assert distance(estimates[-1], driven) < 0.05


@pytest.mark.parametrize("with_gyroscope", [True, False])
def test_a_yaw_that_comes_late_says_less_of_the_start(with_gyroscope, rng):
    """Meanwhile the robot turned on the spot, by treads whose ICRs are hardly known."""
    driven = drive(20.0, speeds_of=lambda _: (-0.2, 0.2), start=START)
    poses = noisy_poses(driven, rng)
    poses[:80, 2] = np.nan
    rates = driven.yaw_rates_rad_s if with_gyroscope else None
    estimates = estimates_of(frames_of(driven, poses=poses, yaw_rates=rates))
    event = next(event for e in estimates for event in e.events)
    yaw, sigma = event.values
    assert "a pose with a yaw came" in event.text
    assert abs(np.angle(np.exp(1j * (yaw - START[2])))) < 3 * sigma
    assert (sigma < 0.2) == with_gyroscope  # 8 s with its bias
    found = estimates[80]
    assert found.covariance[2, 2] < 0.1**2
    assert abs(np.angle(np.exp(1j * (found.mean[2] - driven.poses[80, 2])))) < 0.1


def test_an_antenna_off_the_centre_turns_with_the_robot(rng):
    """Positions of a point 0.8 m ahead and 0.3 m to the left; without it x_icr would be off."""
    lever = np.array([0.8, 0.3])
    driven = drive(90.0)
    cosine, sine = np.cos(driven.poses[:, 2]), np.sin(driven.poses[:, 2])
    poses = noisy_poses(driven, rng)
    poses[:, 0] += cosine * lever[0] - sine * lever[1]
    poses[:, 1] += sine * lever[0] + cosine * lever[1]
    frames = frames_of(driven, poses=poses, yaw_rates=driven.yaw_rates_rad_s)
    known = estimates_of(frames, lever_m=tuple(lever))[-1]
    assert distance(known, driven) < 0.05
    assert known.mean[5] == pytest.approx(-0.08, abs=0.05)
    unknown = estimates_of(frames)[-1]
    assert unknown.mean[5] < -0.5
    begun = estimates_of(frames[:1], lever_m=tuple(lever))[0]
    np.testing.assert_allclose(begun.mean[:2], 0, atol=0.1)


def test_yaw_alone_corrects_the_yaw(rng):
    driven = drive(20.0)
    poses = noisy_poses(driven, rng)
    poses[1:, :2] = np.nan
    last = estimates_of(frames_of(driven, poses=poses))[-1]
    assert abs(turned(last, driven)) < 0.03
    assert last.innovation.residual.shape == (1,)


def test_positions_alone_are_enough_for_a_filter_that_knows_its_heading(rng):
    driven = drive(60.0)
    poses = noisy_poses(driven, rng)
    poses[1:, 2] = np.nan
    config = IcrEkfConfig()
    last = estimates_of(frames_of(driven, poses=poses, yaw_rates=driven.yaw_rates_rad_s), config)[
        -1
    ]
    assert distance(last, driven) < 0.05
    assert abs(turned(last, driven)) < 0.03


def test_an_unknown_bias_widens_the_yaw_by_half_of_what_it_turned(rng, monkeypatch):
    """The course gives the yaw of its middle: the search takes 6 m, here at a tenth of the speed.

    A wide yaw is said in words.
    """
    monkeypatch.setattr(filter_start, "WIDE_RAD", 0.06)

    def slowly(t):
        return np.array([0.1, 0.1]) + 0.0 * t

    driven = drive(80.0, speeds_of=slowly, start=START)
    poses = positions_of(noisy_poses(driven, rng))
    rates = driven.yaw_rates_rad_s + 0.01
    estimates = estimates_of(frames_of(driven, poses=poses, yaw_rates=rates))
    (event,) = (event for e in estimates for event in e.events if event.kind == "initial_yaw")
    found = next(k for k, e in enumerate(estimates) if e.course is None)
    bias_sigma = np.sqrt(estimates[found - 1].covariance[6, 6])
    drifted = bias_sigma * (event.end_s - event.begin_s) / 2
    assert event.values[1] > drifted > 0.06
    assert "that is wide" in event.text
