"""A gyroscope that is clipped in a part of a recording, and one that is stuck."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.imu.gyroscope import gyroscope
from tests.odometry.checks import faulty
from tests.odometry.checks.drives import driven


@pytest.fixture(scope="module")
def run():
    return driven()


def from_a_third(rate, changed):
    return np.where(np.arange(len(rate)) > len(rate) / 3, changed, rate)


def named(run):
    return {found.name: found for found in gyroscope(Evidence(run))}


def test_a_limit_that_both_sides_reach_is_no_gyroscope_that_is_stuck(run):
    limit = 0.5 * float(np.abs(run.odometry["gyro_z"]).max())
    clipped = faulty.gyroscope(run, lambda rate: from_a_third(rate, np.clip(rate, -limit, limit)))
    found = named(clipped)
    assert "gyroscope_dead" not in found
    (first_s, _), *_ = found["gyroscope_clipped"].spans_s
    assert f"{limit:.4g}" in found["gyroscope_clipped"].seen
    stamps_s = clipped.odometry.stamps_s
    assert first_s > (stamps_s[-1] - stamps_s[0]) / 3


def test_one_value_is_a_gyroscope_that_is_stuck(run):
    stuck = faulty.gyroscope(run, lambda rate: from_a_third(rate, rate[len(rate) // 3]))
    assert "gyroscope_clipped" not in named(stuck)
    assert "gyroscope_dead" in named(stuck)


def test_a_log_of_the_side_of_the_turn_alone_is_not_clipped(run):
    sides = faulty.gyroscope(run, lambda rate: from_a_third(rate, 0.15 * np.sign(rate)))
    found = named(sides)
    assert "gyroscope_clipped" not in found
    assert "the side of a turn alone" in found["gyroscope_dead"].cause
