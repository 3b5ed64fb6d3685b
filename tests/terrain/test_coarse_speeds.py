"""Tread speeds in steps: few encoder ticks in a short time."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.speed_step import speed_step_m_s, with_speed_step
from terrain.main_job import run_odometry
from tests.odometry.checks.drives import PERIOD_S, WIDTH_M, drive

STEP_M_S = 0.1


def lanes():
    """Straight lines at 1 m/s, each with a turn at its end."""
    at_s = PERIOD_S * np.arange(3000)
    turning = at_s % 10 > 8
    return drive(np.where(turning, 0.3, 1.0), np.where(turning, 0.6 * (-1) ** (at_s // 10), 0.0))


def in_steps(run):
    """With speeds of whole ticks: the part of one that is left counts in the next row."""
    counted = np.cumsum(run.odometry.stack("v_left", "v_right"), axis=0) / STEP_M_S
    left, right = STEP_M_S * np.diff(np.round(counted), axis=0, prepend=0.0).T
    columns = run.odometry.columns | {"v_left": left, "v_right": right}
    return replace(run, odometry=replace(run.odometry, columns=columns))


def test_steps_do_not_widen_the_robot():
    result = run_odometry(in_steps(lanes()), vision=False)
    y_left, y_right = result.replay.means[-1, 3:5]
    assert y_left - y_right == pytest.approx(WIDTH_M, rel=0.1)
    (event,) = [event for event in result.replay.events if event.kind == "coarse_speeds"]
    assert event.values == pytest.approx((STEP_M_S,))


def test_a_step_is_found_where_there_is_one():
    run = lanes()
    assert speed_step_m_s(run.odometry.stack("v_left", "v_right")) == 0.0
    assert with_speed_step(run, IcrEkfConfig()) == (IcrEkfConfig(), ())
    taken, _ = with_speed_step(in_steps(run), IcrEkfConfig())
    assert taken.compare_s == pytest.approx(0.5, rel=0.1)


@pytest.mark.parametrize(
    "settings", [{"compare_s": 0.2}, {"causal": True}, {"watch_sensors": False}]
)
def test_a_step_that_is_stated_and_a_filter_that_does_not_look_stay_as_they_are(settings):
    config = IcrEkfConfig(**settings)
    assert with_speed_step(in_steps(lanes()), config) == (config, ())
