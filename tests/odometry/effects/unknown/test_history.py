"""Tread speeds as a weighted sum of earlier and later ones."""

import numpy as np
import pytest

from odometry.effects.catalogue import added_effects, effect_table
from odometry.effects.commands.late_treads import CommandDelay
from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.effects.unknown.history import BOTH, HISTORY, LAGS_S, History
from odometry.errors import ParameterError


def test_one_lag_of_full_weight_is_a_delay(bench, rng):
    """Exact: a twist is linear in tread speeds."""
    base, inputs = bench.base, bench.drive(rng)
    lag_s = LAGS_S[5]
    only = History(terms=((BOTH, 5),))
    late = corrected_twist(base, [Added(CommandDelay(), np.array([lag_s]))], inputs)
    found = corrected_twist(base, [Added(only, np.array([1.0]))], inputs)
    np.testing.assert_allclose(found, late, atol=1e-9)


def test_each_tread_may_have_a_history_of_its_own(bench, rng):
    base, inputs = bench.base, bench.drive(rng)
    values = np.linspace(-0.1, 0.2, len(LAGS_S))

    def found(tread):
        effect = History(terms=tuple((tread, k) for k in range(len(LAGS_S))))
        return corrected_twist(base, [Added(effect, values)], inputs)

    plain = corrected_twist(base, [], inputs)
    np.testing.assert_allclose(found("left") + found("right"), found(BOTH) + plain, atol=1e-12)
    assert np.abs(found("left") - plain).max() > 0.01


def test_weights_of_nothing_do_nothing_and_those_of_both_sides_smooth(bench, rng):
    base, inputs = bench.base, bench.drive(rng)
    plain = corrected_twist(base, [], inputs)
    nothing = corrected_twist(base, [Added(History(), np.zeros(len(LAGS_S)))], inputs)
    np.testing.assert_array_equal(nothing, plain)
    smoothed = corrected_twist(base, [Added(History(), np.full(len(LAGS_S), 0.1))], inputs)
    assert np.abs(np.diff(smoothed, axis=0)).max() < np.abs(np.diff(plain, axis=0)).max()


def test_a_parameter_set_holds_it():
    added = Added(History(), np.linspace(-0.1, 0.2, len(LAGS_S)))
    (again,) = added_effects([effect_table(added)], "here")
    assert again.effect == added.effect
    np.testing.assert_array_equal(again.values, added.values)


def test_terms_of_something_else_are_refused():
    with pytest.raises(ParameterError, match="'v_x', 0"):
        History(terms=(("v_x", 0),))
    with pytest.raises(ParameterError, match="'speed'"):
        History("speed")
    assert History().variable == HISTORY
