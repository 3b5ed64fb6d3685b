"""Stretches in which treads turn on the spot and the robot does not, and all that are none."""

import numpy as np
import pytest

from odometry.windows.recorded.blocked_turns import blocked_spans

STAMPS_S = 0.05 * np.arange(800)
WIDTH_M = 0.6
ON_THE_SPOT = np.array([-0.3, 0.3])


def found(*, speeds=ON_THE_SPOT, share=0.0, lasts_s=20.0, noise=0.01):
    """Spans of a robot that turns by a half, and from 10 s on by a share, of an ideal drive."""
    there = (STAMPS_S >= 10.0) & (10.0 + lasts_s > STAMPS_S)
    treads = np.where(there[:, None], speeds, ON_THE_SPOT)
    ideal = (treads[:, 1] - treads[:, 0]) / WIDTH_M
    rates = np.where(there, share, 0.5) * ideal
    rates += noise * np.random.default_rng(1).standard_normal(len(rates))
    return blocked_spans(STAMPS_S, treads, rates, WIDTH_M)


def test_a_robot_that_stands_while_its_treads_turn_is_blocked():
    np.testing.assert_allclose(found(), [[10.0, 30.0]], atol=0.15)


def test_one_that_is_shaken_is_blocked_too():
    np.testing.assert_allclose(found(noise=0.04), [[10.0, 30.0]], atol=0.15)


@pytest.mark.parametrize(
    "drive",
    [
        {"share": 0.15},
        {"lasts_s": 4.0},
        {"speeds": np.array([0.8, 1.2])},
        {"speeds": np.array([0.0, 0.0])},
        {"noise": 0.0},
    ],
    ids=["turns a little", "for 4 s", "one tread scaled wrongly", "rests", "a gyroscope held at 0"],
)
def test_these_are_not(drive):
    assert len(found(**drive)) == 0


def test_without_a_yaw_rate_there_are_none():
    treads = np.tile(ON_THE_SPOT, (800, 1))
    assert len(blocked_spans(STAMPS_S, treads, np.full(800, np.nan), WIDTH_M)) == 0
