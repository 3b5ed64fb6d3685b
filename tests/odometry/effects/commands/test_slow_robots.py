"""What is searched on slow and fast robots: bounds and starts follow the recorded speeds."""

import numpy as np
import pytest

from odometry.effects.commands.by_side import DeadbandBySide, RateBySide, SaturationBySide
from odometry.effects.commands.drive_limit import Deadband, RateLimit
from odometry.effects.commands.tread_slip import SlipBySpeed
from odometry.effects.interface.recorded import Recorded
from odometry.models.inputs import Inputs

FASTEST_M_S = 0.04


def offered(form, bench, fastest_m_s):
    inputs = Inputs(np.array([[0.3, -1.0], [0.5, 0.9]]) * fastest_m_s)
    (effect,) = form.offered(Recorded(bench.base, (inputs,), ((0.0, 1.0),)))
    return effect, inputs


def test_all_of_the_fastest_speed_may_be_lost(bench):
    (slow,), (fast,) = (
        offered(SlipBySpeed, bench, m_s)[0].parameters for m_s in (FASTEST_M_S, 3.0)
    )
    assert slow.high * FASTEST_M_S >= 1.0
    assert fast == SlipBySpeed().parameters[0]


@pytest.mark.parametrize("share", [0.1, 0.2, 0.4, 0.8])
def test_a_deadband_is_searched_near_any_share_of_the_fastest_speed(share, bench):
    effect, inputs = offered(Deadband, bench, FASTEST_M_S)
    starts = effect.starts(inputs, bench.base)[:, 0]
    assert np.abs(starts / (share * FASTEST_M_S) - 1).min() < 0.3


@pytest.mark.parametrize("share", [0.1, 0.2, 0.3, 0.4])
def test_a_deadband_of_a_fast_robot_is_searched_up_to_half_of_its_speed(share, bench):
    effect, inputs = offered(Deadband, bench, 4.0)
    starts = effect.starts(inputs, bench.base)[:, 0]
    assert np.abs(starts / (share * 4.0) - 1).min() < 0.3
    assert starts.max() < effect.parameters[0].high == 2.0


def test_a_slow_deadband_is_as_sharp_and_as_well_known_as_a_fast_one(bench):
    speeds = np.linspace(0.001, 1.0, 1000)[:, None] * [1.0, 1.0]
    fast, slow = (
        Deadband().tread_speeds(np.array([0.2 * m_s]), Inputs(m_s * speeds)) / m_s
        for m_s in (0.25, FASTEST_M_S)
    )
    np.testing.assert_allclose(slow, fast, atol=1e-9)
    effect, inputs = offered(Deadband, bench, FASTEST_M_S)
    assert effect.resolution(np.array([0.3 * FASTEST_M_S]), inputs) < 0.31 * FASTEST_M_S


def test_a_rate_is_searched_at_which_a_slow_robot_takes_seconds(bench):
    effect, inputs = offered(RateLimit, bench, FASTEST_M_S)
    assert effect.parameters[0].low < FASTEST_M_S / 4 < effect.starts(inputs, bench.base).min()


@pytest.mark.parametrize("form", [DeadbandBySide, RateBySide])
def test_each_side_is_searched_as_both_are(form, bench):
    assert offered(form, bench, FASTEST_M_S)[0].of_both.crawls == FASTEST_M_S / 0.25


@pytest.mark.parametrize("form", [Deadband, RateLimit])
def test_of_other_robots_it_is_as_it_was(form, bench):
    effect, inputs = offered(form, bench, 0.25)
    assert effect.parameters == form().parameters
    assert (effect.starts(inputs, bench.base) == form().starts(inputs, bench.base)).all()


def test_words_say_on_which_side_a_slow_robot_has_its_highest_speed(bench):
    effect, _ = offered(SaturationBySide, bench, FASTEST_M_S)
    assert effect.in_words_at(np.array([0.8, 1.0]) * FASTEST_M_S).endswith("on the left alone")


@pytest.mark.parametrize("form", [Deadband, RateLimit, SlipBySpeed])
def test_of_a_robot_at_rest_it_is_as_of_others(form, bench):
    assert offered(form, bench, 0.0)[0].parameters == form().parameters
