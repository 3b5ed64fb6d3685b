"""A robot that turns about another point than in the runs of identification has no name."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.checks.turning_point_check import HOLDS_S, turning_point_check
from odometry.modes.follow.track import follow_modes
from odometry.modes.identify.turning_range import turning_range
from odometry.modes.models.mode_set import DWELL_S, ModeSet
from odometry.modes.models.mode_set_file import read_mode_set, write_mode_set
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.bank_inputs import velocity_signals
from odometry.modes.recorded.turning_points import WINDOW_S, turning_points
from odometry.windows.recorded.measured_poses import YAW_FOUND
from tests.odometry.modes.mode_drives import ROBOT, run_of_tables, table

STEP_S, LASTS_S, NOISE_M = 0.1, 60.0, 0.01


def drive(seed, ahead_m, *, turns_until_s=LASTS_S, drift_m_s=(0.0, 0.0), **columns):
    """Poses of a robot that turns about a point so far ahead (N,) or alone of its origin."""
    rng = np.random.default_rng(seed)
    stamps_s = np.arange(0.0, LASTS_S, STEP_S)
    omega = np.repeat(rng.uniform(-0.5, 0.5, 30), 20) * (stamps_s < turns_until_s)
    fine = 10
    rates = np.repeat(omega, fine)
    yaw = np.cumsum(rates) * STEP_S / fine
    aside = -np.repeat(np.broadcast_to(ahead_m, stamps_s.shape), fine) * rates
    velocity = (0.5 + 1j * aside) * np.exp(1j * yaw) + complex(*drift_m_s)
    place = np.cumsum(velocity) * STEP_S / fine + rng.normal(0, NOISE_M, (2, len(yaw))).T @ [1, 1j]
    poses = {"t": stamps_s, "x": place.real[::fine], "y": place.imag[::fine]}
    poses |= {"yaw": yaw[::fine] + rng.normal(0, 0.005, len(stamps_s))} | columns
    treads = {"v_left": 0.5 - omega / 4, "v_right": 0.5 + omega / 4, "gyro_z": omega}
    return run_of_tables({"t": stamps_s} | treads, pose=poses)


def modes(least_m=0.08, most_m=0.12):
    noise = np.full((1, 2), 1e-4)
    A, B = -5.0 * np.eye(2)[None], np.array([[[2.5, 2.5], [-5.0, 5.0]]])
    points = {"turning_least_m": least_m, "turning_most_m": most_m}
    return VelocityModes(("tar",), A, B, noise, noise, track_width=ROBOT.track_width, **points)


@pytest.mark.parametrize("drift_m_s", [(0.0, 0.0), (0.03, -0.02)])
@pytest.mark.parametrize("ahead_m", [-0.2, 0.0, 0.15])
def test_windows_find_the_point_also_beside_a_drift(ahead_m, drift_m_s):
    found = turning_points(drive(0, ahead_m, drift_m_s=drift_m_s))
    off = (found.ahead_m - ahead_m) / found.sigma_m
    assert found.sigma_m.max() < 0.05
    assert np.sqrt(np.mean(off**2)) < 1.6


def test_a_load_that_shifts_is_refused_after_a_window_and_straights_keep_that():
    stamps_s = np.arange(0.0, LASTS_S, STEP_S)
    run = drive(1, np.where(stamps_s < 20, 0.1, -0.15), turns_until_s=50.0)
    off = turning_point_check(velocity_signals(run), modes())
    assert not off[stamps_s < 20].any()
    assert off[stamps_s > 20 + WINDOW_S].all()
    before = drive(1, 0.1)
    assert not turning_point_check(velocity_signals(before), modes()).any()
    assert HOLDS_S > 10.0


def test_without_what_it_needs_there_is_no_test():
    run = drive(2, 0.1)
    signals = velocity_signals(run)
    assert turning_point_check(signals, modes(np.nan, np.nan)) is None
    assert turning_point_check(replace(signals, turning_points=None), modes()) is None
    assert turning_points(replace(run, pose=None)) is None
    assert turning_points(drive(2, 0.1, **{YAW_FOUND: np.full(600, 0.01)})) is None


def test_a_new_chain_of_poses_begins_another_step():
    """Poses displaced by a metre where the window of chained poses changes."""
    run = drive(3, 0.1)
    later = run.pose.stamps_s > 30
    moved = run.pose.columns | {"y": run.pose["y"] + later, "window": later.astype(float)}
    chained, torn = (
        turning_points(replace(run, pose=table({k: moved[k] for k in moved if k != without})))
        for without in ("", "window")
    )
    assert chained.sigma_m.max() < 0.05 < torn.sigma_m.max()


def test_the_runs_of_identification_give_the_range_of_points():
    same = [drive(seed, 0.1) for seed in range(4)]
    assert turning_range(same) == pytest.approx((0.1, 0.1), abs=0.02)
    apart = [*same, drive(4, 0.0), drive(5, 0.15)]
    assert turning_range(apart) == pytest.approx((0.0, 0.15), abs=0.02)
    assert np.isnan(turning_range([replace(same[0], pose=None)])).all()
    assert np.isnan(turning_range(same[:1])).all()


def test_velocity_modes_are_followed_with_it_also_from_a_file(tmp_path):
    run, file = drive(4, -0.15), tmp_path / "set.toml"
    write_mode_set(file, ModeSet(modes(), np.array([DWELL_S])))
    read = read_mode_set(file)
    assert (read.modes.turning_least_m, read.modes.turning_most_m) == (0.08, 0.12)
    track = follow_modes(run, read)
    np.testing.assert_array_equal(track.centre, track.stamps_s >= WINDOW_S)
    write_mode_set(file, ModeSet(modes(np.nan, np.nan), np.array([DWELL_S])))
    assert follow_modes(run, read_mode_set(file)).centre is None
