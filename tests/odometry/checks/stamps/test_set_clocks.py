"""Lags that grow evenly, and lags that change in one step."""

import re
from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.findings.undo import TREADS
from odometry.checks.recording import check_recording
from odometry.checks.stamps.rates_by_delay import left_by_any_growing
from odometry.checks.stamps.set_clocks import step_of_lag
from odometry.checks.stamps.stepping_clocks import stepping_clocks
from odometry.checks.statistics.lag import Lag
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import stepping
from tests.odometry.checks.faulty import pose_stamps, put


def set_at(share, step_s):
    return lambda t: t + step_s * (t > t[0] + share * np.ptp(t))


@pytest.mark.parametrize(("share", "seed"), [(0.4, 0), (0.5, 1), (0.6, 2)])
def test_a_clock_that_is_set_does_not_run_apart_as_a_fact(share, seed):
    run = pose_stamps(stepping(seed), set_at(share, 0.6))
    for found in check_recording(run).findings:
        assert found.name != "clocks_apart" or found.cause.startswith("Either clocks run apart")


def test_the_step_and_its_moment_are_said():
    evidence = Evidence(pose_stamps(stepping(), set_at(0.5, 0.6)))
    growing = Lag(0.3, 0.03, 0.6 / 160, 0.0005, 0.9, 8, 0.8)
    words, clearly = step_of_lag(evidence, ("pose", "gyroscope"), growing)
    before_s, moment_s, after_s = map(float, re.findall(r"[+-]?[0-9]+\.?[0-9]*", words)[:3])
    assert clearly
    assert (before_s, after_s) == (pytest.approx(0, abs=0.1), pytest.approx(0.6, abs=0.1))
    assert moment_s == pytest.approx(80, abs=4)


def test_clocks_that_run_apart_keep_their_name():
    run = pose_stamps(stepping(), lambda t: t[0] + 1.006 * (t - t[0]))
    (found,) = check_recording(run).findings
    assert found.name == "clocks_apart"
    assert found.cause.startswith("Clocks run apart")


@pytest.mark.parametrize("step_s", [0.5, -0.6, 1.5])
def test_a_clock_that_was_set_is_named_and_undone(step_s):
    """No jump of the poses that it makes is named beside it."""
    run = pose_stamps(stepping(), lambda t: t + step_s * (t > 80))
    if step_s < 0:
        kept = np.flatnonzero(
            (run.pose["t"] > 80) | (np.arange(len(run.pose)) * 0.1 <= 80 + step_s)
        )
        run = replace(run, pose=run.pose.rows(kept))
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "clock_set"
    assert f"step by {step_s:+.2f} s" in found.seen
    assert warnings(found.mend(run)) == []


def test_a_sensor_that_is_never_on_time_has_no_clock_that_was_set():
    run = pose_stamps(stepping(), lambda t: t + np.where(t > 80, 1.3, 0.6))
    assert list(stepping_clocks(Evidence(run))) == []


@pytest.mark.parametrize("seed", [0, 1])
def test_a_lag_with_a_step_is_not_that_of_commands(seed):
    """A robot follows its commands late all the time."""
    run = replace(stepping(seed), pose=None)
    at_s = run.odometry.stamps_s

    def ahead(by_s):
        return put(
            run,
            "odometry",
            **{name: np.interp(at_s + by_s, at_s, run.odometry[name]) for name in TREADS},
        )

    (found,) = check_recording(ahead(0.25 * (at_s > 60))).at(Level.WARNING)
    assert found.name == "latency_changes"
    assert "steps by -0.2" in found.seen


def test_a_lag_that_grows_is_sought_as_by_trying_each_one(rng):
    squares = rng.random((9, 40))
    growths = np.round(np.outer([-5, -1.3, 0, 2.2, 30], np.linspace(-0.5, 0.5, 40))).astype(int)
    tried = (
        squares[np.clip(first + growth, 0, 8), np.arange(40)].sum()
        for first in range(9)
        for growth in growths
    )
    assert left_by_any_growing(squares, growths) == pytest.approx(min(tried), rel=1e-12)
