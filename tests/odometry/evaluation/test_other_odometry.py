"""Another program's odometry: its own start, stamps, scale and axes, and what is said of them."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.dead_reckoning import dead_reckon
from odometry.errors import TrajectoryError
from odometry.evaluation.other_odometry import Judge, held_stamps, score_other, similarity
from odometry.evaluation.relative import EvaluationConfig
from odometry.trajectory import Trajectory

STAMPS_S = 0.25 * np.arange(201)
PLACE_M = np.array([0.3, -0.1])
START = np.array([5.0, -3.0, 1.0])


def reckoned(scale=1.0, turn=1.0):
    yaw_rate = 0.5 * np.sin(0.3 * STAMPS_S) * turn
    speed = np.full(len(STAMPS_S), scale)
    return dead_reckon(STAMPS_S, np.column_stack([speed, 0 * yaw_rate, yaw_rate]), START)


def seen(trajectory, place_m=PLACE_M):
    x, y, yaw = trajectory.poses.T
    cosine, sine = np.cos(yaw), np.sin(yaw)
    moved_x = x + cosine * place_m[0] - sine * place_m[1]
    moved_y = y + sine * place_m[0] + cosine * place_m[1]
    return Trajectory(trajectory.stamps_s, np.column_stack([moved_x, moved_y, np.unwrap(yaw)]))


@pytest.fixture
def judge():
    """The robot moves as the filter estimates; the reference measures its antenna."""
    config = EvaluationConfig(horizon_m=5.0, stride_m=1.0)
    return Judge(seen(reckoned()), STAMPS_S, reckoned(), reckoned(turn=1.02), PLACE_M, config)


@given(st.tuples(*[st.floats(-50, 50)] * 2, st.floats(-3, 3)))
def test_where_its_frame_lies_does_not_matter(pose):
    config = EvaluationConfig(horizon_m=5.0, stride_m=1.0)
    judge = Judge(seen(reckoned()), STAMPS_S, reckoned(), reckoned(turn=1.02), PLACE_M, config)
    found = score_other(reckoned().moved(np.array(pose)), judge)
    assert found.score.mean_position_m == pytest.approx(0, abs=1e-9)
    assert found.score.mean_translation_per_m == pytest.approx(0, abs=1e-9)
    assert found.score.mean_rotation_deg_per_m == pytest.approx(0, abs=1e-9)
    assert (found.share, found.score.windows) == (1, found.ours.windows)
    assert found.scale == pytest.approx(1)


def test_our_odometer_is_judged_alike(judge):
    found = score_other(judge.odometer, judge)
    assert found.score.to_table() == found.ours.to_table()
    assert found.ours.mean_position_m > 0.1


def test_a_scale_is_reported_and_not_taken_away(judge):
    """A camera's path of 0.4 of its length: of each straight metre 0.6 m are missing."""
    straight, far = reckoned(turn=0), np.zeros(2)
    judge = replace(
        judge, reference=seen(straight, far), believed=straight, odometer=straight, place_m=far
    )
    small = Trajectory(STAMPS_S, straight.poses * [0.4, 0.4, 1])
    found = score_other(small, judge)
    assert found.scale == pytest.approx(2.5)
    assert found.score.mean_translation_per_m == pytest.approx(0.6)
    assert found.score.final_position_m == pytest.approx(0.6 * 50)
    assert found.score.mean_rotation_deg_per_m == pytest.approx(0, abs=1e-9)


def test_axes_that_point_elsewhere_are_reported(judge):
    """A body whose x is the robot's left: its path leaves at a right angle."""
    found = score_other(Trajectory(STAMPS_S, reckoned().poses + np.array([0, 0, np.pi / 2])), judge)
    assert found.turned_rad == pytest.approx(np.pi / 2, abs=0.02)
    assert found.score.mean_position_m > 5


def test_nothing_is_judged_in_a_gap_or_across_it(judge):
    """Lost from 20 to 30 s, and its frame is another one afterwards, as after a new start."""
    before, after = STAMPS_S <= 20, STAMPS_S >= 30
    poses = reckoned().poses
    poses[after] += [7, 0, 0]
    lost = Trajectory(STAMPS_S[before | after], poses[before | after])
    found = score_other(lost, judge)
    assert found.share == pytest.approx((81 + 81) / 201)
    assert found.score.mean_translation_per_m == pytest.approx(0, abs=1e-9)
    assert found.score.windows == found.ours.windows == 2 * 16
    assert found.score.final_position_m == pytest.approx(7)
    assert found.score.median_position_m < 7


@pytest.mark.parametrize("every", [3, 4, 8, 20])  # 0.75 to 5 s
def test_sparse_poses_are_judged_at_their_own_stamps(judge, every):
    """Exact ones have no error; lines from one to the next would cut bends by 0.06 m at 1 s."""
    sparse = reckoned().at(STAMPS_S[1:-1:every] + 0.125)
    found = score_other(sparse, judge)
    assert found.own_stamps == len(sparse)
    assert found.share > 0.85
    assert found.score.mean_translation_per_m < 2e-3
    assert found.score.windows == found.ours.windows > 5
    assert found.ours.mean_translation_per_m > 5e-3


def test_no_window_of_sparse_poses_lies_across_a_loss(judge):
    kept = np.append(np.arange(0, 81, 4), np.arange(121, 201, 4))
    poses = reckoned().poses[kept]
    poses[STAMPS_S[kept] > 25] += [7, 0, 0]
    found = score_other(Trajectory(STAMPS_S[kept], poses), judge)
    assert found.score.mean_translation_per_m == pytest.approx(0, abs=1e-9)
    assert found.score.windows == found.ours.windows > 20


def test_held_stamps_by_hand():
    poses = np.zeros((4, 3))
    found = held_stamps(
        Trajectory(np.array([1.0, 2, 5, 6]), poses), np.array([0.5, 1, 1.5, 2, 3, 5, 5.5, 6, 6.5])
    )
    assert found.tolist() == [False, True, True, True, False, True, True, True, False]


def test_another_clock_is_named(judge):
    later = Trajectory(STAMPS_S + 1000, reckoned().poses)
    with pytest.raises(TrajectoryError, match=r"1000.000 to 1050.000 s.*0.000 to 50.000 s"):
        score_other(later, judge)


def test_similarity_of_a_known_one(rng):
    points = rng.normal(size=(9, 2))
    turned = points @ [[np.cos(0.7), np.sin(0.7)], [-np.sin(0.7), np.cos(0.7)]]
    assert similarity(points, 3 * turned + [4, -1]) == pytest.approx((3, 0.7))
    assert np.isnan(similarity(np.zeros((3, 2)), points[:3])).all()
