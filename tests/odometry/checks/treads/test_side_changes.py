"""A scale of one side that changes, a dead zone, play, and moments in which a wheel spins free."""

import re

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.treads.play import play
from odometry.checks.treads.side_changes import side_changes
from odometry.checks.unexplained.moments_of_spin import moments_of_spin
from tests.odometry.checks.drives import PERIOD_S, drive, stepping
from tests.odometry.checks.faulty import SENSORS, put, treads
from tests.odometry.checks.treads.test_scale_change import later


def to_and_fro(seed=0):
    """Forwards for 12 s, backwards for 6 s, at speeds and with turns of all sizes."""
    at_s = PERIOD_S * np.arange(3200)
    speed = np.clip(40 * np.sin(2 * np.pi * at_s / 18) + 20, -0.7, 0.9)
    return drive(speed * (1 + 0.7 * np.sin(at_s / 4)), 0.5 * np.sin(at_s / 1.7), seed=seed)


def changed(run, name, change):
    return put(run, "odometry", **{name: change(run.odometry[name])})


def disagreement(run):
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "sensors_disagree"
    return found.seen


@pytest.mark.parametrize(("sensors", "factor"), list(zip(SENSORS, (1.3, 1.35, 1.3), strict=True)))
def test_a_scale_that_changes_is_not_one_that_holds(factor, sensors):
    (found,) = check_recording(SENSORS[sensors](later(stepping(), 1.0, factor))).at(Level.WARNING)
    change = re.search("From about (.*) s on v_right reads about (.*) times", found.cause)
    assert float(change[1]) == pytest.approx(0.4 * 160, abs=2)
    assert float(change[2]) == pytest.approx(factor, abs=0.06)
    assert "or that tread slips there more" in found.cause


@pytest.mark.parametrize("sensors", SENSORS)
def test_a_small_change_is_not_one_that_holds(sensors):
    seen = disagreement(SENSORS[sensors](later(stepping(), 1.0, 1.18)))
    change = re.search("right tread turns the robot (.*) times .* about (.*) s on as before", seen)
    assert float(change[1]) == pytest.approx(1 / 1.18, abs=0.05)
    assert float(change[2]) == pytest.approx(0.4 * 160, abs=8)


@pytest.mark.parametrize("sensors", SENSORS)
def test_a_large_change_has_a_name(sensors):
    (found,) = check_recording(SENSORS[sensors](later(stepping(), 1.0, 1.6))).at(Level.WARNING)
    assert "s on v_right reads about 1.6 times the motion of its tread" in found.cause


def test_a_change_that_noise_hides_is_not_said():
    noise = 0.15 * np.random.default_rng(0).standard_normal(3200)
    assert side_changes(Evidence(later(stepping(), 1.0, 1.25)))
    noisy = changed(later(stepping(), 1.0, 1.25), "gyro_z", lambda rate: rate + 5 * noise)
    assert not side_changes(Evidence(noisy))


def dead_zone(values, below_m_s):
    return np.sign(values) * np.maximum(np.abs(values) - below_m_s, 0)


@pytest.mark.parametrize("sensors", SENSORS)
def test_a_dead_zone_is_no_other_scale_of_one_side(sensors):
    run = changed(to_and_fro(), "v_left", lambda v: dead_zone(v, 0.15))
    assert "the left tread reads too little, or too much, while it moves (a dead zone" in (
        disagreement(SENSORS[sensors](run))
    )


def test_a_dead_zone_of_a_drive_that_only_goes_forwards_may_be_an_offset():
    run = changed(stepping(), "v_left", lambda v: dead_zone(v, 0.15))
    found = check_recording(run).findings[0]
    assert found.name == "tread_offset"
    assert "a dead zone" in found.cause


@pytest.mark.parametrize("sensors", ["gyroscope and poses", "gyroscope"])
def test_a_scale_of_one_direction_is_noticed(sensors):
    run = changed(to_and_fro(), "v_right", lambda v: np.where(v < 0, 1.3 * v, v))
    seen = disagreement(SENSORS[sensors](run))
    assert re.search(r"right tread turns the robot 0\.7[0-9] times as much backwards", seen)


@pytest.mark.parametrize("sensors", SENSORS)
@pytest.mark.parametrize("driven", [stepping, to_and_fro])
def test_one_scale_all_along_says_nothing_of_changes(driven, sensors):
    for run in (driven(), treads(driven(), lambda left, right: (1.3 * left, right))):
        evidence = Evidence(SENSORS[sensors](run))
        assert not side_changes(evidence) + play(evidence) + moments_of_spin(evidence)


@pytest.mark.parametrize("sensors", SENSORS)
def test_one_side_of_another_scale_keeps_its_name(sensors):
    run = treads(stepping(), lambda left, right: (1.3 * left, right))
    assert check_recording(SENSORS[sensors](run)).findings[0].name == "treads_unequal"


def with_play(speeds, gap_m):
    """What an encoder on the motor reads that turns freely by a gap after each reversal."""
    read, slack_m = np.empty_like(speeds), 0.0
    for row, speed in enumerate(speeds):
        moved_m = slack_m + speed * PERIOD_S
        slack_m = float(np.clip(moved_m, 0, gap_m))
        read[row] = (moved_m - slack_m) / PERIOD_S
    return read


def test_play_is_noticed_by_the_way_that_turns_lack():
    run = changed(to_and_fro(), "v_left", lambda v: with_play(v, 0.2))
    seen = disagreement(run)
    assert re.search("the left tread moves by 0.(1[5-9]|2) m unread at each reversal", seen)


def spinning(run, name, moments_s):
    at_s = run.odometry.stamps_s
    speed = run.odometry[name].copy()
    for moment_s in moments_s:
        speed += np.where((at_s >= moment_s) & (at_s < moment_s + 0.5), 0.8, 0.0)
    return put(run, "odometry", **{name: speed})


@pytest.mark.parametrize("sensors", ["gyroscope and poses", "gyroscope"])
def test_a_wheel_that_often_spins_free_is_noticed(sensors):
    run = spinning(stepping(), "v_right", np.arange(10.0, 150.0, 14.0))
    assert "v_right reads faster" in disagreement(SENSORS[sensors](run))


def test_few_moments_or_moments_of_both_sides_are_no_wheel_that_spins():
    few = spinning(stepping(), "v_right", np.arange(10.0, 50.0, 14.0))
    both = spinning(stepping(), "v_right", np.arange(10.0, 150.0, 14.0))
    both = spinning(both, "v_left", np.arange(17.0, 150.0, 14.0))
    assert not moments_of_spin(Evidence(few)) + moments_of_spin(Evidence(both))
