"""Treads that turn the robot less than the gyroscope reads, or the other way, teach nothing."""

import math

import numpy as np
import pytest

from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.transition import ALPHA_LEFT, ALPHA_RIGHT, STATES, Y_LEFT, Y_RIGHT
from odometry.estimation.watches.contrary_treads import FOUND_RAD, MOST_S, stepped
from odometry.parameters import ParameterSet, TerrainParameters
from tests.odometry.estimation.sensor_drives import (
    ALPHAS,
    ICRS,
    STEP_S,
    WIDTH,
    drive,
    estimates_of,
    events_of,
    frames_of,
    noisy_poses,
)

BEGIN, END = 600, 700  # 60 s to 70 s
FAULTS = {
    "mirrored": lambda speeds: speeds[:, [0, 0]],
    "exchanged": lambda speeds: speeds[:, ::-1],
}


def pivoting(t):
    """Turns to either side, in which a tread goes backwards."""
    return 0.4 + 0.6 * math.sin(0.9 * t), 0.4 - 0.6 * math.sin(0.9 * t)


@pytest.fixture(scope="module")
def driven():
    return drive(90.0, speeds_of=pivoting)


def estimated(driven, fault=None, *, posed=True):
    rng = np.random.default_rng(3)
    speeds = driven.speeds_m_s + rng.normal(0, 0.005, driven.speeds_m_s.shape)
    if fault is not None:
        speeds[BEGIN:END] = FAULTS[fault](speeds[BEGIN:END])
    rates = driven.yaw_rates_rad_s + rng.normal(0, 0.01, len(speeds))
    poses = noisy_poses(driven, rng)
    if not posed:
        poses[BEGIN:] = np.nan
    return estimates_of(frames_of(driven, poses=poses, yaw_rates=rates, speeds=speeds))


def off(estimate):
    """By how many deviations ICRs and slip factors are off at most."""
    sigmas = np.sqrt(np.diag(estimate.covariance))
    true = np.array([*ICRS, *ALPHAS])
    return np.max(np.abs(estimate.mean[[3, 4, 5, 7, 8]] - true) / sigmas[[3, 4, 5, 7, 8]])


@pytest.mark.parametrize("fault", FAULTS)
def test_what_a_tread_reports_wrongly_teaches_nothing_and_is_said(driven, fault):
    estimates = estimated(driven, fault)
    (event,) = events_of(estimates)
    assert event.kind == "contrary_treads"
    assert 60.0 <= event.begin_s < 64.0
    assert 69.0 < event.end_s < 75.0
    assert off(estimates[END + 10]) < 3
    assert off(estimates[-1]) < 3


def test_without_poses_the_place_is_as_uncertain_as_the_way(driven):
    estimates = estimated(driven, "mirrored", posed=False)
    sigma_m = math.hypot(*np.sqrt(np.diag(estimates[END].covariance)[:2]))
    assert math.dist(estimates[END].mean[:2], driven.poses[END, :2]) < 3 * sigma_m


def test_a_drive_without_a_fault_is_the_same(driven):
    estimates = estimated(driven)
    assert events_of(estimates) == []
    assert all(one.watch.contrary is None or one.watch.contrary.found_s == 0 for one in estimates)


def test_a_set_whose_width_is_far_too_large_is_learned_in_the_end(driven):
    """Turns that are missing little by little are those of a wrong set, not of a fault."""
    values = {"y_left": 1.6, "y_right": -1.6, "x_icr": 0.0}
    known = TerrainParameters("icr", values, tuple(values), 1e-4 * np.eye(3))
    ekf = IcrEkf(WIDTH, ParameterSet({"a": known}))
    rates, poses = driven.yaw_rates_rad_s, noisy_poses(driven, np.random.default_rng(3))
    frames = frames_of(driven, poses=poses, yaw_rates=rates)
    estimates = [ekf.start(frames[0], "a")]
    for frame in frames[1:]:
        estimates.append(ekf.step(estimates[-1], frame, "a"))
    last = estimates[-1].mean
    assert last[Y_LEFT] - last[Y_RIGHT] == pytest.approx(ICRS[0] - ICRS[1], rel=0.3)


def belief(sigma=0.01):
    mean = np.zeros(STATES)
    mean[[Y_LEFT, Y_RIGHT, ALPHA_LEFT, ALPHA_RIGHT]] = 0.5, -0.5, 1.0, 1.0
    return mean, sigma**2 * np.eye(STATES)


def watched(speeds, yaw_rate, lasts_s, watch=None, *, begin_s=0.0, terrain="a", sigma=0.01):
    """The watch and all events after steps of 0.1 s."""
    events = ()
    for row in range(round(lasts_s / STEP_S)):
        at_s = begin_s + STEP_S * row
        watch, ended = stepped(
            *(watch, at_s, at_s + STEP_S),
            speeds_m_s=np.array(speeds),
            yaw_rate=yaw_rate,
            belief=belief(sigma),
            terrain=terrain,
        )
        events += ended
    return watch, events


@pytest.mark.parametrize(
    ("speeds", "yaw_rate", "sigma"),
    [
        ((-0.5, 0.5), 0.2, 0.01),
        ((-0.3, 0.3), 1.0, 0.01),
        ((0.5, 0.501), 0.15, 0.01),
        ((0.5, 0.5), 0.05, 0.01),
        ((0.0, 0.0), 1.0, 0.01),
        ((0.5, 0.5), 1.0, 0.4),
    ],
    ids=["slip", "more than half", "slow", "same", "at rest", "unknown ICRs"],
)
def test_these_are_not_contrary(speeds, yaw_rate, sigma):
    watch, events = watched(speeds, yaw_rate, 30.0, sigma=sigma)
    assert not watch.is_found
    assert events == ()


@pytest.mark.parametrize(
    ("speeds", "yaw_rate", "lasts_s"),
    [
        ((0.5, 0.6), 1.0, 2.0),
        ((0.3, -0.3), 1.0, 2.0),
        ((-0.3, 0.3), -1.0, 2.0),
        ((0.5, 0.5), 0.15, 10.0),
    ],
    ids=["one way", "exchanged", "exchanged, to the right", "the same to the last digit"],
)
def test_a_sum_of_missing_turns_is_found_and_ends_with_turns_that_agree(speeds, yaw_rate, lasts_s):
    watch, _ = watched(speeds, yaw_rate, 0.2)
    assert not watch.is_found
    watch, events = watched(speeds, yaw_rate, lasts_s, watch, begin_s=0.2)
    assert (watch.is_found, watch.since_s, events) == (True, 0.1, ())
    assert watch.missing_rad > FOUND_RAD
    agreeing = watched((-0.5, 0.5), 1.0, 3.0, watch, begin_s=2.2)
    assert not agreeing[0].is_found
    assert [event.kind for event in agreeing[1]] == ["contrary_treads"]


def test_it_ends_with_another_terrain_and_a_silent_gyroscope():
    watch, _ = watched((0.5, 0.5), 1.0, 2.0)
    assert watch.is_found
    other, events = watched((0.5, 0.5), 1.0, 0.1, watch, begin_s=2.0, terrain="b")
    assert not other.is_found
    assert len(events) == 1
    assert not watched((0.5, 0.5), math.nan, 0.1, watch, begin_s=2.0)[0].is_found


@pytest.mark.parametrize("interruption", [{"yaw_rate": math.nan}, {"terrain": "b"}])
def test_what_interrupts_it_does_not_let_it_begin_anew(interruption):
    """Ten seconds each: it is found for 20 s in all."""
    watch, found_s = None, 0.0
    for k in range(12):
        watch, _ = watched((0.5, 0.5), 1.0, 10.0, watch, begin_s=10.5 * k)
        found_s += 10.0 * watch.is_found
        watch, _ = watched(
            (0.5, 0.5),
            **{"yaw_rate": 1.0, **interruption},
            lasts_s=0.5,
            watch=watch,
            begin_s=10.5 * k + 10.0,
        )
    assert watch.is_believed
    assert found_s <= MOST_S + 10.0


def test_after_long_the_treads_are_believed_until_turns_agree_for_as_long():
    watch, events = watched((0.5, 0.5), 1.0, MOST_S + 3)
    assert (watch.is_believed, watch.is_found, len(events)) == (True, False, 1)
    watch, _ = watched((0.5, 0.5), 1.0, 60.0, watch)
    assert not watch.is_found
    watch, _ = watched((-0.5, 0.5), 1.0, MOST_S / 2, watch)
    assert watch.is_believed
    watch, _ = watched((0.5, 0.5), 0.0, MOST_S, watch)
    assert watch.is_believed  # a straight says nothing
    watch, _ = watched((-0.5, 0.5), 1.0, MOST_S, watch)
    assert not watch.is_believed
    assert watched((0.5, 0.5), 1.0, 2.0, watch)[0].is_found
