"""Models from positions without yaw, against what drove and against measured poses."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import IdentificationError
from odometry.identification.identify import identify
from odometry.identification.position_notes import UNNOTICED_S, position_notes
from odometry.identification.profile import with_profiles
from odometry.identification.start import SolverConfig
from odometry.identification.stretch_fit import windows_or_stretches
from odometry.windows.config import WindowConfig
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows
from tests.odometry.positions_drives import ICR, drive, emptied

ONE_START = SolverConfig(starts=1)


def fit_of(*runs, model="icr", **settings):
    found = identify(runs, model, solver_config=ONE_START, **settings)
    (ground,) = found.terrains.values()
    return ground.fit


@pytest.mark.parametrize("gyroscope", [False, True])
def test_parameters_come_back_without_noise(gyroscope):
    found = fit_of(emptied(drive(1, gyroscope=gyroscope)))
    assert found.noise is not None
    for name, value in ICR.items():
        assert found.values[name] == pytest.approx(value, abs=5e-3), name


def test_without_noise_they_are_those_of_full_poses():
    run = drive(2)
    with_yaw, without = fit_of(run), fit_of(emptied(run))
    assert with_yaw.noise is None
    for name in ICR:
        assert without.values[name] == pytest.approx(with_yaw.values[name], abs=1e-3), name


@pytest.mark.parametrize("gyroscope", [False, True])
def test_turning_and_moving_all_positions_changes_nothing(gyroscope):
    run = drive(3, noise_m=0.05, gyroscope=gyroscope)
    here = fit_of(emptied(run))
    there = fit_of(emptied(run, turned_rad=2.1, moved_m=(300.0, -80.0)))
    for name in ICR:
        assert there.values[name] == pytest.approx(here.values[name], rel=1e-4), name
        assert there.sigmas[name] == pytest.approx(here.sigmas[name], rel=1e-2), name


def test_a_column_without_numbers_is_not_read():
    """Any yaw may stand in a file in which most rows have none."""
    run = drive(4, noise_m=0.02)
    column = np.full(len(run.pose), np.nan)
    column[::3] = 17.0
    some = replace(run, pose=replace(run.pose, columns={**run.pose.columns, "yaw": column}))
    assert fit_of(some).values == fit_of(emptied(run)).values


def test_an_antenna_off_the_origin_is_undone():
    arm_m = (0.4, -0.25)
    for gyroscope in (False, True):
        found = fit_of(emptied(drive(5, arm_m=arm_m, gyroscope=gyroscope)))
        for name, value in ICR.items():
            assert found.values[name] == pytest.approx(value, abs=6e-3), name


def test_an_antenna_that_is_not_stated_looks_like_shifted_icrs():
    ahead = replace(emptied(drive(5, arm_m=(0.4, 0.0))), settings={})
    assert fit_of(ahead).values["x_icr"] == pytest.approx(ICR["x_icr"] - 0.4, abs=5e-3)
    aside = fit_of(replace(emptied(drive(5, arm_m=(0.0, 0.2))), settings={})).values
    for name in ("y_left", "y_right"):
        assert aside[name] == pytest.approx(ICR[name] - 0.2, abs=5e-3), name


@pytest.mark.parametrize("gyroscope", [False, True])
def test_late_stamps_look_like_the_x_icr_that_the_note_says(gyroscope):
    run = emptied(drive(6, gyroscope=gyroscope, noise_m=0.01))
    stamps_s = run.pose.stamps_s + UNNOTICED_S
    late = replace(run, pose=replace(run.pose, columns={**run.pose.columns, "t": stamps_s}))
    exact, found = fit_of(run), fit_of(late)
    note = position_notes(found)[-1]
    stated_m = float(note.partition("larger by ")[2].partition(" m")[0])
    assert found.values["x_icr"] - exact.values["x_icr"] == pytest.approx(stated_m, rel=0.3)


def test_a_bias_of_the_gyroscope_is_found():
    biased = fit_of(emptied(drive(6, gyroscope=True, bias_rad_s=0.02, noise_m=0.01)))
    assert biased.values["y_left"] == pytest.approx(ICR["y_left"], abs=0.02)
    assert biased.values["y_right"] == pytest.approx(ICR["y_right"], abs=0.02)


def test_a_scale_of_the_gyroscope_that_is_off_stays_within_the_intervals():
    """By 1.5 %, so that all widths are off by as much."""
    run = emptied(drive(6, gyroscope=True, noise_m=0.01))
    rates = {**run.imu.columns, "gyro_z": 1.015 * run.imu["gyro_z"]}
    found = fit_of(replace(run, imu=replace(run.imu, columns=rates)), model="icr_symmetric")
    exact = fit_of(run, model="icr_symmetric")
    assert found.values["b_hat"] == pytest.approx(exact.values["b_hat"] / 1.015, rel=2e-3)
    interval = found.intervals["b_hat"]
    assert interval.low < exact.values["b_hat"] < interval.high


def test_what_a_rate_is_the_mean_of_is_within_the_interval_of_x_icr():
    """Rates of 5 Hz, each the mean until the next: the way of 0.1 s, as another x_icr."""
    run = emptied(drive(6, gyroscope=True, noise_m=0.01))
    rates = run.imu["gyro_z"].reshape(-1, 4).mean(axis=1)
    columns = {"t": run.imu.stamps_s[::4], "gyro_z": rates}
    found = fit_of(replace(run, imu=replace(run.imu.rows(slice(None, None, 4)), columns=columns)))
    interval = found.intervals["x_icr"]
    assert abs(found.values["x_icr"] - ICR["x_icr"]) > 0.03
    assert interval.low < ICR["x_icr"] < interval.high
    quick = fit_of(run).intervals["x_icr"]
    assert quick.high - quick.low < 0.5 * (interval.high - interval.low)


@pytest.mark.parametrize("noise_m", [0.02, 0.3, 1.0])
def test_the_noise_is_found_and_more_of_it_needs_longer_stretches(noise_m):
    found = fit_of(emptied(drive(7, noise_m=noise_m, duration_s=300.0)), model="icr_symmetric")
    assert found.noise.position_m == pytest.approx(noise_m, rel=0.3)
    expected_m = np.clip(noise_m * np.sqrt(12 / 25) / 0.02, 10.0, 50.0)
    assert found.windows.travel_m.mean() == pytest.approx(expected_m, rel=0.4)
    words = position_notes(found)
    assert "the treads alone" in words[0]
    assert "[sensors] pose is not stated" in words[1]
    stated = replace(found, windows=replace(found.windows, arm_stated=True))
    assert "where it is off, x_icr, y_left and y_right are off" in position_notes(stated)[1]


def test_straight_drives_determine_no_widths():
    found = identify([emptied(drive(8, most_turn=0.0, noise_m=0.02))], "icr_symmetric")
    with pytest.raises(IdentificationError, match="b_hat"):
        found.require_determined()


@pytest.mark.parametrize("gyroscope", [False, True])
def test_a_circle_does_not_determine_where_it_points(gyroscope):
    """At one curvature a robot that drifts aside looks like one that points elsewhere."""
    run = emptied(drive(8, circle=True, noise_m=0.02, gyroscope=gyroscope))
    found = identify([run], "icr", solver_config=ONE_START)
    with pytest.raises(IdentificationError, match="x_icr"):
        found.require_determined()


def test_one_run_without_yaw_takes_the_yaw_of_none():
    with_yaw, without = drive(9, name="a"), emptied(drive(10, name="b"))
    config = WindowConfig()
    assert isinstance(windows_or_stretches([with_yaw], config), Windows)
    assert isinstance(windows_or_stretches([with_yaw, without], config), Stretches)


def test_stages_and_the_loss_in_radians_need_yaw():
    run = emptied(drive(11, duration_s=60.0))
    with pytest.raises(IdentificationError, match="in stages"):
        identify([run], "icr_slope")
    with pytest.raises(IdentificationError, match="linear"):
        identify([run], "icr_symmetric", solver_config=SolverConfig(loss="linear"))


def test_profiles_of_a_quadratic_loss_are_the_symmetric_intervals():
    config = SolverConfig(starts=1, loss="squares")
    run = emptied(drive(12, noise_m=0.02))
    found = identify([run], "icr_symmetric", solver_config=config)
    profiled = with_profiles(found, config)
    plain, curved = (next(iter(f.terrains.values())).fit.intervals for f in (found, profiled))
    for name, interval in plain.items():
        assert curved[name].low == pytest.approx(interval.low, rel=0.01)
        assert curved[name].high == pytest.approx(interval.high, rel=0.01)


def test_held_out_errors_are_small_beside_the_ideal_drive():
    found = identify([emptied(drive(13, noise_m=0.02))], "icr", solver_config=ONE_START)
    (ground,) = found.terrains.values()
    for held, ideal in (
        (ground.held_out.translation_per_m, ground.ideal.translation_per_m),
        (ground.held_out.rotation_per_m, ground.ideal.rotation_per_m),
    ):
        assert held.mean() < 0.3 * ideal.mean()
