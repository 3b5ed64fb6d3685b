"""Poses that stay for seconds while the treads turn on the spot: a note, and of nothing else."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import AT_REST_S, pausing, winding
from tests.odometry.checks.faulty import put, treads, without_gyroscope

TURNS = {"v_left": -0.5, "v_right": 0.5}


def spun(lasts_s, speeds=TURNS):
    """Treads run while the robot rests, with noise."""
    run, rng = pausing(), np.random.default_rng(3)
    begin_s = AT_REST_S[0] + 1.0
    inside = (run.odometry["t"] >= begin_s) & (run.odometry["t"] < begin_s + lasts_s)
    columns = {
        name: np.where(inside, speed + 0.01 * rng.standard_normal(len(inside)), run.odometry[name])
        for name, speed in speeds.items()
    }
    return put(run, "odometry", **columns)


@pytest.mark.parametrize(("change", "lasts_s"), [(lambda run: run, 2.5), (without_gyroscope, 4.0)])
def test_treads_that_turn_on_the_spot_beside_a_robot_that_stays_are_noted(lasts_s, change):
    (found,) = check_recording(change(spun(lasts_s))).findings
    assert (found.name, found.level) == ("slip_episodes", Level.NOTE)
    assert found.spans_s[0][0] == pytest.approx(AT_REST_S[0], abs=1.2)
    assert found.spans_s[-1][1] == pytest.approx(AT_REST_S[0] + 1.0 + lasts_s, abs=0.8)


def test_what_has_a_name_is_said_once():
    (longer,) = check_recording(spun(8.0)).findings
    assert longer.name == "turn_blocked"
    (ahead,) = check_recording(spun(3.0, {"v_left": 0.8, "v_right": 0.8})).findings
    assert ahead.name == "slip_episodes"
    assert "hardly move" in ahead.seen


def test_another_fault_may_be_what_makes_poses_stay():
    km_h = treads(spun(3.0), lambda left, right: (3.6 * left, 3.6 * right))
    names = [found.name for found in check_recording(km_h).findings]
    assert names == ["tread_unit"]


@pytest.mark.parametrize("run", [winding(), pausing(), spun(0.3), replace(spun(3.0), pose=None)])
def test_robots_that_move_rest_or_have_no_poses_have_none(run):
    assert "slip_episodes" not in [found.name for found in check_recording(run).findings]
