import numpy as np
import pytest

from odometry.dead_reckoning import dead_reckon, dead_reckon_in_space
from odometry.errors import RunFolderError, TrajectoryError
from odometry.evaluation.open_loop import fitness, measured_poses, open_loop
from odometry.recording.run import Run

TWISTS = np.array([[1.0, 0, 0.5], [0.5, 0.1, -0.5], [2.0, 0, 1.0], [9, 9, 9]])
ODOMETRY = "t,v_left,v_right\n0,1,1\n1,1,1\n2,1,1\n4,1,1\n"
TILTED = "t,v_left,v_right,roll,pitch\n0,1,1,0.1,-0.1\n1,1,1,0.2,0\n2,1,1,,0.2\n4,1,1,0.1,\n"


def read(make_run, pose, odometry=ODOMETRY):
    return Run.read(make_run(odometry=odometry, pose=pose))


def test_it_starts_at_the_first_measured_pose_and_meets_every_reference_stamp(make_run):
    """In the plane, by twists that hold: 0.75 s of the first one are left at the start."""
    run = read(make_run, "t,x,y,yaw\n-1,5,5,5\n0.25,3,4,0.7\n1.5,0,0,0\n3.5,0,0,0\n6,0,0,0\n")
    ours = open_loop(run, TWISTS)
    assert ours.stamps_s.tolist() == [0.25, 1, 1.5, 2, 3.5, 4]
    corners_s = np.array([0.25, 1, 2, 4])
    plane = dead_reckon(corners_s, TWISTS, np.array([3, 4, 0.7]))
    rows = np.searchsorted(ours.stamps_s, corners_s)
    np.testing.assert_allclose(ours.plane.poses[rows], plane.poses, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(ours.positions_m[:, 2], 0)


def test_on_tilted_terrain_the_attitude_is_interpolated(make_run):
    run = read(make_run, "t,x,y,yaw,z\n0,1,2,0.3,4\n3,1,1,1,1\n", odometry=TILTED)
    stamps_s, rows = np.array([0.0, 1, 2, 3, 4]), [0, 1, 2, 2, 3]
    roll = np.array([0.1, 0.2, 0.2 - 0.1 / 3, 0.2 - 0.2 / 3, 0.1])
    pitch = np.array([-0.1, 0, 0.2, 0.2, 0.2])
    expected = dead_reckon_in_space(stamps_s, TWISTS[rows], roll, pitch, np.array([1.0, 2, 4, 0.3]))
    ours = open_loop(run, TWISTS)
    np.testing.assert_array_equal(ours.stamps_s, stamps_s)
    np.testing.assert_allclose(ours.poses, expected.poses, rtol=0, atol=1e-14)


def test_where_heights_are_measured_it_starts_at_one(make_run):
    run = read(make_run, "t,x,y,yaw,z\n0,,1,1,1\n0.5,1,1,1,\n1,2,3,0.5,4\n3,1,1,1,\n")
    ours = open_loop(run, TWISTS)
    assert ours.stamps_s[0] == 1
    np.testing.assert_allclose(ours.positions_m[0], [2, 3, 4], rtol=0, atol=0)
    reference_s, poses = measured_poses(run)
    assert reference_s.tolist() == [0.5, 1, 3]
    result = fitness(ours, reference_s, poses)
    assert (result.poses, result.heights) == (2, 1)


def test_a_run_that_the_model_explains_has_no_fitness_to_speak_of(make_run):
    """The reference is the motion itself, printed with nine decimals."""
    stamps_s = np.array([0.0, 1, 2, 4])
    truth = dead_reckon(stamps_s, TWISTS, np.array([1.0, -2, 3]))
    rows = np.column_stack([stamps_s, truth.poses]).tolist()
    lines = ["t,x,y,yaw", *(",".join(f"{value:.9f}" for value in row) for row in rows)]
    run = read(make_run, "\n".join(lines) + "\n")
    result = fitness(open_loop(run, TWISTS), *measured_poses(run))
    assert (result.poses, result.heights) == (4, 0)
    assert 0 < result.total < 1e-17


def test_a_run_without_pose_is_an_error(make_run):
    with pytest.raises(RunFolderError, match=r"pose\.csv: missing"):
        open_loop(Run.read(make_run(odometry=ODOMETRY)), TWISTS)


def test_a_pose_without_measurement_is_an_error(make_run):
    with pytest.raises(RunFolderError, match=r"pose\.csv: no row"):
        open_loop(read(make_run, "t,x,y,yaw\n0,,0,0\n1,0,,0\n"), TWISTS)


def test_a_reference_at_another_time_is_an_error(make_run):
    with pytest.raises(TrajectoryError, match=r"pose\.csv covers 10\.000 to 11\.000 s"):
        open_loop(read(make_run, "t,x,y,yaw\n10,0,0,0\n11,0,0,0\n"), TWISTS)
