"""What another program's headings show, without files."""

import numpy as np
import pytest

from odometry.evaluation.other_odometry import Judge
from odometry.evaluation.relative import EvaluationConfig
from odometry.geometry import se3
from odometry.trajectory import SpatialTrajectory, Trajectory
from terrain.other_odometry.other_headings import order_fault, pose_fault
from terrain.other_odometry.shared_turns import shared_pieces

AT_S = np.arange(0.0, 60.0, 0.1)


@pytest.fixture
def ours(rng):
    """A drive at 0.5 m/s whose turns never repeat."""
    turn = np.interp(AT_S, np.arange(0.0, 62.0, 1.5), rng.uniform(-0.8, 0.8, 42))
    yaw = np.concatenate([[0.0], np.cumsum(turn[:-1] * 0.1)])
    x, y = (np.cumsum(0.05 * of(yaw)) for of in (np.cos, np.sin))
    return Trajectory(AT_S, np.column_stack([x, y, yaw]))


def turning_by(ours, share, scale=1.0):
    """The same drive with headings that go less far, and another scale."""
    return Trajectory(AT_S, ours.poses * [scale, scale, share])


def judged_by(ours):
    travel_m = 0.5 * AT_S
    return Judge(ours, travel_m, ours, ours, np.zeros(2), EvaluationConfig())


def test_headings_that_follow_ours_as_read_are_not_read_otherwise(ours, rng):
    """Neither where the same turns would follow ours in another order of the numbers."""
    poses = ours.poses + rng.normal(0, 0.02, ours.poses.shape)
    other = Trajectory(AT_S, poses)
    readings = {"its quaternions are in another order": ours.poses[:, 2]}
    assert pose_fault(other, judged_by(ours), readings) is None
    fault = pose_fault(turning_by(ours, 0.0), judged_by(ours), readings)
    assert fault.note.startswith("its quaternions are in another order")


def test_a_level_body_whose_cosine_is_rounded_above_one_is_not_tilted():
    """Rotations of files: the last digit of a product of unit vectors may be one too many."""
    level = np.tile(se3.pose(np.zeros(3), np.eye(3)), (3, 1, 1))
    level[:, 2, 2] = np.nextafter(1.0, 2.0)
    assert order_fault(SpatialTrajectory(np.arange(3.0), level), "tum") == ""


def test_a_drive_that_hardly_turns_shows_no_dead_heading(ours):
    """Where it turns enough, the same heading is a placeholder."""
    straight = turning_by(ours, 0.3 / np.ptp(ours.poses[:, 2]))
    dead = turning_by(ours, 0.0, scale=1.01)
    assert pose_fault(dead, judged_by(straight), {}) is None
    assert "heading stays at 0 rad" in pose_fault(dead, judged_by(ours), {}).note


def test_turns_are_taken_in_no_gap(ours):
    """Neither where one of their ends alone lies in it."""
    kept = (AT_S < 20.0) | (AT_S > 32.5)
    gappy = Trajectory(AT_S[kept], ours.poses[kept])
    begins_s, ends_s = shared_pieces(gappy, ours)
    assert len(begins_s) > 30
    assert ((ends_s < 20.0) | (begins_s > 32.5)).all()
