"""Positions that are elsewhere for some seconds, and come back."""

import numpy as np
import pytest

from odometry.checks.recording import check_recording
from odometry.checks.statistics.outliers import excursions
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import AT_REST_S, pausing
from tests.odometry.checks.faulty import put, without_gyroscope, without_yaw

SENSORS = {
    "all": lambda run: run,
    "no yaw": without_yaw,
    "positions alone": lambda run: without_gyroscope(without_yaw(run)),
}


def elsewhere(run, begin_s, lasts_s):
    at_s = run.pose["t"]
    away = (at_s >= begin_s) & (at_s < begin_s + lasts_s)
    return put(run, "pose", x=run.pose["x"] + 5.0 * away)


@pytest.mark.parametrize("begin_s", [40.0, AT_REST_S[0] + 4.0])
@pytest.mark.parametrize(("sensors", "lasts_s"), list(zip(SENSORS, (1.0, 2.0, 4.0), strict=True)))
def test_they_are_outliers_and_no_jump_nor_another_recording(lasts_s, begin_s, sensors):
    (found,) = check_recording(SENSORS[sensors](elsewhere(pausing(), begin_s, lasts_s))).findings
    assert found.name == "pose_outliers"
    assert f"{10 * lasts_s:.0f} poses" in found.seen
    assert "and back again" in found.seen


@pytest.mark.parametrize("sensors", SENSORS)
def test_what_stays_is_none(sensors):
    at_rest = elsewhere(pausing(), AT_REST_S[0] + 4.0, np.inf)
    assert warnings(SENSORS[sensors](elsewhere(pausing(), 40.0, np.inf))) == ["pose_jumps"]
    assert "pose_outliers" not in warnings(SENSORS[sensors](at_rest))


def test_steps_that_do_not_cancel_are_none():
    at_s, positions = 0.1 * np.arange(100), np.zeros((100, 2))
    positions[50:60, 0] = 5.0
    positions[60:, 0] = 2.0
    assert not excursions(at_s, positions).any()
    positions[60:, 0] = 0.5
    assert np.flatnonzero(excursions(at_s, positions)).tolist() == list(range(50, 60))
    assert not excursions(10 * at_s, positions).any()
