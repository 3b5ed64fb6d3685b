"""A jump is one of the series itself, not of what it is compared with."""

import numpy as np
import pytest

from odometry.checks.poses.steps import jumps_by_itself

RATE_HZ = 10.0


def drive(speeds_m_s):
    """Stamps and positions of a robot on a circle, at speeds of a second each."""
    speed = np.repeat(np.asarray(speeds_m_s, dtype=float), int(RATE_HZ))
    stamps_s = np.arange(len(speed)) / RATE_HZ
    yaw = np.cumsum(0.5 * speed) / RATE_HZ
    steps = speed[:, None] / RATE_HZ * np.stack([np.cos(yaw), np.sin(yaw)], axis=-1)
    return stamps_s, np.cumsum(steps, axis=0)


@pytest.mark.parametrize("off_rows", [-8, -3, 0, 4, 8])
@pytest.mark.parametrize("direction", [(0.5, 0.0), (-0.3, 0.4)])
def test_a_jump_is_found_though_the_row_is_not_exact(off_rows, direction):
    stamps_s, positions = drive([1.0] * 10)
    positions[50:] += direction
    assert jumps_by_itself(stamps_s, positions, 50 + off_rows, 0.5)


@pytest.mark.parametrize(
    "speeds", [[1, 1, 0, 0, 1, 1], [1, 1, -1, -1, 1, 1], [0, 0, 1, 1, 1, 0], [1] * 6]
)
def test_starts_stops_and_turns_round_are_none(speeds):
    """As poses that are right look beside treads that are late."""
    stamps_s, positions = drive(speeds)
    for row in range(10, len(stamps_s) - 10):
        assert not jumps_by_itself(stamps_s, positions, row, 0.4)


def test_poses_that_come_in_bursts_do_not_jump():
    """Six at a time: a long step, then five short ones."""
    stamps_s, positions = drive([1.5] * 12)
    rows = np.arange(36)
    stamps_s[42:78] = stamps_s[42] + 0.6 * (rows // 6) + 0.05 * (rows % 6) + 0.25
    assert not any(jumps_by_itself(stamps_s, positions, row, 0.7) for row in range(45, 75))
    positions[60:] += (1.5, 0.0)
    assert jumps_by_itself(stamps_s, positions, 60, 1.5)


def test_noise_is_none(rng):
    stamps_s, positions = drive([1.0] * 10)
    noisy = positions + rng.normal(scale=0.02, size=positions.shape)
    assert not any(jumps_by_itself(stamps_s, noisy, row, 0.5) for row in range(10, 90))


def test_a_series_too_short_to_say_has_none():
    stamps_s, positions = drive([1.0])
    assert not jumps_by_itself(stamps_s[:4], positions[:4], 2, 0.1)
