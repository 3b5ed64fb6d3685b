"""Tread speed programmes: what they ask for, within their acceleration."""

import numpy as np
import pytest

from odometry.errors import SimulationError
from odometry.simulation.commands import excitation, figure_eight, segments, spin, tour

STEP = 0.02
PROGRAMMES = {
    "excitation": excitation(60.0, STEP, max_speed_m_s=0.9, rng=np.random.default_rng(1)),
    "spin": spin(10.0, STEP, speed_m_s=-0.4),
    "figure_eight": figure_eight(40.0, STEP, speed_m_s=0.6, difference_m_s=0.5, loop_s=10.0),
    "tour": tour(40.0, STEP, speed_m_s=0.6, difference_m_s=0.5, turn_s=3.0, straight_s=7.0),
}


@pytest.mark.parametrize("name", PROGRAMMES)
def test_programmes_start_and_end_at_rest_and_do_not_jump(name):
    speeds = PROGRAMMES[name]
    np.testing.assert_array_equal(speeds[0], 0.0)
    np.testing.assert_allclose(speeds[-1], 0.0, atol=1e-12)
    assert np.abs(np.diff(speeds, axis=0)).max() <= 1.0 * STEP + 1e-12


def test_segments_hold_their_speeds_until_their_time_is_over():
    speeds = segments([(3.0, 0.5, -1.0), (2.0, 0.5, 0.0)], 0.5)
    left = [0, 0.25, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.0]
    right = [0, -0.5, -1, -1, -1, -1, -1, -0.5, 0, 0, 0, 0]
    np.testing.assert_allclose(speeds, np.column_stack([left, right]))


def test_a_segment_too_short_for_its_ramp_is_named():
    with pytest.raises(SimulationError, match="too short for a ramp of 2 s"):
        segments([(5.0, 1.0, 0.0), (1.5, -1.0, 0.0)], STEP)


def test_excitation_reaches_every_stratum_of_the_speed_plane():
    speeds = PROGRAMMES["excitation"]
    held = speeds[np.arange(1, 15) * 200 - 10]
    for side in held.T:
        strata = np.floor((side / 0.9 + 1) / 2 * 14).astype(int)
        assert sorted(strata) == list(range(14))
    other = excitation(60.0, STEP, max_speed_m_s=0.9, rng=np.random.default_rng(2))
    assert not np.allclose(other, speeds)


def test_a_spin_turns_one_way_and_an_eight_both_ways_equally():
    left, right = PROGRAMMES["spin"].T
    np.testing.assert_array_equal(left, -right)
    assert left.max() == 0.4
    difference = np.diff(PROGRAMMES["figure_eight"]).ravel()
    assert difference.max() == pytest.approx(0.5)
    assert difference.min() == pytest.approx(-0.5)
    mean = PROGRAMMES["figure_eight"].mean(axis=1)
    np.testing.assert_allclose(mean[100:1900], 0.6)


def test_a_tour_turns_left_left_right_right():
    difference = np.diff(PROGRAMMES["tour"]).ravel()
    signs = np.sign(difference[np.abs(difference) > 0.4])
    turns = signs[np.flatnonzero(np.diff(np.flatnonzero(np.abs(difference) > 0.4), prepend=-9) > 1)]
    assert turns.tolist() == [1, 1, -1, -1]
