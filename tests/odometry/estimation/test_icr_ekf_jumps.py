"""Jumps of the ICRs that nobody announced, found by the innovations."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binomtest

from tests.odometry.estimation.icr_ekf_drives import (
    drawn_pose,
    driven,
    filter_of,
    frame,
    switched,
    table,
)


def test_jumps_have_the_stated_false_alarm_rate(rng):
    """Nine innovations as likely as they should be, then a tenth: 1 - probability jump."""
    terrains = {"a": table(0.3, -0.3, 0, 0.02)}
    ekf = filter_of(terrains=terrains, detect_jumps=True, jump_probability=0.95)
    before = driven(ekf)
    at_the_pose = ekf.step(before, frame(3.1), "a")
    alarms = 0
    for _ in range(2000):
        loaded = replace(before, recent=tuple(rng.chisquare(3, 9)))
        alarms += ekf.step(loaded, frame(3.1, drawn_pose(ekf, at_the_pose, rng)), "a").jumped
    assert binomtest(alarms, 2000, 0.05).pvalue > 1e-3


def on_two_grounds(ekf, first_m, second_m, rng, change=100):
    """Turn to and fro; the true half distance of the ICRs changes on the way."""
    yaw, estimates = 0.0, [ekf.start(frame(0, (0, 0, 0), speeds=(-0.4, 0.4)), "a")]
    for i in range(1, 2 * change):
        yaw += 0.1 * 0.4 / (first_m if i < change else second_m)
        pose = np.array([0, 0, np.angle(np.exp(1j * yaw))])
        pose += rng.normal(0, [0.02, 0.02, 0.01])
        estimates.append(ekf.step(estimates[-1], frame(0.1 * i, pose, (-0.4, 0.4)), "a"))
    return estimates


def test_a_jump_is_found_and_the_icr_block_reset(rng):
    ekf = filter_of(terrains={"a": table(0.25, -0.25, 0, 0.01)}, detect_jumps=True)
    estimates = on_two_grounds(ekf, 0.25, 0.5, rng)
    jumps = [i for i, estimate in enumerate(estimates) if estimate.jumped]
    assert jumps
    assert 100 <= jumps[0] <= 110
    assert estimates[jumps[0]].recent == ()
    sigmas = [np.sqrt(np.diag(estimate.covariance)[3:6]) for estimate in estimates]
    assert np.all(sigmas[jumps[0]] > 3 * sigmas[jumps[0] - 1])
    widths = [estimate.mean[3] - estimate.mean[4] for estimate in estimates]
    assert widths[-1] == pytest.approx(1.0, rel=0.05)


def test_a_switch_forgets_the_innovations_of_the_ground_before():
    ekf = filter_of(detect_jumps=True)
    estimate = ekf.step(driven(ekf), frame(3.1, (1.5, 1, 0.5)), "a")
    assert len(estimate.recent) == 1
    assert switched(ekf, estimate, "b")[1].recent == ()


def test_no_jump_is_found_where_nothing_jumps_or_nobody_looks(rng):
    terrains = {"a": table(0.25, -0.25, 0, 0.01)}
    steady = on_two_grounds(filter_of(terrains=terrains, detect_jumps=True), 0.25, 0.25, rng)
    blind = on_two_grounds(filter_of(terrains=terrains), 0.25, 0.5, rng)
    assert not any(estimate.jumped for estimate in steady + blind)
