"""Positions that come in steps: their noise in the filter, and repeats that are not frozen."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.preparation.rounded_positions import with_rounding
from terrain.main_job import run_odometry
from tests.odometry.checks.drives import drive

STEP_M, NORTHING_M = 0.5, 4_512_345.6
FALSE = {"frozen_poses", "held_poses", "moved_at_rest", "reinitialised", "stuck"}


@pytest.fixture(scope="module")
def lively():
    at_s = 0.05 * np.arange(4000)
    return drive(0.5 + 0.2 * np.sin(at_s / 7), 0.4 * np.sin(at_s / 5), sigma_m=0.01)


def with_positions(run, change, *, has_yaw=True):
    columns = {name: change(run.pose[name]) for name in ("x", "y")}
    columns["yaw"] = run.pose["yaw"] if has_yaw else np.full(len(run.pose), np.nan)
    return replace(run, pose=replace(run.pose, columns={**run.pose.columns, **columns}))


def rounded(column):
    return np.round(column / STEP_M) * STEP_M


def single(column):
    """A large coordinate in single precision, of which half a metre is left."""
    return (column + NORTHING_M).astype(np.float32).astype(float) - NORTHING_M


def figures(run, config=None):
    stamps_s, positions = run.pose.stamps_s, run.pose.stack("x", "y")
    return with_rounding(stamps_s, positions, config or IcrEkfConfig())


@pytest.mark.parametrize("change", [rounded, single])
def test_steps_are_noise_that_values_in_a_row_share(lively, change):
    config, (event,) = figures(with_positions(lively, change))
    lasting_m, together_m, step_m = event.values
    assert step_m == config.position_step_m == pytest.approx(STEP_M)
    assert lasting_m == config.lasting_sigma_m == pytest.approx(STEP_M / np.sqrt(12))
    # at 10 Hz and half a metre a second the robot is in a step for ten poses and more
    assert together_m == pytest.approx(lasting_m * np.sqrt(14), rel=0.4)
    assert config.position_sigma_m == pytest.approx(np.hypot(together_m, 0.05))


@pytest.mark.parametrize(
    "change", [lambda column: column, lambda column: np.round(column, 3)], ids=["as it is", "mm"]
)
def test_other_positions_change_nothing(lively, change):
    assert figures(with_positions(lively, change)) == (IcrEkfConfig(), ())


def test_more_noise_that_is_stated_stays(lively):
    stated = IcrEkfConfig(position_sigma_m=2.0)
    assert figures(with_positions(lively, rounded), stated) == (stated, ())


@pytest.mark.parametrize("has_yaw", [True, False])
def test_a_run_is_as_sure_as_rounding_lets_it(lively, has_yaw):
    replay = run_odometry(with_positions(lively, rounded, has_yaw=has_yaw), vision=False).replay
    kinds = {event.kind for event in replay.events}
    assert "rounded_positions" in kinds
    assert not kinds & FALSE
    later = slice(len(replay.stamps_s) // 2, None)
    true = [
        np.interp(replay.stamps_s, lively.pose.stamps_s, lively.pose[name]) for name in ("x", "y")
    ]
    off_m = (replay.means[:, :2] - np.transpose(true))[later]
    assert np.mean(np.abs(off_m) > 3 * replay.sigmas[later, :2]) < 0.02
    assert np.sqrt(np.mean(off_m**2)) < STEP_M / np.sqrt(12)
