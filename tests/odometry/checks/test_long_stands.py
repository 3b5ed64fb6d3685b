"""What is usual is that of a robot that moves, however long it stands beside it."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.statistics.outliers import pose_outliers, spikes
from odometry.checks.statistics.relation import relation
from odometry.windows.recorded.in_motion import moving_samples, moving_windows
from tests.odometry.checks.drives import PERIOD_S, drive


def test_samples_of_a_robot_that_moves_are_chosen():
    speeds = np.concatenate([np.zeros(900), np.full(100, 0.5)])
    assert moving_samples(speeds).sum() == pytest.approx(100, abs=4)
    speeds[300] = 40.0
    assert not moving_samples(speeds)[:800].any()
    assert moving_samples(np.zeros(50)).all()
    assert moving_samples(np.ones(2)).all()


def test_windows_that_say_nothing_are_left_out_where_they_are_most():
    columns = np.array([[0.0] * 30 + [1.0] * 10, [0.0] * 20 + [0.5] * 20])
    assert moving_windows(columns).all()
    columns = np.hstack([np.zeros((2, 40)), columns])
    assert np.flatnonzero(~moving_windows(columns)).tolist() == list(range(60))
    assert moving_windows(columns[:, :62]).all()


def test_a_relation_is_that_of_motion():
    rng = np.random.default_rng(0)
    driven_m = rng.uniform(0.5, 1.0, 40)
    moved_m = 0.8 * driven_m + rng.normal(0, 0.1, 40)
    alone = relation(moved_m, driven_m)
    standing = np.zeros(400)
    beside = relation(
        np.concatenate([moved_m, rng.normal(0, 1e-4, 400)]), np.concatenate([driven_m, standing])
    )
    assert beside.slope == pytest.approx(alone.slope, abs=1e-9)
    assert beside.slope_sigma == pytest.approx(alone.slope_sigma, rel=1e-6)
    assert beside.correlation == pytest.approx(alone.correlation, abs=1e-6)
    assert beside.kept[:40].tolist() == alone.kept.tolist()


def test_the_way_of_a_robot_that_stands_for_long_has_no_outliers():
    at_s = 0.1 * np.arange(200)
    way = np.column_stack([4 * np.cos(9.0 * at_s), 3 * np.sin(2.0 * at_s)])
    still = way[-1] + np.random.default_rng(1).normal(0, 1e-3, (5000, 2))
    assert not pose_outliers(np.concatenate([way, still])).any()
    speeds = np.concatenate([np.zeros(9000), 0.4 + 0.3 * np.sin(at_s * 40)])
    assert not spikes(speeds).any()


@pytest.mark.parametrize("stands_s", [0, 300, 1500])
def test_a_drive_with_a_long_rest_has_no_warning(stands_s):
    rng, rest = np.random.default_rng(3), round(stands_s / PERIOD_S)
    at_s = PERIOD_S * np.arange(2400)
    speed = 1 + 0.3 * np.sin(at_s / 7)
    turn = 0.5 * np.sin(at_s / 3) + 0.2 * np.sin(at_s / 1.3)
    first, still = slice(0, 1200), np.zeros(rest)
    both = [np.concatenate([of[first], still, of[1200:]]) for of in (speed, turn)]
    run = drive(*both, sigma_m=0.01)
    slip = 1 + 0.1 * np.repeat(rng.standard_normal(len(run.odometry) // 40 + 1), 40)
    columns = dict(run.odometry.columns)
    for name in ("v_left", "v_right"):
        columns[name] = columns[name] * slip[: len(run.odometry)]
    run = replace(run, odometry=replace(run.odometry, columns=columns))
    assert check_recording(run).at(Level.WARNING) == ()
    assert Evidence(run).fastest_m_s == pytest.approx(1.65, abs=0.3)
