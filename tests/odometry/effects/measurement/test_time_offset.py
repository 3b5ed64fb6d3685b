from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added
from odometry.effects.interface.recorded import Recorded, Reported
from odometry.effects.measurement.measured import robot_run
from odometry.effects.measurement.time_offset import ClockDrift, LatePositions, TimeOffset
from odometry.recording.run import Run

POSES = "t,x,y,yaw\n0.3,0,0,0.5\n0.7,0.4,0,0.5\n1.8,1.5,0,0.5\n"


@pytest.mark.parametrize("offset_s", [0.25, -0.4])
def test_a_pose_stamped_t_was_measured_at_t_less_the_offset(make_run, offset_s):
    """At 1 m/s from x = 0 at 0.3 s, the pose at x belongs to x + 0.3 - offset seconds."""
    run = Run.read(make_run(pose=POSES))
    found = robot_run(run, [Added(TimeOffset(), np.array([offset_s]))]).pose
    np.testing.assert_allclose(found.stamps_s, found["x"] + 0.3 - offset_s, atol=1e-12)
    for name in ("x", "y", "yaw"):
        np.testing.assert_allclose(found[name], run.pose[name], atol=1e-15)


def test_it_is_nothing_without_poses(make_run):
    run = replace(Run.read(make_run()), pose=None)
    assert robot_run(run, [Added(TimeOffset(), np.array([0.1]))]) is run


def test_a_clock_that_runs_fast_is_more_and_more_late(make_run):
    """Stamps count from the first of odometry.csv, here 0: 2 % and 0.1 s."""
    run = Run.read(make_run(pose=POSES))
    found = robot_run(run, [Added(ClockDrift(), np.array([0.1, 0.02]))]).pose
    np.testing.assert_allclose(found.stamps_s, run.pose.stamps_s * 0.98 - 0.1, atol=1e-12)


def test_late_positions_stand_beside_the_yaw_of_now():
    """At 2 m/s along x and turning: at t the place of t - 0.3 s, with the yaw of t."""
    t = np.linspace(0.0, 10.0, 101)
    poses = np.column_stack([2 * t, -t, 0.1 * t])
    seen = LatePositions().seen(np.array([0.3]), poses, Reported(t, poses))
    inside = t > 0.3
    np.testing.assert_allclose(seen[inside, 0], 2 * (t[inside] - 0.3), atol=1e-12)
    np.testing.assert_allclose(seen[inside, 1], -(t[inside] - 0.3), atol=1e-12)
    np.testing.assert_array_equal(seen[:, 2], poses[:, 2])


@pytest.mark.parametrize("found", [(True, True), (True, False), (False,), ()])
def test_late_positions_are_offered_where_no_yaw_was_measured(found):
    reported = tuple(Reported(np.zeros(1), np.zeros((1, 3)), k, one) for k, one in enumerate(found))
    offered = LatePositions.offered(Recorded(None, (), (), reported=reported))
    assert len(offered) == (found == (True, True))
