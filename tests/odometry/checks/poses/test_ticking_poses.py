"""Positions that jump at a regular beat."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.poses.ticking_poses import TOGETHER, resultants_of
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import turning_all_round
from tests.odometry.checks.faulty import frozen, jump, outliers, put


@pytest.fixture(scope="module")
def driven():
    return turning_all_round()


def beats_of(stamps_s, period_s):
    return np.floor((stamps_s - 0.3) / period_s).astype(int) + 1


def moved(run, offsets_m):
    """Positions with offsets (M, 2)."""
    x, y = run.pose.stack("x", "y").T + offsets_m.T
    return put(run, "pose", x=x, y=y)


def jumping(run, size_m=0.3, period_s=1.7, seed=0):
    """Off to some side from each beat to the next."""
    beats = beats_of(run.pose.stamps_s, period_s)
    side = np.random.default_rng(seed).uniform(0, 2 * np.pi, beats.max() + 1)[beats]
    return moved(run, size_m * np.column_stack([np.cos(side), np.sin(side)]))


def corrected(run, size_m=0.3, period_s=1.7):
    """Off by more and more, until each beat."""
    t = run.pose.stamps_s
    since = (t - 0.3) / period_s - beats_of(t, period_s) + 1
    return moved(run, size_m * np.column_stack([since, np.zeros(len(t))]))


@pytest.mark.parametrize("period_s", [1.7, 4.0])
@pytest.mark.parametrize("change", [jumping, corrected])
def test_jumps_at_a_beat_are_named_with_it(driven, change, period_s):
    (found,) = check_recording(change(driven, period_s=period_s)).findings
    assert (found.name, found.level) == ("ticking_poses", Level.WARNING)
    assert f"at a beat of {period_s:.2g} s" in found.seen


def test_treads_of_a_robot_that_stands_are_not_said_to_go_on(driven):
    at_rest = np.zeros_like(driven.odometry.stamps_s)
    resting = put(driven, "odometry", v_left=at_rest, v_right=at_rest, gyro_z=at_rest)
    x, y = 0.01 * np.random.default_rng(0).standard_normal((2, len(driven.pose)))
    resting = jumping(put(resting, "pose", x=x, y=y, yaw=np.zeros(len(x))))
    (seen,) = (f.seen for f in check_recording(resting).findings if f.name == "ticking_poses")
    assert "go on" not in seen


def test_small_jumps_are_none(driven):
    assert not check_recording(jumping(driven, 0.03)).findings


def by_chance(run):
    rng, t = np.random.default_rng(1), run.pose.stamps_s
    beats = np.searchsorted(np.sort(rng.uniform(0, t[-1], 100)), t)
    side = rng.uniform(0, 2 * np.pi, 101)[beats]
    return moved(run, 0.3 * np.column_stack([np.cos(side), np.sin(side)]))


def renewed(run):
    """Positions of each second, held until the next one."""
    t = run.pose.stamps_s
    first = np.searchsorted(t, np.floor(t))
    return put(run, "pose", x=run.pose["x"][first], y=run.pose["y"][first])


def out_and_back(run):
    off = np.zeros((len(run.pose), 2))
    off[::17, 0] = 0.5
    return moved(run, off)


def lost(run):
    """Each 17th row."""
    return replace(run, pose=run.pose.rows(np.flatnonzero(np.arange(len(run.pose)) % 17)))


OTHERS = {
    "as it is": lambda run: run,
    "jumps by chance": by_chance,
    "one jump": lambda run: jump(run, 8.0),
    "held": renewed,
    "frozen": frozen,
    "outliers": outliers,
    "an outlier at each beat": out_and_back,
    "a lost row at each beat": lost,
    "rounded": lambda run: put(run, "pose", x=np.round(run.pose["x"]), y=np.round(run.pose["y"])),
}


@pytest.mark.parametrize("change", OTHERS.values(), ids=OTHERS)
def test_other_faults_are_no_beat(driven, change):
    found = {finding.name for finding in check_recording(change(driven)).findings}
    assert "ticking_poses" not in found


@pytest.mark.parametrize("count", [1, 2, 100, 1601])
def test_resultants_are_those_of_the_phases_at_each_frequency(count):
    at_s = np.sort(np.random.default_rng(count).uniform(0, 300, 2 * TOGETHER + 3))
    frequencies_hz = 0.1 + 0.001 * np.arange(count)
    phases = 2 * np.pi * frequencies_hz[:, None] * at_s
    expected = np.hypot(np.cos(phases).mean(axis=1), np.sin(phases).mean(axis=1))
    found = resultants_of(at_s, 0.1, 0.001, count)
    np.testing.assert_allclose(found, expected, atol=1e-10)
