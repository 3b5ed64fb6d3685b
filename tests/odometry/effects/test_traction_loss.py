import numpy as np
import pytest

from odometry.effects.corrected import Added, corrected_twist
from odometry.effects.traction_loss import SPACING_S, TractionLoss
from odometry.models.inputs import Inputs


@pytest.mark.parametrize("moment", [-1.0, 0.0, 0.31, 0.5, 0.999, 7.0])
def test_travel_is_the_integral_on_both_sides_of_the_moment(bench, moment):
    """At a constant twist: k from the moment on, though it lies within an uneven sample."""
    time_s = np.array([0.0, 0.1, 0.3, 0.34, 0.6, 0.61, 1.0])
    inputs = Inputs(np.tile([0.4, 0.7], (7, 1)), time_s=time_s)
    plain = bench.base.model.twist(bench.values, inputs)
    effect = Added(TractionLoss(), np.array([0.7, 0.4, moment]))
    found = corrected_twist(bench.base, [effect], inputs)
    moved = (found[:-1] * np.diff(time_s)[:, None]).sum(axis=0)
    after_s = 1.0 - np.clip(moment, 0.0, 1.0)
    expected = plain[0] * ((1 - after_s) + after_s * np.array([0.7, 0.4, 0.4]))
    np.testing.assert_allclose(moved, expected, atol=1e-14)


def test_the_moment_is_that_of_each_of_several_runs(bench):
    inputs = Inputs(np.tile([0.4, 0.7], (6, 1)), time_s=np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0]))
    effect = Added(TractionLoss(), np.array([0.5, 0.5, 1.0]))
    found = corrected_twist(bench.base, [effect], inputs)
    plain = bench.base.model.twist(bench.values, inputs)
    shares = np.array([1, 0.5, 0.5, 1, 0.5, 0.5])[:, None]
    np.testing.assert_allclose(found, shares * plain, atol=1e-15)


def test_searches_begin_all_over_the_run(bench):
    inputs = Inputs(np.zeros((3, 2)), time_s=np.array([0.0, 20.0, 160.0]))
    starts = TractionLoss().starts(inputs, bench.base)
    np.testing.assert_array_equal(starts[:, :2], 1)
    np.testing.assert_allclose(np.diff(starts[:, 2]), SPACING_S, rtol=0.02)
    assert TractionLoss().lacks(Inputs(np.zeros((3, 2))), None) == "stamps"


@pytest.mark.parametrize(
    ("moment", "meant"), [(0.0, False), (2.0, True), (60.0, True), (158.0, True), (158.1, False)]
)
def test_a_moment_with_nothing_before_or_after_it_is_none(moment, meant):
    values = np.array([0.7, 0.4, moment])
    assert TractionLoss(160.0, (2.0, 158.0)).is_meant(values) == meant
    assert TractionLoss().is_meant(values)  # of a parameter set: nothing is known of the runs
