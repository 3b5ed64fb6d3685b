"""Cells that are empty in a part: what is not measured contradicts nothing."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.stamps.timing import lags_of
from odometry.checks.statistics.measured_between import gaps_between, measured_between
from tests.odometry.checks.drives import driven, varied
from tests.odometry.checks.faulty import gyroscope, put, yaw


def warnings(run):
    return [f"{found.name}: {found.seen}" for found in check_recording(run).at(Level.WARNING)]


def slow(run, share=0.5):
    """Rows of odometry.csv in which the robot is slow."""
    speeds = np.abs(run.odometry["v_left"] + run.odometry["v_right"])
    return speeds < np.quantile(speeds, share)


def parts(run):
    rows = np.arange(len(run.odometry))
    return {
        "slow": slow(run),
        "the middle": (rows > 0.3 * len(rows)) & (rows < 0.7 * len(rows)),
        "the first": rows < 0.4 * len(rows),
        "every other": rows % 2 == 1,
        "most": np.random.default_rng(3).random(len(rows)) < 0.7,
    }


@pytest.mark.parametrize("part", ["slow", "the middle", "the first", "every other", "most"])
def test_a_yaw_rate_that_is_empty_in_a_part_is_no_turn(part):
    run = varied()
    empty = parts(run)[part]
    assert warnings(gyroscope(run, lambda rate: np.where(empty, np.nan, rate))) == []


def test_turns_across_empty_cells_are_not_known():
    run = varied()
    empty = parts(run)["the middle"]
    evidence = Evidence(gyroscope(run, lambda rate: np.where(empty, np.nan, rate)))
    ((begin_s, end_s),) = evidence.silent_s
    of = evidence.integrals
    stamps_s = np.array([begin_s - 1, (begin_s + end_s) / 2, end_s + 1])
    assert np.isfinite(of.gyroscope_rad(stamps_s)).tolist() == [True, False, True]
    turns = of.between(stamps_s[[0, 0, 2]] - [0, 0.5, 0], stamps_s[[0, 2, 2]] + [0.5, 0, 1])[2]
    assert np.isfinite(turns).tolist() == [True, False, True]


def test_a_rate_between_empty_cells_is_that_of_both_ends():
    run = varied()
    at_s = run.odometry["t"]
    empty = np.random.default_rng(4).random(len(at_s)) < 0.4
    empty[[0, -1]] = False
    rate = np.where(empty, np.nan, 0.3 * np.sin(at_s))
    evidence = Evidence(put(run, "odometry", gyro_z=rate))
    stamps_s = at_s[~empty]
    off = evidence.integrals.gyroscope_rad(stamps_s) - 0.3 * (1 - np.cos(stamps_s))
    assert np.abs(off).max() < 0.02  # 0.05 where the last rate holds


def test_a_log_of_changes_has_no_silent_gyroscope():
    run = varied()
    kept = np.flatnonzero(np.arange(len(run.odometry)) // 40 % 2 == 0)
    run = put(run, "odometry", **{k: v[kept] for k, v in run.odometry.columns.items()})
    assert not len(Evidence(run).silent_s)


def test_yaw_that_is_empty_at_slow_speed_has_the_lag_of_the_rest():
    """A line from the last yaw before to the first one after is no measured heading."""
    run = driven()
    whole = lags_of(Evidence(run))
    empty = np.interp(run.pose["t"], run.odometry["t"], slow(run, 0.45)) > 0.5
    emptied = lags_of(Evidence(yaw(run, lambda angle: np.where(empty, np.nan, angle))))
    for pair in (("pose", "gyroscope"), ("pose", "treads")):
        assert emptied[pair].seconds == pytest.approx(whole[pair].seconds, abs=0.01), pair
        assert emptied[pair].sigma_s < 0.01, pair


def test_values_in_gaps_are_not_known():
    stamps_s = np.array([0.0, 0.1, 0.2, 0.3, 2.3, 2.4, 2.5])
    assert gaps_between(stamps_s).tolist() == [[0.3, 2.3]]
    found = measured_between(np.array([-1.0, 0.05, 0.3, 1.0, 2.3, 2.45, 3.0]), stamps_s, stamps_s)
    assert np.isfinite(found).tolist() == [False, True, True, False, True, True, False]
    assert not len(gaps_between(np.arange(0.0, 100.0, 2.0)))
