"""How much of an effect there is in time, by its integral over constant motion."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added, corrected_twist, with_true_speeds
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import SPACING_S, FromAMoment, Gradual, InBursts
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.models.inputs import Inputs

TIME_S = np.array([0.0, 0.1, 0.3, 0.34, 0.6, 0.61, 1.0])
STEADY = Inputs(np.tile([0.4, 0.7], (7, 1)), time_s=TIME_S)


def moved(values, inputs):
    return (values[:-1] * np.diff(inputs.time_s)[:, None]).sum(axis=0)


@pytest.mark.parametrize("moment", [-1.0, 0.0, 0.31, 0.5, 0.999, 7.0])
def test_travel_is_the_integral_on_both_sides_of_the_moment(bench, moment):
    """At a constant twist: k from the moment on, though it lies within an uneven sample."""
    plain = bench.base.model.twist(bench.values, STEADY)
    effect = Added(in_course(TractionLoss(), FromAMoment()), np.array([0.7, 0.4, moment]))
    found = corrected_twist(bench.base, [effect], STEADY)
    after_s = 1.0 - np.clip(moment, 0.0, 1.0)
    expected = plain[0] * ((1 - after_s) + after_s * np.array([0.7, 0.4, 0.4]))
    np.testing.assert_allclose(moved(found, STEADY), expected, atol=1e-14)


def test_gradual_is_a_share_of_time():
    """Speeds that shrink by 6 % over 2 s: after 1 s by 1.5 % on average, sample means exact."""
    effect = Added(in_course(WheelScale(), Gradual(2.0)), np.array([0.94, 0.94]))
    found = with_true_speeds([effect], STEADY).tread_speeds_m_s
    np.testing.assert_allclose(moved(found, STEADY), [0.4 * 0.985, 0.7 * 0.985], atol=1e-14)


def test_every_run_has_its_own():
    """The second run alone: 0.3 s of 1 s without, the others never; a third run has none."""
    course = FromAMoment(((0.0, 9.0), (0.0, 9.0)))
    effect = Added(in_course(WheelScale(), course), np.array([0.5, 0.5, 8.0, 0.3]))
    for number, share in enumerate([1.0, 0.65, 1.0]):
        inputs = replace(STEADY, run_number=np.full(7, number))
        found = with_true_speeds([effect], inputs).tread_speeds_m_s
        np.testing.assert_allclose(moved(found, inputs), share * np.array([0.4, 0.7]), atol=1e-14)


def test_searches_begin_all_over_each_run(bench):
    course = FromAMoment(((2.0, 160.0), (1.0, 31.0)))
    starts = in_course(TractionLoss(), course).starts(STEADY, bench.base)
    np.testing.assert_array_equal(starts[:, :2], 1)
    in_first = starts[:, 3] == starts[:, 3].max()
    for moments, span_s in ((starts[in_first, 2], 158.0), (starts[~in_first, 3], 30.0)):
        assert np.diff(moments) == pytest.approx(max(span_s / 30, SPACING_S), rel=0.02)


def test_a_search_goes_on_to_other_moments_of_one_run_at_a_time():
    effect = in_course(TractionLoss(), FromAMoment(((2.0, 160.0), (1.0, 31.0))))
    values = np.array([0.7, 0.4, 60.0, 32.0])
    elsewhere = effect.elsewhere(values)
    assert len(elsewhere) == 40
    np.testing.assert_array_equal(elsewhere[:, :2], np.tile([0.7, 0.4], (40, 1)))
    np.testing.assert_array_equal((elsewhere[:, 2:] != values[2:]).sum(axis=1), 1)
    alone = in_course(TractionLoss(), FromAMoment())
    assert alone.elsewhere(values[:3]).shape == (0, 3)


@pytest.mark.parametrize(
    ("moments", "meant"),
    [
        ((1.9, 20.0), False),
        ((2.0, 20.0), True),
        ((159.0, 31.5), False),
        ((159.0, 31.0), True),
        ((158.0, 31.5), True),
    ],
)
def test_a_moment_has_something_before_and_in_some_run_after_it(moments, meant):
    course = FromAMoment(((2.0, 158.0), (1.0, 31.0)))
    assert course.is_meant(np.array(moments)) == meant


def test_without_stamps_there_is_no_course(bench):
    effect = in_course(TractionLoss(), FromAMoment())
    inputs = Inputs(np.zeros((3, 2)))
    assert effect.lacks(inputs, bench.base) == "stamps"
    twist = np.ones((3, 3))
    np.testing.assert_array_equal(effect.twist(np.array([0.1, 0.1, 0.0]), twist, inputs, None), 1)


@pytest.mark.parametrize("seed", range(5))
def test_shares_of_bursts_are_those_of_every_event_and_sample(seed):
    rng = np.random.default_rng(seed)
    time_s = np.unique(np.round(np.cumsum(rng.uniform(0.0, 0.1, 300)), 1 + seed % 3))
    events = np.unique(np.round(rng.uniform(-1.0, time_s[-1] + 1.0, 20), 1 + seed % 3))
    events = events[: len(events) // 2 * 2].reshape(-1, 2)
    course = InBursts((tuple((float(b), float(e)) for b, e in events),))
    inputs = Inputs(np.zeros((len(time_s), 2)), time_s=time_s)
    steps_s = np.diff(time_s)[:, None]
    within_s = np.minimum(time_s[1:, None], events[:, 1]) - np.maximum(
        time_s[:-1, None], events[:, 0]
    )
    expected = np.minimum((np.clip(within_s, 0.0, None) / steps_s).sum(axis=1), 1.0)
    np.testing.assert_allclose(course.share(np.empty(0), inputs)[:-1], expected, atol=1e-9)
