"""A clock that is set in a held-out run: its moment and size are that run's own."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.reference_step import ClockStep
from odometry.gap.fit.own_moments import observed_s, with_own_moments
from odometry.gap.prepare.statistic import gap_of

FIRST_S, SECOND_S, SET_S = 50.0, 83.0, 0.3


@pytest.fixture(scope="module")
def scenes(make_scene):
    """Two runs whose clock is set on by 0.3 s, and back by 0.05 s, and one where it is not."""

    def make(seed, number, moment_s, set_s):
        plain = make_scene(seed, lambda _, twist: twist, duration_s=120.0, name=f"run_{number}")
        stamps_s = plain.pose_s + set_s * (plain.pose_s >= moment_s)
        return replace(plain, pose_s=stamps_s).numbered(number)

    return make(1, 0, FIRST_S, SET_S), make(2, 1, SECOND_S, -0.05), make(3, 1, 0.0, 0.0)


@pytest.fixture(scope="module")
def step(scenes):
    span = observed_s(scenes[0])
    return Added(ClockStep((span,), ((FIRST_S,),)), np.array([SET_S, FIRST_S + 0.1]))


def test_the_run_that_it_was_fitted_to_is_explained(known, scenes, step):
    assert gap_of(known.base, [step], scenes[:1], 10.0).value < 0.03
    assert gap_of(known.base, (), scenes[:1], 10.0).value > 0.05


def test_the_other_run_has_a_moment_and_a_size_of_its_own(known, scenes, step):
    (found,), judged = with_own_moments(known.base, [step], scenes[1:2], scenes[:1], known)
    assert found.by_name == pytest.approx(
        {
            "offset_of_1": SET_S,
            "moment_of_1": FIRST_S + 0.1,
            "offset_of_2": -0.05,
            "moment_of_2": SECOND_S,
        },
        abs=0.15,
    )
    assert found.values[2] == pytest.approx(-0.05, abs=0.02)
    assert gap_of(known.base, [found], judged, 10.0).value < 0.03
    assert np.abs(judged[0].start_s - SECOND_S).min() > 2.0


def test_a_run_whose_stamps_do_not_break_has_no_step(known, scenes, step):
    (found,), _ = with_own_moments(known.base, [step], scenes[2:], scenes[:1], known)
    assert found.values[2] == 0.0
