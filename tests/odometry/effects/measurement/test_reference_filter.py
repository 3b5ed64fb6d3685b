"""References that smooth, lag or swing, against closed forms."""

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added
from odometry.effects.interface.recorded import Reported
from odometry.effects.measurement.map_fault import DriftingMap
from odometry.effects.measurement.reference_filter import (
    FilteredPositions,
    SlowYaw,
    SmoothedPoses,
    SwayingMast,
)
from odometry.gap.fit.effect_values import is_meant

STAMPS_S = np.cumsum(np.random.default_rng(3).uniform(0.04, 0.06, 1200))
MIDDLE = slice(400, 800)
RATE = 2.0  # rad/s


def circle():
    return np.column_stack([np.cos(RATE * STAMPS_S), np.sin(RATE * STAMPS_S), RATE * STAMPS_S])


def seen(effect, values, poses):
    return effect.seen(np.array(values), poses, Reported(STAMPS_S, poses))


def test_a_mean_over_time_shrinks_a_circle_and_keeps_steady_motion():
    poses = circle()
    found = seen(SmoothedPoses(), [1.5], poses)[MIDDLE]
    shrunk = np.sinc(RATE * 1.5 / 2 / np.pi)
    np.testing.assert_allclose(found[:, :2], shrunk * poses[MIDDLE, :2], atol=2e-3)
    np.testing.assert_allclose(found[:, 2], poses[MIDDLE, 2], atol=1e-9)


def test_filtered_positions_lag_on_a_circle_and_the_yaw_does_not():
    poses = circle()
    found = seen(FilteredPositions(), [0.4], poses)[MIDDLE]
    expected = (poses[:, 0] + 1j * poses[:, 1])[MIDDLE] / (1 + 0.4j * RATE)
    np.testing.assert_allclose(found[:, 0] + 1j * found[:, 1], expected, atol=2e-3)
    np.testing.assert_array_equal(found[:, 2], poses[MIDDLE, 2])


def test_a_slow_yaw_lags_by_its_time_in_a_steady_turn():
    found = seen(SlowYaw(), [0.3], circle())[MIDDLE]
    np.testing.assert_allclose(found[:, 2], circle()[MIDDLE, 2] - 0.3 * RATE, atol=1e-6)
    np.testing.assert_array_equal(found[:, :2], circle()[MIDDLE, :2])


@pytest.mark.parametrize(("bend", "frequency", "damping"), [(0.05, 6.0, 0.3), (0.2, 2.5, 0.8)])
def test_a_mast_answers_a_circle_as_an_oscillator_does(bend, frequency, damping):
    poses = circle()
    found = seen(SwayingMast(), [bend, frequency, damping], poses)[MIDDLE]
    s = 1j * RATE
    answer = 1 - bend * frequency**2 * s**2 / (s**2 + 2 * damping * frequency * s + frequency**2)
    expected = answer * (poses[:, 0] + 1j * poses[:, 1])[MIDDLE]
    np.testing.assert_allclose(found[:, 0] + 1j * found[:, 1], expected, atol=5e-3)


@pytest.mark.parametrize("effect", [SmoothedPoses(), FilteredPositions(), SwayingMast()])
def test_where_the_drive_began_and_looked_does_not_matter(effect):
    """Simulated poses begin at the origin: a turned and moved course is filtered the same way."""
    poses = circle() * [3.0, 2.0, 1.0]
    turn = np.exp(0.7j)
    moved = (poses[:, 0] + 1j * poses[:, 1]) * turn + 5 - 2j
    values = [p.start + p.scale for p in effect.parameters]
    there = seen(effect, values, np.column_stack([moved.real, moved.imag, poses[:, 2]]))
    here = seen(effect, values, poses)
    back = (here[:, 0] + 1j * here[:, 1]) * turn + 5 - 2j
    np.testing.assert_allclose(there[:, 0] + 1j * there[:, 1], back, atol=1e-9)


def test_a_mast_that_does_not_ring_is_none():
    assert SwayingMast().is_meant(np.array([0.1, 5.0, 0.2]))
    assert not SwayingMast().is_meant(np.array([0.1, 5.0, 0.9]))


@pytest.mark.parametrize("effect", [FilteredPositions(), SlowYaw(), DriftingMap()])
def test_what_a_robot_may_do_as_well_is_not_meant(effect):
    added = Added(effect, np.array([one.start for one in effect.parameters]))
    assert effect.mimicked_by in is_meant(added)
    assert is_meant(Added(SmoothedPoses(), np.array([1.0]))) == ""
