"""The answer: a verdict by what stands and what noise explains, and intervals by hand."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.reference_outliers import JumpingPoses
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer.answer import (
    are_explained,
    drives_apart,
    is_first,
    leaves_most,
    named_effects,
    rivals_of,
    verdict_of,
)
from odometry.gap.answer.result import Closing, Equivalent, NamedEffect
from odometry.gap.config import GapConfig
from odometry.gap.name.verdict import Refusal
from odometry.gap.prepare.statistic import Gap

FLOOR = Gap(0.1, 0.08, 0.12)
SCALE, SKID = WheelScale(), LateralSkid()


def explained(names=(), **others):
    return SimpleNamespace(names=names, **{"unexplained": False, "refusals": (), **others})


def held_out(low):
    before = Gap(0.2, low, 0.3)
    return Closing(before, before, FLOOR)


@pytest.mark.parametrize(
    ("names", "unexplained", "low", "verdict"),
    [
        (("wheel_scale", "curvature"), True, 0.15, "wheel_scale"),
        ((), True, 0.05, "unknown"),
        ((), False, 0.121, "unknown"),
        ((), False, 0.12, "none"),
        ((), False, 0.1, "none"),
    ],
)
def test_the_first_name_else_whether_noise_explains_what_is_left(names, unexplained, low, verdict):
    """Only a gap whose whole interval is above that of the floor is more than noise."""
    assert verdict_of(explained(names, unexplained=unexplained), held_out(low)) == verdict


@pytest.mark.parametrize(("floor_high", "verdict"), [(0.19, "unknown"), (0.2, "none")])
def test_an_effect_that_was_refused_leaves_none_only_within_the_floor(floor_high, verdict):
    """0.2 m [0.05, 0.3]: without a refusal `none`, as the interval reaches below the floor."""
    closing = replace(held_out(0.05), noise_floor=Gap(0.1, 0.08, floor_high))
    refused = (Refusal("wheel_scale", "factors", "it is within noise"),)
    assert verdict_of(explained(refusals=refused), closing) == verdict
    assert verdict_of(explained(), closing) == "none"


def judged(effect, evidence, gap_after):
    return SimpleNamespace(effect=effect, evidence=evidence, gap_after=gap_after)


def middle(effect):
    """Values within the bounds, and a standard deviation that stays within them."""
    lows, highs = np.array([(p.low, p.high) for p in effect.parameters]).T
    return (lows + highs) / 2, (highs - lows) / 100


def test_each_effect_has_the_intervals_of_its_own_values_and_the_gap_before_it():
    (scale, scale_sigma), (skid, skid_sigma) = middle(SCALE), middle(SKID)
    added = (Added(SCALE, scale), Added(SKID, skid))
    sigmas = np.concatenate([scale_sigma, skid_sigma])
    found = explained(
        fitted=SimpleNamespace(effects=added, covariance=np.diag(sigmas**2)),
        steps=(judged(SCALE, 40.0, 0.3), judged(SKID, 9.0, 0.2)),
    )
    one, two = named_effects(found, added, 0.5)
    for named, values, sigma in ((one, scale, scale_sigma), (two, skid, skid_sigma)):
        np.testing.assert_allclose(named.low, values - 1.96 * sigma)
        np.testing.assert_allclose(named.high, values + 1.96 * sigma)
    assert [(n.gap_before, n.gap_after, n.evidence) for n in (one, two)] == [
        (0.5, 0.3, 40.0),
        (0.3, 0.2, 9.0),
    ]


def test_an_interval_ends_at_the_bounds_of_its_search():
    """A deviation as wide as the search; a variance that rounding made negative is none."""
    values, _ = middle(SCALE)
    variances = np.full(len(values), -1e-20)
    variances[0] = (SCALE.parameters[0].high - SCALE.parameters[0].low) ** 2
    added = (Added(SCALE, values),)
    fitted = SimpleNamespace(effects=added, covariance=np.diag(variances))
    (named,) = named_effects(explained(fitted=fitted, steps=(judged(SCALE, 9, 0.1),)), added, 0.5)
    assert (named.low[0], named.high[0]) == (SCALE.parameters[0].low, SCALE.parameters[0].high)
    np.testing.assert_array_equal(named.low[1:], values[1:])
    np.testing.assert_array_equal(named.high[1:], values[1:])


@pytest.mark.parametrize(("without_m", "first"), [(0.26, False), (0.24, True), (0.1, True)])
def test_poses_left_out_are_the_first_name_where_they_close_half_of_it(without_m, first):
    """From 0.3 to 0.2 m in all."""
    held = Closing(Gap(0.3, 0.2, 0.4), Gap(0.2, 0.1, 0.3), FLOOR)
    assert is_first(held, Gap(without_m, 0.1, 0.4), GapConfig()) == first


def test_rivals_are_all_candidates_for_the_first_effect_most_evidence_first():
    """Of those that read the same, other constants apart, the best."""
    first = (judged(SCALE, 40.0, 0.3), judged(SKID, 9.0, 0.4), judged(WheelScale(), 4.0, 0.5))
    found = rivals_of(explained(first=first, steps=()))
    assert [(one.name, one.evidence, one.gap_after, one.added) for one in found] == [
        ("wheel_scale", 40.0, 0.3, False),
        ("lateral_skid", 9.0, 0.4, False),
    ]


def test_what_was_added_is_among_the_rivals():
    """Marked, also where it was searched later, or has less evidence than one that fell."""
    steps = (judged(SKID, 30.0, 0.35), judged(SCALE, 5.0, 0.3))
    found = rivals_of(explained(first=(judged(SCALE, 40.0, 0.3),), steps=steps))
    assert [(one.name, one.evidence, one.added) for one in found] == [
        ("wheel_scale", 40.0, False),
        ("lateral_skid", 30.0, True),
    ]


def test_a_smooth_function_is_no_rival_of_names():
    first, step = judged(SCALE, 4.0, 0.3), judged(Residual("v"), 9.0, 0.1)
    (found,) = rivals_of(explained(first=(first,), steps=(step,)))
    assert (found.name, found.added) == ("wheel_scale", False)


def test_no_drive_is_proposed_beside_unknown():
    candidate = SimpleNamespace(effect=SKID, fitted=None, evidence=5.0)
    beside = (Equivalent(SKID.name, "unknown", "another drive"),)
    assert drives_apart(explained(), [candidate], beside, None, None) == ()


@pytest.mark.parametrize(
    ("after_m", "low_m", "most"), [(0.5, 0.2, True), (0.3, 0.2, False), (0.5, 0.05, False)]
)
def test_poses_left_out_are_no_answer_where_most_stays(after_m, low_m, most):
    """Of 0.6 m over a floor of 0.1 m: less than half, surely above the floor."""
    held = Closing(Gap(0.6, 0.3, 0.9), Gap(after_m, low_m, 0.7), Gap(0.1, 0.08, 0.12))
    assert leaves_most(held, GapConfig()) == most


@pytest.mark.parametrize(
    ("before_m", "explained"),
    [
        pytest.param(0.25, False, id="windows that end at them are as far off as they are"),
        pytest.param(0.16, False, id="a third of their square stays"),
        pytest.param(0.10, True, id="what has a name by now moves them as well"),
    ],
)
def test_poses_are_no_jumps_where_a_name_explains_them(before_m, explained):
    """A share of 0.05 at 0.7 m adds 0.0245 m^2 to a gap of 0.09 m."""
    jumps = Added(JumpingPoses(((1.0,),)), np.array([0.05, 0.7]))
    named = NamedEffect(jumps, np.zeros(2), np.ones(2), before_m, 0.09, 100.0)
    assert are_explained(named, GapConfig()) is explained
