"""Windows of robots that travel little: shorter ones, and what few of them leave open."""

import numpy as np
import pytest

from odometry.identification.identify import identify
from odometry.identification.shorter_windows import LEAST_S, shortened
from odometry.windows.config import WindowConfig
from tests.odometry.positions_drives import drive, slower


@pytest.fixture(scope="module")
def slow():
    """Five metres in 80 s."""
    run = slower(drive(3, duration_s=8.0, noise_m=0.002), 10.0)
    assert 4 < run.wheel_travel_m[-1] < 8
    return run


def identified(run, **settings):
    (found,) = identify([run], "icr", window_config=WindowConfig(**settings)).terrains.values()
    return found


def lasted_s(found):
    windows = found.fit.windows
    return windows.integrated(np.ones_like(windows.steps_s)).mean()


def test_a_slow_robot_has_more_and_shorter_windows(slow):
    few, more = identified(slow, horizon_m=2.0), identified(slow)
    assert len(few.fit.windows) < 5
    assert len(more.fit.windows) > 12
    assert more.horizon_m < 0.5
    assert few.horizon_m == 2.0
    assert more.fit.sigmas["y_left"] < few.fit.sigmas["y_left"]
    said = shortened(more.fit.windows, 2.0, more.horizon_m)
    assert said.startswith(f"windows are {more.horizon_m:.2g} m long, not 2 m")
    assert shortened(few.fit.windows, 2.0, 2.0) == ""


def test_they_are_as_long_as_slip_wanders(slow):
    assert LEAST_S <= lasted_s(identified(slow)) < 1.5 * LEAST_S
    fast = drive(3, duration_s=20.0, noise_m=0.002)
    assert lasted_s(identified(fast)) == pytest.approx(lasted_s(identified(fast, horizon_m=2.0)))


def test_long_runs_keep_the_horizon():
    found = identified(drive(4, duration_s=120.0, noise_m=0.01))
    assert len(found.fit.windows) >= 30
    assert found.horizon_m == 2.0


def test_few_windows_have_the_freedom_of_one_axis():
    """Two parameters turn the robot: three windows leave one number to judge their scatter by."""
    run = drive(3, duration_s=13.0, noise_m=0.01)
    found = identified(run, horizon_m=2.0)
    assert len(found.fit.windows) == 3
    assert found.fit.freedom.max() < 2.0
