"""Faults of the drive of one side: the other tread does what it does without them."""

import numpy as np
import pytest

from odometry.effects.commands.by_side import (
    DeadbandBySide,
    DelayBySide,
    LagBySide,
    RateBySide,
    SaturationBySide,
)
from odometry.effects.commands.drive_limit import (
    BLURRED_M_S,
    HARDEST_M_S2,
    Deadband,
    RateLimit,
    Saturation,
)
from odometry.effects.commands.late_treads import ActuatorLag, CommandDelay
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.recorded import Recorded
from odometry.models.inputs import Inputs

VALUES = {
    "first_order_by_side": (LagBySide(), ActuatorLag(), 0.2, 0.0),
    "by_side": (DelayBySide(), CommandDelay(), 0.17, 0.0),
    "deadband_by_side": (DeadbandBySide(), Deadband(), 0.3, 0.0),
    "saturation_by_side": (SaturationBySide(Saturation(2.0)), Saturation(2.0), 0.7, 2.0),
    "rate_by_side": (RateBySide(), RateLimit(), 0.4, HARDEST_M_S2),
}
each = pytest.mark.parametrize("form", VALUES)


@each
def test_each_tread_follows_its_own_number(form, bench, rng):
    """The same on both is the effect of both; on one, the other tread is as recorded."""
    effect, of_both, value, none = VALUES[form]
    inputs = bench.drive(rng)
    recorded, changed = (
        inputs.tread_speeds_m_s,
        of_both.tread_speeds(np.array([value]), inputs),
    )
    assert np.abs(changed - recorded).max() > 0.1
    for values, expected in (
        ([value, value], changed),
        ([value, none], np.column_stack([changed[:, 0], recorded[:, 1]])),
        ([none, value], np.column_stack([recorded[:, 0], changed[:, 1]])),
    ):
        found = effect.tread_speeds(np.array(values), inputs)
        np.testing.assert_array_equal(found, expected)


@each
def test_the_name_is_that_of_both_and_the_words_say_the_side(form):
    effect, of_both, value, none = VALUES[form]
    assert effect.form == form != of_both.form
    assert effect.name == of_both.name
    words = [
        Added(effect, np.array(values)).in_words
        for values in ([value, none], [none, value], [value, 0.9 * value])
    ]
    ends = ("on the left alone", "on the right alone", "each side by itself")
    assert words == [f"{of_both.in_words}, {end}" for end in ends]
    assert Added(of_both, np.array([value])).in_words == of_both.in_words


@each
def test_nearly_the_same_of_both_treads_is_no_fault_of_one_side(form):
    effect, _, value, none = VALUES[form]
    assert effect.is_meant(np.array([value, none]))
    assert not effect.is_meant(np.array([value, 0.9 * value]))
    assert not effect.is_meant(np.array([none, none]))


def test_a_search_begins_on_the_left_on_the_right_and_on_both(bench, rng):
    for effect, _, _, none in VALUES.values():
        starts = effect.starts(bench.drive(rng), bench.base)
        acts = {tuple(row) for row in (starts != none).tolist()}
        assert acts == {(True, False), (False, True), (True, True)}


def test_the_highest_speeds_lie_below_the_fastest_recorded(bench):
    recorded = Recorded(bench.base, (Inputs(np.array([[0.5, -1.5]])),), ((0.0, 1.0),))
    (offered,) = SaturationBySide.offered(recorded)
    assert [p.high for p in offered.parameters] == [1.5, 1.5]


def test_a_deadband_is_known_to_the_next_commands():
    """Between two commands every band does the same; noise of the commands blurs the rest."""
    inputs = Inputs(np.array([[0.1, 0.02], [-0.4, 0.3]]))
    np.testing.assert_allclose(Deadband().resolution(np.array([0.15]), inputs), [0.15])
    np.testing.assert_allclose(
        DeadbandBySide().resolution(np.array([0.15, 0.15]), inputs), [0.25, 0.15]
    )
    fine = Inputs(np.linspace(0, 1, 2000).reshape(-1, 2))
    np.testing.assert_allclose(Deadband().resolution(np.array([0.15]), fine), [BLURRED_M_S])
    np.testing.assert_array_equal(LagBySide().resolution(np.array([0.1, 0.2]), inputs), [0, 0])
