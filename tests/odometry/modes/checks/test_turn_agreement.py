"""Gyroscopes that are off against measured headings: each fault is put in, two modes 10 % apart."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.geometry.angles import wrap
from odometry.modes.checks.turn_agreement import HOLDS_S, WINDOWS_S, turns_disagree
from odometry.modes.follow.answers import named_modes
from odometry.modes.models.mode_set import UNDETERMINED
from odometry.modes.recorded.measured_steps import LATE_S, during, measured_turn, step_windows
from tests.odometry.modes.mode_examples import run_of, track, velocity_set

SIZE, TURN = 1500, 1.6
NOISE_RAD = 0.01  # of a heading
SLOWER = 10.0


def with_gyro(run, change):
    columns = dict(run.odometry.columns)
    columns["gyro_z"] = change(columns["gyro_z"])
    return replace(run, odometry=replace(run.odometry, columns=columns))


def disagree(run, turns=(TURN, 1.1 * TURN), bias_rad_s=0.0, sigma_rad_s=0.0):
    modes, size = velocity_set(turns).modes, len(run.odometry.stamps_s)
    bias = np.full(size, bias_rad_s), np.full(size, sigma_rad_s)
    return turns_disagree(modes.signals(run), modes, np.zeros(size, dtype=int), bias)


def drive():
    return run_of(TURN, size=SIZE)


def arc():
    """All of it to the left."""
    run = drive()
    left, same = np.full(SIZE, 0.4), np.ones(SIZE)
    odometry = run.odometry.columns | {"v_left": left, "v_right": 1.5 * left}
    odometry["gyro_z"] = 0.2 * TURN * same
    yaw = wrap(0.2 * TURN * run.pose.stamps_s)
    pose = replace(run.pose, columns=run.pose.columns | {"yaw": yaw})
    return replace(run, odometry=replace(run.odometry, columns=odometry), pose=pose)


def test_steps_of_headings_add_up_to_what_the_gyroscope_turned():
    turn = measured_turn(drive())
    assert turn.noise_rad == pytest.approx(NOISE_RAD, rel=0.3)
    off = turn.gyroscope_rad[np.flatnonzero(LATE_S == 0)[0]] - turn.heading_rad
    assert abs(off.sum()) < 0.06
    assert measured_turn(replace(drive(), pose=None)) is None


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda rates: rates, False),
        (lambda rates: 1.02 * rates, False),  # less than half of 10 %
        (lambda rates: 1.12 * rates, True),
        (lambda rates: 0.5 * np.tanh(rates / 0.5), True),  # reads less in fast turns
        (lambda rates: np.roll(rates, -20), False),  # a clock that is 0.4 s ahead
    ],
)
def test_a_gyroscope_is_off_by_the_measure_of_the_modes(change, expected):
    found = disagree(with_gyro(drive(), change))
    late = slice(round((WINDOWS_S[1] + 1.0) / 0.02), SIZE - 50)
    assert found[late].mean() == pytest.approx(float(expected), abs=0.1)


def test_a_window_in_which_poses_are_not_chained_says_nothing():
    run = with_gyro(drive(), lambda rates: 1.3 * rates)
    assert disagree(run).any()
    window = np.arange(len(run.pose.stamps_s)) // 20  # of 2 s each
    columns = run.pose.columns | {"window": window.astype(float)}
    assert not disagree(replace(run, pose=replace(run.pose, columns=columns))).any()


def test_modes_that_are_farther_apart_allow_more():
    run = with_gyro(drive(), lambda rates: 1.12 * rates)
    assert not disagree(run, (TURN, 1.5 * TURN)).any()


def test_the_bias_of_the_filters_is_no_error():
    run = with_gyro(arc(), lambda rates: rates + 0.05)
    assert disagree(run).mean() > 0.5
    assert not disagree(run, bias_rad_s=0.05).any()


def test_a_bias_that_is_not_known_well_may_be_what_one_side_is_off_by():
    run = with_gyro(arc(), lambda rates: rates + 0.05)
    assert not disagree(run, sigma_rad_s=0.02).any()


@pytest.mark.parametrize(("factor", "expected"), [(1.0, False), (1.12, True)])
def test_a_slow_robot_needs_longer_windows(factor, expected):
    """A tenth of the pace, a tenth of the rates: ten seconds turn it by 0.2 rad."""
    run = with_gyro(drive(), lambda rates: factor * rates)
    slow = {name: run.odometry[name] / SLOWER for name in ("v_left", "v_right", "gyro_z")}
    odometry = replace(run.odometry, columns=slow | {"t": SLOWER * run.odometry.stamps_s})
    pose = replace(run.pose, columns=run.pose.columns | {"t": SLOWER * run.pose.stamps_s})
    found = disagree(replace(run, odometry=odometry, pose=pose), sigma_rad_s=1e-4)
    assert found[SIZE // 2 : -50].mean() == pytest.approx(float(expected), abs=0.2)


def test_a_spike_is_no_scale_of_the_long_windows():
    """Of two rows together, which a median of three leaves."""
    late = 6.0 + WINDOWS_S[1] + HOLDS_S
    spike = 30.0 * (np.arange(SIZE) // 2 == 150)  # at 6 s
    found = disagree(with_gyro(drive(), lambda rates: rates + spike))
    assert not found[round(late / 0.02) + 30 :].any()


def test_nothing_is_said_without_headings_or_of_a_single_mode():
    assert disagree(replace(drive(), pose=None)) is None
    modes = velocity_set((TURN,), ("ice",)).modes
    signals = modes.signals(drive())
    bias = np.zeros(SIZE), np.zeros(SIZE)
    assert turns_disagree(signals, modes, np.zeros(SIZE, dtype=int), bias) is None


def test_what_a_window_says_is_forgotten():
    run = drive()
    shorter = replace(run, pose=run.pose.rows(slice(0, 60)))  # of the first 6 s
    found = disagree(with_gyro(shorter, lambda rates: 1.3 * rates))
    ends = round((5.9 + HOLDS_S) / 0.02)
    assert found[: ends - 50].any()
    assert not found[ends + 5 :].any()


def test_sums_and_integrals_are_those_written_out():
    begin_s, end_s = 0.1 * np.arange(40), 0.1 * np.arange(1, 41)
    windows = step_windows(begin_s, end_s, 2.0)
    np.testing.assert_allclose(windows.ends_s, [2.0, 2.5, 3.0, 3.5, 4.0])
    values = np.arange(40.0)
    np.testing.assert_allclose(windows.sums(values)[1], values[5:25].sum())
    holed = np.where(values == 30, np.nan, values)
    assert np.isnan(windows.sums(holed)).tolist() == [False, False, False, True, True]
    stamps_s = np.linspace(0.0, 4.0, 400)
    np.testing.assert_allclose(
        during(begin_s, end_s, stamps_s, np.array([stamps_s, 2 + 0 * stamps_s])),
        [(end_s**2 - begin_s**2) / 2, np.full(40, 0.2)],
        atol=1e-4,
    )


def test_a_mode_on_a_gyroscope_that_headings_contradict_is_not_named():
    known = replace(track(["a", "a"], ["a"] * 2), headings_disagree=np.array([False, True]))
    assert named_modes(known, 0.9).tolist() == ["a", UNDETERMINED]


def test_the_turn_of_a_step_in_which_the_gyroscope_was_silent_is_not_known():
    def silent(rates):
        stamps_s = drive().odometry["t"]
        return np.where((stamps_s > 10.0) & (stamps_s < 12.0), np.nan, rates)

    turn = measured_turn(with_gyro(drive(), silent))
    known = np.isfinite(turn.gyroscope_rad[np.flatnonzero(LATE_S == 0)[0]])
    assert not known[(turn.begin_s > 10.1) & (turn.end_s < 11.9)].any()
    assert known[(turn.end_s < 9.9) | (turn.begin_s > 12.1)].all()
