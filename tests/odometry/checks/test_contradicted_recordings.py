"""Real recordings, altered: a cause that another sensor contradicts is not named."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.recording import check_recording
from odometry.checks.stamps.late_stamps import followed
from odometry.checks.turns.constancy import uneven_map
from odometry.recording.run import Robot, Run
from tests.odometry.checks.answers import UNKNOWN, warnings
from tests.odometry.checks.faulty import gyroscope, positions, put, treads, yaw

GRASS, BENDS = "warthog_grass_20240808_1556", "warthog_grass_20240729_1446"


@pytest.fixture
def recording(shared_data):
    return lambda name: Run.read(shared_data / "motion" / name)


def names(run):
    return [finding.name for finding in check_recording(run).findings]


def test_one_axis_in_feet_is_no_far_sensor(recording):
    assert warnings(positions(recording(GRASS), lambda x, y: (x / 0.3048, y))) == UNKNOWN


def test_positions_that_end_at_a_border_are_no_vertical_axis(recording):
    def ended(values):
        return np.clip(values, *np.quantile(values, [0.2, 0.8]))

    run = positions(recording(GRASS), lambda x, y: (ended(x), ended(y)))
    assert warnings(run) == ["frozen_poses"]


def test_a_gyroscope_behind_a_filter_is_not_early_poses(recording):
    """By the treads, poses are on time."""
    run = recording("husky_2023_s00")
    slow = followed(0.9)(put(run, "odometry", v_left=run.odometry["gyro_z"]))
    assert warnings(gyroscope(run, lambda _: slow.odometry["v_left"])) == ["gyroscope_late"]


def test_a_column_that_holds_the_sum_is_no_robot_that_pulls(recording):
    run = treads(recording(BENDS), lambda left, right: (left, left + right))
    assert names(run) == UNKNOWN


def test_slip_is_not_named_beside_a_yaw_that_is_folded(recording):
    run = yaw(recording("husky_2023_s02"), lambda angle: np.mod(angle, np.pi))
    assert names(run) == UNKNOWN


def test_where_gyroscope_and_poses_agree_the_treads_are_at_fault(recording):
    run = recording("warthog_asphalt_20240920_0813")
    changes = (np.gradient(run.odometry[n], run.odometry["t"]) for n in ("v_left", "v_right"))
    (found,) = check_recording(treads(run, lambda *_: changes)).findings
    assert found.name == "treads_unrelated"
    assert "cannot be determined" in found.cause


def test_twist_that_wrapped_is_beyond_slip(recording):
    run = recording("husky_tile_20231212_1616_s00")
    left, right = run.odometry["v_left"], run.odometry["v_right"]
    half = (right - left) / 2
    most = np.quantile(np.abs(half), 0.9)
    wrapped = (half + most) % (2 * most) - most
    run = treads(run, lambda *_: ((left + right) / 2 - wrapped, (left + right) / 2 + wrapped))
    assert "beyond what any slip" in check_recording(run).findings[0].seen


def test_a_gyroscope_that_is_weak_to_one_side_has_no_bias(recording):
    run = recording("marmotte_boreal_20240125_1215_s00")
    weak = gyroscope(run, lambda rate: np.where(rate > 0, 0.8 * rate, rate))
    assert warnings(weak) == UNKNOWN


def test_slip_explains_no_sign_that_is_lost(recording):
    run = recording("husky_2023_s00")
    run = replace(run, imu=None, robot=Robot(run.robot.track_width))
    lost = treads(run, lambda left, right: (left, np.abs(right)))
    assert warnings(lost) == UNKNOWN


def test_slip_that_cannot_be_undone_is_named_beside_treads_ahead(recording):
    assert "slip" in names(recording("warthog_ice_20240730_1630_s04"))


def test_lost_samples_of_one_side_are_no_other_scale(recording):
    lost = np.random.default_rng(3).random(len(recording(BENDS).odometry)) < 0.2
    run = treads(recording(BENDS), lambda left, right: (left, np.where(lost, 0.0, right)))
    assert warnings(run) == ["dropped_speeds"]


def test_one_side_in_another_unit_is_no_stuck_encoder(recording):
    run = recording("husky_2023_s02")
    run = replace(run, imu=None, robot=Robot(run.robot.track_width))
    assert warnings(treads(run, lambda left, right: (left, 3.6 * right))) == ["treads_unequal"]


def test_a_turn_is_not_blocked_where_one_tread_has_lost_its_sign(recording):
    run = recording("warthog_asphalt_20240920_0813")
    assert warnings(treads(run, lambda left, right: (left, np.abs(right)))) == UNKNOWN


def test_speeds_that_end_at_a_limit_are_no_map_that_shrinks(recording):
    """Metres differ by place, and places explain nothing of it."""
    run = recording("warthog_asphalt_slow_20240808_1146_s02")
    clipped = treads(run, lambda *of: tuple(np.clip(v, -0.4071, 0.4071) for v in of))
    assert uneven_map(Evidence(clipped)) == ""
