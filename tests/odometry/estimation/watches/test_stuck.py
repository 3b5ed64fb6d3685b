"""A robot whose treads drive while it stays: the filter learns nothing, and knows its place."""

import math

import numpy as np
import pytest

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.replays.run_end import ongoing
from tests.odometry.estimation.sensor_drives import (
    ALPHAS,
    ICRS,
    drive,
    estimates_of,
    events_of,
    frames_of,
    noisy_poses,
    weaving,
)

BEGIN, LASTS = 400, 60  # at 40 s, for 6 s
END = BEGIN + LASTS


def turning(_):
    """On the spot, to the left."""
    return -0.6, 0.6


@pytest.fixture(scope="module")
def driven():
    return drive(80.0)


def with_stop(driven, speeds_of=weaving, *, has_yaw=True):
    """The drive with a robot that is stuck: poses, speeds and yaw rates of longer arrays.

    Its treads go on as before, or as `speeds_of` says.
    """
    draw = np.random.default_rng(4)
    rows = np.r_[:BEGIN, np.full(LASTS, BEGIN), BEGIN : len(driven.stamps_s)]
    poses = driven.poses[rows] + draw.normal(0, (0.02, 0.02, 0.01), (len(rows), 3))
    poses[:, 2] = poses[:, 2] if has_yaw else math.nan
    speeds = driven.speeds_m_s[rows].copy()
    if speeds_of is not weaving:
        speeds[BEGIN:END] = speeds_of(0)
    speeds[BEGIN:END] *= draw.normal(1, 0.02, (LASTS, 2))
    rates = driven.yaw_rates_rad_s[rows] + draw.normal(0, 0.005, len(rows))
    rates[BEGIN + 1 : END + 1] = draw.normal(0, 0.005, LASTS)
    return rows, poses, speeds, rates


def estimated(driven, poses, speeds, rates=None, config=None):
    stamps = np.arange(len(poses)) * (driven.stamps_s[1] - driven.stamps_s[0])
    longer = type(driven)(stamps, poses, speeds, np.full(len(poses), math.nan))
    return estimates_of(frames_of(longer, poses=poses, yaw_rates=rates), config=config)


@pytest.mark.parametrize("speeds_of", [weaving, turning])
@pytest.mark.parametrize("by_gyroscope", [True, False])
def test_the_filter_learns_nothing_of_a_robot_that_is_stuck(driven, speeds_of, by_gyroscope):
    rows, poses, speeds, rates = with_stop(driven, speeds_of)
    estimates = estimated(driven, poses, speeds, rates if by_gyroscope else None)
    after = estimates[END + 5]
    assert after.alphas == pytest.approx(ALPHAS, abs=0.03)
    assert after.mean[3:6] == pytest.approx(ICRS, abs=0.1)
    assert np.sqrt(after.covariance[0, 0]) < 0.06
    off_m = [
        np.hypot(*(one.mean[:2] - driven.poses[row, :2]))
        for one, row in zip(estimates[BEGIN + 15 :], rows[BEGIN + 15 :], strict=True)
    ]
    assert max(off_m) < 0.35
    event = next(each for each in events_of(estimates) if each.kind == "stuck")
    assert event.begin_s == pytest.approx(40.0, abs=0.5)
    assert event.end_s == pytest.approx(46.0, abs=1.0)


def test_positions_alone_show_it_where_treads_lead_away(driven):
    _, poses, speeds, rates = with_stop(driven, has_yaw=False)
    estimates = estimated(driven, poses, speeds, rates)
    assert "stuck" in {event.kind for event in events_of(estimates)}
    assert estimates[END + 10].alphas == pytest.approx(ALPHAS, abs=0.05)


def test_positions_alone_say_nothing_of_turns_on_the_spot():
    driven = drive(60.0, speeds_of=lambda t: turning(t) if 30 < t < 40 else weaving(t))
    poses = noisy_poses(driven, np.random.default_rng(0))
    poses[:, 2] = math.nan
    estimates = estimates_of(frames_of(driven, poses=poses))
    assert "stuck" not in {event.kind for event in events_of(estimates)}


def test_meanwhile_the_covariance_covers_where_treads_lead(driven):
    _, poses, speeds, rates = with_stop(driven)
    estimates = estimated(driven, poses, speeds, rates)
    last = estimates[END - 5]
    (led,) = last.doubt.others
    apart_m = np.hypot(*(led.pose(last.mean) - last.mean[:3])[:2])
    assert apart_m > 2
    assert np.sqrt(np.trace(last.covariance[:2, :2])) > apart_m / 2


def held(driven, lasts=LASTS):
    """The robot drives on, and poses stay: another noise, the same place."""
    poses = noisy_poses(driven, np.random.default_rng(2))
    draw = np.random.default_rng(3)
    poses[BEGIN : BEGIN + lasts] = poses[BEGIN] + draw.normal(0, 0.01, (lasts, 3))
    return poses


def straight(_):
    """Ahead, after slip."""
    return 0.7 / ALPHAS[0], 0.7 / ALPHAS[1]


def test_poses_that_were_held_go_back_to_where_treads_have_led():
    driven = drive(80.0, speeds_of=straight)
    frames = frames_of(driven, poses=held(driven), yaw_rates=driven.yaw_rates_rad_s)
    estimates = estimates_of(frames)
    kinds = [event.kind for event in events_of(estimates)]
    assert kinds[-1] == "shifted_poses"
    assert "stuck" not in kinds
    off_m = [
        np.hypot(*(one.mean[:2] - pose[:2]))
        for one, pose in zip(estimates[END + 3 :], driven.poses[END + 3 :], strict=True)
    ]
    assert max(off_m) < 0.15


def test_poses_that_jump_elsewhere_were_held():
    driven = drive(80.0, speeds_of=straight)
    slipping = driven.speeds_m_s.copy()
    slipping[BEGIN:END] *= 2.5  # treads lead too far to be where poses go back to
    frames = frames_of(
        driven, poses=held(driven), yaw_rates=driven.yaw_rates_rad_s, speeds=slipping
    )
    events = {event.kind: event.text for event in events_of(estimates_of(frames))}
    assert "stuck" not in events
    assert "they were held" in events["held_poses"]


def test_a_gyroscope_that_turns_is_of_a_robot_that_moves():
    driven = drive(80.0, speeds_of=lambda _: (0.4, 0.9))
    frames = frames_of(driven, poses=held(driven), yaw_rates=driven.yaw_rates_rad_s)
    assert "stuck" not in {event.kind for event in events_of(estimates_of(frames))}


@pytest.mark.parametrize("seed", range(3))
def test_late_poses_and_a_robot_that_slips_are_not_stuck(driven, seed):
    late = np.roll(noisy_poses(driven, np.random.default_rng(seed)), 6, axis=0)
    late[:6] = driven.poses[0]
    rates = driven.yaw_rates_rad_s
    assert "stuck" not in {e.kind for e in events_of(estimated(driven, late, driven.speeds_m_s))}
    slipping = driven.speeds_m_s.copy()
    slipping[BEGIN:END] *= 3
    estimates = estimated(driven, noisy_poses(driven, np.random.default_rng(seed)), slipping, rates)
    assert "stuck" not in {event.kind for event in events_of(estimates)}


def test_a_robot_that_is_stuck_at_the_end_is_said(driven):
    _, poses, speeds, rates = with_stop(driven)
    last = estimated(driven, poses[: END - 5], speeds[: END - 5], rates[: END - 5])[-1]
    (event,) = ongoing(last.watch, last.stamp_s)
    assert event.kind == "stuck"
    assert "the robot was stuck" in event.text


def test_the_published_filter_watches_nothing(driven):
    _, poses, speeds, rates = with_stop(driven)
    estimates = estimated(driven, poses, speeds, rates, IcrEkfConfig(**PAPER))
    assert "stuck" not in {event.kind for event in events_of(estimates)}
