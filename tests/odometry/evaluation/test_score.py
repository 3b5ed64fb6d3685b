import numpy as np
import pytest

from odometry.evaluation.relative import EvaluationConfig
from odometry.evaluation.score import reference_of, score
from odometry.recording.run import Run
from odometry.trajectory import Trajectory

CONFIG = EvaluationConfig(horizon_m=5.0, stride_m=1.0)


@pytest.fixture
def straight_run(make_run):
    """Twenty metres at one metre a second."""
    rows = "".join(f"{t},1,1\n" for t in range(21))
    return Run.read(make_run(odometry="t,v_left,v_right\n" + rows))


def line(scale, offset_m=0.0, drift=0.0):
    t = np.arange(21.0)
    return Trajectory(t, np.column_stack([scale * t, np.full(21, offset_m), drift * t]))


def test_a_scale_error_and_an_offset(straight_run):
    found = score(straight_run, line(0.9, drift=np.radians(1)), line(1.0), CONFIG)
    assert found.windows == 16
    np.testing.assert_allclose(found.mean_rotation_deg_per_m, 1)
    np.testing.assert_allclose(found.rotation_deg_per_m, [1, 1, 1])
    assert found.mean_position_m == pytest.approx(0.1 * 10)
    assert found.final_position_m == pytest.approx(2.0)
    assert found.median_position_m == pytest.approx(0.1 * 10)
    straight = score(straight_run, line(0.9), line(1.0), CONFIG)
    np.testing.assert_allclose(straight.translation_per_m, [0.1, 0.1, 0.1])
    assert straight.mean_translation_per_m == pytest.approx(0.1)


def test_quartiles_in_order(straight_run):
    """Errors of 0, 0.1, ... that grow along the run: 25, 50 and 75 % of 16 windows."""
    t = np.arange(21.0)
    growing = Trajectory(t, np.column_stack([t + 0.01 * t**2, 0 * t, 0 * t]))
    found = score(straight_run, growing, line(1.0), CONFIG)
    starts = np.arange(16.0)
    errors = 0.01 * ((starts + 5) ** 2 - starts**2) / 5
    np.testing.assert_allclose(found.translation_per_m, np.quantile(errors, [0.25, 0.5, 0.75]))
    assert found.mean_translation_per_m == pytest.approx(errors.mean())


def test_a_run_too_short_for_a_window_has_position_errors_alone(straight_run):
    found = score(straight_run, line(0.9), line(1.0), EvaluationConfig(horizon_m=50.0))
    assert (found.windows, found.translation_per_m, found.mean_rotation_deg_per_m) == (
        0,
        None,
        None,
    )
    assert found.final_position_m == pytest.approx(2.0)


def test_one_pose_far_away_moves_the_mean_but_not_the_median(straight_run):
    t = np.arange(21.0)
    poses = np.column_stack([t, 0 * t, 0 * t])
    poses[10, 1] = 1000.0
    found = score(straight_run, line(1.0), Trajectory(t, poses), CONFIG)
    assert found.mean_position_m > 40
    assert found.median_position_m == 0
    assert found.mean_translation_per_m > 10
    assert found.translation_per_m[1] == 0


def test_nothing_in_common(straight_run):
    late = Trajectory(np.array([100.0, 101.0]), np.zeros((2, 3)))
    found = score(straight_run, late, line(1.0), CONFIG)
    assert (found.windows, found.mean_position_m) == (0, None)


def test_the_table_has_units_in_its_names(straight_run):
    table = score(straight_run, line(0.9), line(1.0), CONFIG).to_table()
    assert table["windows"] == 16
    assert table["translation_m_per_m"]["mean"] == pytest.approx(0.1)
    assert table["translation_m_per_m"]["median"] == pytest.approx(0.1)
    assert table["position_m"]["median"] == pytest.approx(1.0)
    assert table["rotation_deg_per_m"]["quartiles"] == pytest.approx([0, 0, 0])
    assert table["position_m"]["final"] == pytest.approx(2.0)


def test_truth_is_preferred_to_measured_poses(make_run):
    pose, truth = "t,x,y,yaw\n0,1,1,1\n1,1,1,1\n", "t,x,y,yaw\n0,2,2,2\n1,2,2,2\n"
    assert reference_of(Run.read(make_run(pose=pose)))[0] == "pose"
    name, reference = reference_of(Run.read(make_run(pose=pose, truth=truth)))
    assert name == "truth"
    assert reference.poses[0].tolist() == [2, 2, 2]


def test_rows_that_were_not_measured_are_left_out(make_run):
    run = Run.read(make_run(pose="t,x,y,yaw\n0,1,1,1\n1,,1,1\n2,3,3,1\n"))
    assert reference_of(run)[1].stamps_s.tolist() == [0, 2]


def test_without_two_poses_there_is_no_reference(make_run):
    assert reference_of(Run.read(make_run())) is None
    assert reference_of(Run.read(make_run(pose="t,x,y,yaw\n0,1,1,1\n1,,,\n"))) is None


def test_positions_without_yaw_are_a_reference(make_run):
    run = Run.read(make_run(pose="t,x,y,yaw\n0,1,1,\n1,2,1,\n2,3,3,1\n"))
    name, reference = reference_of(run)
    assert name == "pose"
    np.testing.assert_array_equal(reference.poses[:, 2], [np.nan, np.nan, 1.0])


def test_without_yaw_there_is_no_heading_error(straight_run):
    true = line(1.0)
    positions = Trajectory(true.stamps_s, true.poses * [1.0, 1.0, np.nan])
    found = score(straight_run, line(0.9, drift=0.01), positions, CONFIG)
    assert found.windows == 11  # they start 5 to 15 m from the first position
    assert found.mean_rotation_deg_per_m is None
    assert found.rotation_deg_per_m is None
    assert found.to_table()["rotation_deg_per_m"]["mean"] is None
    assert found.final_position_m == pytest.approx(2.0)


def test_turns_between_sparse_poses_are_counted_by_the_gyroscope(make_run):
    """A spin of 4.1 rad/s measured once a second, and an odometer that misses all of it."""
    t = np.arange(0, 20.01, 0.05)
    turn = 4.1 * np.clip(t - 5, 0, 10)  # it stands still, spins for 10 s and stands
    rate = np.where((t > 5) & (t < 15), 4.1, 0.0)
    rows = "".join(f"{s:.2f},{-w / 4},{w / 4},{w}\n" for s, w in zip(t, rate, strict=True))
    seconds = np.arange(0, 20.5, 1.0)
    yaw = np.interp(seconds, t, turn)
    pose = "".join(
        f"{s},0,0,{np.angle(np.exp(1j * a))}\n" for s, a in zip(seconds, yaw, strict=True)
    )
    run = Run.read(make_run(odometry="t,v_left,v_right,gyro_z\n" + rows, pose="t,x,y,yaw\n" + pose))
    still = Trajectory(t, np.zeros((len(t), 3)))
    _, reference = reference_of(run)
    found = score(run, still, reference, EvaluationConfig(horizon_m=10.0, stride_m=100.0))
    assert found.windows == 1
    length_m = run.wheel_travel_m[np.searchsorted(t, 15.0)]
    assert np.radians(found.mean_rotation_deg_per_m) == pytest.approx(41 / length_m, rel=0.02)
