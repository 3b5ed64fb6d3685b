"""Measured travel against what modes say: loads on the tyres and faults of headings are put in."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.modes.checks.travel_check import WINDOWS_S, TravelCheck, travel_check
from odometry.modes.follow.answers import named_modes
from odometry.modes.identify.gain_spread import growing_power
from odometry.modes.identify.identify_velocity import identify_velocity_modes
from odometry.modes.models.mode_set import NONE_OF_THESE, UNDETERMINED
from odometry.modes.models.response import Record, Response
from odometry.modes.recorded.measured_steps import measured_travel
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from tests.odometry.modes.mode_examples import track, velocity_set

STEP_S, SIZE, NOISE_M = 0.02, 1500, 0.005
POWER = np.array([[1e-5, 1e-5], [1e-5, 1e-5]])


def run_of(factor=1.0, *, yaw_rad=0.0, gyroscope=True, turn_m=0.0):
    """A weave at 0.6 m/s for half a minute; the treads count `factor` times the way."""
    t = STEP_S * np.arange(SIZE)
    half = 0.2 * np.sin(2 * np.pi * t / 6)
    omega = 2 * half
    yaw = np.append(0.0, np.cumsum(omega[:-1]) * STEP_S)
    middle = yaw + omega * STEP_S / 2
    x, y = (np.append(0.0, np.cumsum(0.6 * f(middle[:-1])) * STEP_S) for f in (np.cos, np.sin))
    noise_m = NOISE_M * np.random.default_rng(3).normal(size=(2, SIZE))
    odometry = {"t": t, "v_left": factor * (0.6 - half), "v_right": factor * (0.6 + half)}
    if gyroscope:
        odometry["gyro_z"] = omega
    pose = {"t": t, "x": x + noise_m[0], "y": y + noise_m[1], "yaw": yaw + yaw_rad + turn_m * t}
    pose = {name: column[::5] for name, column in pose.items()}
    tables = [Table(Path("t.csv"), c, np.arange(len(c["t"])) + 2) for c in (odometry, pose)]
    return Run(Path("drive"), Robot(1.0), {}, *tables)


def modes():
    return replace(velocity_set((1.0, 1.0)).modes, speed_power=POWER)


def checked(run, of=None):
    of = of or modes()
    return travel_check(of.signals(run), of)


def test_travel_is_as_long_as_the_way():
    travel = measured_travel(run_of())
    assert travel.ahead_m.sum() == pytest.approx(0.6 * STEP_S * (SIZE - 5), rel=2e-3)
    np.testing.assert_allclose(travel.noise_m, NOISE_M, rtol=0.2)
    sum_m = np.hypot(*travel.turned_m.sum(axis=0))
    assert sum_m == pytest.approx(travel.ahead_m.sum(), rel=2e-3)


@pytest.mark.parametrize(("factor", "expected"), [(1.0, False), (1.06, True), (0.94, True)])
def test_treads_that_count_another_way_are_off(factor, expected):
    check = checked(run_of(factor))
    known = np.isfinite(check.ratio[:, 0])
    assert known[round((WINDOWS_S[0] + 0.7) / STEP_S) :].all()
    assert not known[: round(WINDOWS_S[0] / STEP_S)].any()
    np.testing.assert_allclose(check.ratio[known], 1 / factor, rtol=5e-3)
    assert (check.off[known] == expected).all()
    assert not check.off[~known].any()


@pytest.mark.parametrize("wrong", [{"yaw_rad": 0.5}, {"turn_m": 0.03}, {"yaw_rad": np.nan}])
def test_a_heading_at_fault_is_no_other_travel(wrong):
    """The gyroscope gives the direction but for a turn of the whole window."""
    assert not checked(run_of(**wrong)).off.any()


def test_without_a_gyroscope_headings_alone_tell():
    run, known = run_of(gyroscope=False, yaw_rad=1.0), run_of(gyroscope=False)
    of, signals = modes(), modes().signals(run_of())
    for one, expected in ((run, True), (known, False)):
        off = travel_check(replace(signals, travel=measured_travel(one)), of).off
        assert (off[round((WINDOWS_S[0] + 0.7) / STEP_S) :] == expected).all()


def test_nothing_is_known_without_positions_or_calibrated_speeds():
    assert checked(run_of(), velocity_set().modes) is None
    assert checked(replace(run_of(), pose=None)) is None


def test_a_mode_that_travels_otherwise_is_not_named_and_none_where_all_do():
    off = np.array([[False, False], [True, False], [False, True], [True, True]])
    known = track(["a"] * 4, ["a"] * 4, names=("a", "b"))
    answers = named_modes(replace(known, travel=TravelCheck(off, off * 0.9)), 0.9)
    assert answers.tolist() == ["a", UNDETERMINED, "a", NONE_OF_THESE]


def test_power_of_errors_grows_with_the_yaw_rate_as_put_in():
    """A speed is off by 0.1 m/s where the robot turns by 0.5 rad/s, and by nothing elsewhere."""
    turning = np.repeat([0.0, 0.5, 0.0, 0.5], 1000)
    errors = np.where(turning > 0, 0.1, 0.0)
    record = Record(STEP_S, np.column_stack([0.5 + errors, turning, *[np.full(4000, 0.5)] * 2]))
    response = Response(10.0, np.array([0.0, 5.0, 5.0]))
    steady, growing = growing_power([record], 0, response, by=1)
    assert steady == pytest.approx(0.0, abs=1e-4)
    assert growing == pytest.approx(2.0 * 0.1**2 / 0.5**2, rel=0.1)


def test_speed_power_is_identified_where_speeds_were_measured():
    known = replace(run_of(), settings={"run": {"terrain": "ice"}})
    power = identify_velocity_modes([known]).speed_power
    assert power.shape == (1, 2)
    assert (power < 0.1 * NOISE_M**2).all()  # positions err, and the robot travels as it should
    assert identify_velocity_modes([replace(known, pose=None)]).speed_power is None
