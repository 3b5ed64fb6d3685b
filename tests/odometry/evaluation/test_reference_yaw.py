"""Whole turns of a reference: counted over the poses between, and not known where nothing says."""

from pathlib import Path

import numpy as np
import pytest

from odometry.evaluation.reference_yaw import counted_reference_yaw
from odometry.evaluation.relative import EvaluationConfig
from odometry.evaluation.score import window_errors
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from odometry.trajectory import Trajectory

RAD_S, STEP_S, POSE_S = 2.3, 0.5, 0.1


def table(name, **columns):
    return Table(Path(name), columns, np.arange(len(columns["t"])))


def wrapped(yaw_rad):
    return np.angle(np.exp(1j * yaw_rad))


@pytest.fixture
def spinning():
    """A robot that turns slower than its treads say by an unsteady share, and its way."""
    stamps_s = STEP_S * np.arange(240)
    share = 1 + 0.5 * np.sin(stamps_s / 7)
    yaw = np.append(0.0, np.cumsum(RAD_S * share[:-1] * STEP_S))
    treads = {"v_left": np.full(240, 0.3 - 1.6), "v_right": np.full(240, 0.3 + 1.6)}
    at_s = POSE_S * np.arange(int(stamps_s[-1] / POSE_S))
    poses = np.column_stack([np.zeros((len(at_s), 2)), np.interp(at_s, stamps_s, yaw)])
    x, y, turned = poses.T
    pose = table("pose.csv", t=at_s, x=x, y=y, yaw=wrapped(turned))
    odometry = table("odometry.csv", t=stamps_s, **treads)
    return Run(Path("spinning"), Robot(track_width=1.0), {}, odometry, pose), Trajectory(
        at_s, poses
    )


def test_few_poses_are_counted_over_those_between(spinning):
    run, way = spinning
    few = Trajectory(
        way.stamps_s[::25], np.column_stack([way.poses[::25, :2], wrapped(way.poses[::25, 2])])
    )
    counted = counted_reference_yaw(run, few)
    np.testing.assert_allclose(counted.yaw_rad, way.poses[::25, 2], atol=1e-9)
    assert not counted.part.any()
    errors = window_errors(run, way, few, EvaluationConfig(horizon_m=5.0))
    assert len(errors.rotation_per_m)
    assert errors.rotation_per_m.max() < 1e-9


def test_turns_that_nothing_counts_have_no_rotation(spinning):
    run, way = spinning
    alone = Run(run.folder, run.robot, {}, run.odometry, None)
    rare = Trajectory(
        way.stamps_s[::25], np.column_stack([way.poses[::25, :2], wrapped(way.poses[::25, 2])])
    )
    assert counted_reference_yaw(alone, rare).part[-1] > 0
    errors = window_errors(alone, way, rare, EvaluationConfig(horizon_m=5.0))
    assert len(errors.rotation_per_m)
    assert np.isnan(errors.rotation_per_m).any()
    known = errors.rotation_per_m[np.isfinite(errors.rotation_per_m)]
    assert (known < 1e-9).all()


def test_a_reference_without_yaw_has_none(spinning):
    run, way = spinning
    places = Trajectory(
        way.stamps_s, np.column_stack([way.poses[:, :2], np.full(len(way.poses), np.nan)])
    )
    counted = counted_reference_yaw(run, places)
    assert np.isnan(counted.yaw_rad).all()
    assert not counted.part.any()
