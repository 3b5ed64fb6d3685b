"""Windows leave out stretches in which treads drive and poses stay."""

import math
from dataclasses import replace

import numpy as np
import pytest

from odometry.identification.identify import identify
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.record import STUCK, position_record_of, record_of
from odometry.windows.recorded.stuck import stuck_poses
from odometry.windows.stretches.stretches import position_record_with_yaw_rates
from odometry.windows.travel.windows import windows_of
from tests.odometry.window_drives import ICRS, commands, icr_twist, noisy, write

BEGIN_S, LASTS_S = 45.0, 8.0
CONFIG = WindowConfig(position_sigma_m=0.01, yaw_sigma_rad=math.radians(0.3))


def driven(folder, speeds_m_s, *, share):
    """A noisy drive in which the robot makes a share of its motion for a while, at some speeds."""
    odometry = commands(np.random.default_rng(1), 1200)
    while_s = (odometry[:, 0] >= BEGIN_S) & (odometry[:, 0] < BEGIN_S + LASTS_S)
    if speeds_m_s is not None:
        odometry[while_s, 1:] = speeds_m_s
    odometry = np.column_stack([odometry, np.where(while_s, share, 1.0)])
    moves = icr_twist(ICRS)

    def twist(left, right, roll, pitch, kept):
        return tuple(kept * part for part in moves(left, right, roll, pitch))

    run = Run.read(write(folder, odometry, np.arange(0.03, 119.0, 0.2), twist, terrain="gravel"))
    return noisy(run, np.random.default_rng(5))


def span_of(record):
    pose_s = record.pose_s[stuck_poses(record)]
    return (pose_s.min(), pose_s.max()) if len(pose_s) else None


@pytest.mark.parametrize("speeds_m_s", [(0.5, 0.5), (-0.4, 0.4), (-0.6, -0.3)])
def test_a_stretch_in_which_the_robot_stays_is_found(tmp_path, speeds_m_s):
    found = span_of(record_of(driven(tmp_path / "run", speeds_m_s, share=0.01), CONFIG))
    assert found == pytest.approx((BEGIN_S, BEGIN_S + LASTS_S), abs=0.5)


@pytest.mark.parametrize("share", [1.0, 0.5, 0.35])
@pytest.mark.parametrize("speeds_m_s", [(0.5, 0.5), (-0.4, 0.4), (0.0, 0.0), (0.02, 0.02)])
def test_robots_that_move_slip_or_stand_are_not_stuck(tmp_path, speeds_m_s, share):
    assert span_of(record_of(driven(tmp_path / "run", speeds_m_s, share=share), CONFIG)) is None


def test_robots_that_rock_are_not_led_away(tmp_path):
    rows = np.arange(int(LASTS_S * 10))
    rocking = np.where(rows % 6 < 3, 0.3, -0.3)[:, None] * np.ones(2)
    assert span_of(record_of(driven(tmp_path / "run", rocking, share=0.0), CONFIG)) is None


def without_yaw(run):
    columns = {**run.pose.columns, "yaw": np.full(len(run.pose), np.nan)}
    return replace(run, pose=replace(run.pose, columns=columns))


def test_positions_alone_show_no_turn(tmp_path):
    ahead, turning = (
        without_yaw(driven(tmp_path / name, speeds_m_s, share=0.0))
        for name, speeds_m_s in (("ahead", (0.5, 0.5)), ("turning", (-0.4, 0.4)))
    )
    assert span_of(position_record_of(ahead, CONFIG)) is not None
    assert STUCK in position_record_with_yaw_rates(ahead, CONFIG).breaks
    assert span_of(position_record_of(turning, CONFIG)) is None


def test_windows_leave_it_out_and_parameters_are_those_of_the_rest(tmp_path):
    run = driven(tmp_path / "run", None, share=0.0)
    windows = windows_of([run], CONFIG)
    assert windows.left_out[STUCK] > 2
    inside = (windows.start_s > BEGIN_S + 0.5) & (windows.start_s < BEGIN_S + LASTS_S - 1)
    assert not inside.any()
    (found,) = identify([run], "icr", window_config=CONFIG).terrains.values()
    for name, value in ICRS.items():
        assert found.fit.values[name] == pytest.approx(value, abs=0.03), name
