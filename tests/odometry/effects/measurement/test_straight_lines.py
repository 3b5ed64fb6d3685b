"""Poses drawn straight between fixes: where the path bends says when the fixes were."""

import numpy as np
import pytest

from odometry.effects.interface.recorded import Recorded, Reported
from odometry.effects.measurement.straight_lines import StraightLines, fixes_s

STAMPS_S = np.arange(0.0, 120.0, 0.1) + 0.03
SPREADS = [0.01, 0.01, 0.005]  # m, m, rad


@pytest.fixture
def drive(rng):
    """Poses (M, 3) of a robot that changes its speed and turn each few seconds."""
    holds = np.cumsum(rng.uniform(2.0, 6.0, 60))
    hold = np.searchsorted(holds, STAMPS_S)
    speed, rate = rng.uniform(0.3, 1.0, 61)[hold], rng.uniform(-0.8, 0.8, 61)[hold]
    yaw = np.cumsum(0.1 * rate)
    place = np.cumsum(0.1 * speed * np.exp(1j * yaw))
    return np.column_stack([place.real, place.imag, yaw])


def drawn(poses, period_s, first_s=0.0):
    fixes = np.append(np.arange(STAMPS_S[0] + first_s, STAMPS_S[-1], period_s), STAMPS_S[-1])
    at_fixes = [np.interp(fixes, STAMPS_S, column) for column in poses.T]
    return fixes, np.column_stack([np.interp(STAMPS_S, fixes, column) for column in at_fixes])


@pytest.mark.parametrize("period_s", [1.13, 1.7, 2.9])
def test_the_moments_of_the_fixes_come_back(drive, rng, period_s):
    fixes, lines = drawn(drive, period_s)
    found = fixes_s(STAMPS_S, lines + rng.normal(size=lines.shape) * SPREADS)
    inner = found[1:-1]
    off_s = np.abs(inner[:, None] - fixes).min(axis=1)
    assert len(inner) == pytest.approx(len(fixes) - 2, abs=1)
    assert np.median(off_s) < 0.06
    assert off_s.max() < 0.15


def test_a_robot_that_drives_on_has_none(drive, rng):
    assert len(fixes_s(STAMPS_S, drive + rng.normal(size=drive.shape) * SPREADS)) == 0
    standing = np.zeros_like(drive) + rng.normal(size=drive.shape) * SPREADS
    assert len(fixes_s(STAMPS_S, standing)) == 0
    assert len(fixes_s(STAMPS_S[:5], drive[:5])) == 0


def test_straight_lines_are_seen_of_the_poses_of_the_robot(drive):
    _, lines = drawn(drive, 1.7)
    effect, reported = StraightLines(), Reported(STAMPS_S, lines)
    np.testing.assert_array_equal(effect.seen(np.array([0.0]), drive, reported), drive)
    whole = effect.seen(np.array([1.0]), drive, reported)
    left = [np.sqrt(np.mean((of - lines)[:, :2] ** 2)) for of in (drive, whole)]
    assert left[1] < 0.3 * left[0]
    assert effect.is_meant(np.array([1.0]))
    assert not effect.is_meant(np.array([0.2]))


def test_it_is_a_candidate_where_all_paths_bend_at_even_intervals(bench, rng, drive):
    inputs, (_, lines) = (bench.drive(rng),), drawn(drive, 1.7)
    for poses, count in (((lines,), 1), ((lines, drive), 0), ((), 0)):
        reported = tuple(Reported(STAMPS_S, of) for of in poses)
        assert (
            len(StraightLines.offered(Recorded(bench.base, inputs, (), reported=reported))) == count
        )
