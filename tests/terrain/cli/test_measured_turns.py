"""Positions without yaw before the verbs that watch how the robot turns."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.errors import OdometryError, RunFolderError
from odometry.tables.table import Table
from terrain.cli.recordings import with_turns, with_yaw_rates
from tests.odometry.positions_drives import drive, emptied


def test_a_yaw_that_was_measured_is_left_alone():
    run = drive(1, duration_s=20.0)
    assert with_turns([run])[0] is run


def test_with_a_gyroscope_it_is_found_and_said(capsys):
    (found,) = with_turns([emptied(drive(2, duration_s=60.0, gyroscope=True))])
    assert np.isfinite(found.pose["yaw"]).all()
    assert "Note: run: yaw was not measured; it is found from positions" in capsys.readouterr().err


def test_a_lever_arm_is_undone_and_stated_no_more():
    (found,) = with_turns([drive(5, duration_s=20.0, arm_m=(0.5, 0.2))])
    assert found.sensors.pose_m is None
    np.testing.assert_allclose(found.pose["x"], drive(5, duration_s=20.0).pose["x"], atol=1e-9)


def test_without_a_yaw_rate_it_is_refused():
    with pytest.raises(RunFolderError, match="how the robot turned is not known"):
        with_turns([emptied(drive(3, duration_s=20.0))])


def test_a_yaw_rate_of_velocity_csv_does_without_positions(capsys):
    rows = {
        "t": np.arange(3.0),
        "vx": np.full(3, np.nan),
        "vy": np.full(3, np.nan),
        "wz": np.ones(3),
    }
    velocity = Table(Path("velocity.csv"), rows, np.arange(3) + 2)
    (found,) = with_turns([replace(emptied(drive(4, duration_s=20.0)), velocity=velocity)])
    assert found.pose is None
    assert "is not used" in capsys.readouterr().err


def test_positions_that_determine_no_yaw_stay_without_one_where_a_gyroscope_is_enough(capsys):
    run = emptied(drive(12, noise_m=16.0, duration_s=60.0, gyroscope=True))
    with pytest.raises(OdometryError, match="do not determine it"):
        with_turns([run])
    assert with_yaw_rates([run]) == [run]
    said = capsys.readouterr().err
    assert "Note: run: yaw was not measured" in said
    assert "velocity modes need no yaw: no heading confirms the gyroscope" in said


def test_a_yaw_that_positions_determine_is_found_beside_a_gyroscope_too():
    run = emptied(drive(2, duration_s=60.0, gyroscope=True))
    (found,) = with_yaw_rates([run])
    np.testing.assert_array_equal(found.pose["yaw"], with_turns([run])[0].pose["yaw"])


def test_without_a_yaw_rate_it_is_refused_there_too():
    with pytest.raises(RunFolderError, match="how the robot turned is not known"):
        with_yaw_rates([emptied(drive(3, duration_s=20.0))])
