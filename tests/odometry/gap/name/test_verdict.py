"""What a name must pass: it is what it says, within its bounds, and closes what was held out."""

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.measurement.sensor_mount import HeadingOffset
from odometry.effects.motion.curvature import Curvature
from odometry.effects.motion.slope_icr import SlopeByIcr
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.fit.effect_values import is_the_effect, is_there, within_bounds
from odometry.gap.fit.fitter import Fitted
from odometry.gap.locate.predictors import Predictor
from odometry.gap.name.verdict import (
    base_left_calibration,
    brings_within,
    closes_a_part,
    closes_held_out,
    closes_the_most,
    leaves_no_structure,
    leaves_noise,
    raises_measured,
    within_noise,
)
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.statistic import Gap, Shown, sure_sum
from odometry.models.catalogue import MODELS
from odometry.recording.run import Robot

CONFIG = GapConfig()
FLOOR = Gap(0.02, 0.015, 0.025)


def fitted(effect, values, covariance):
    base = Base(MODELS["icr"], np.array([0.4, -0.4, 0.0, 1.0, 1.0]), Robot(0.6))
    return Fitted(base, (Added(effect, np.array(values)),), covariance, np.ones(3), np.ones(3), 0.0)


def test_an_effect_known_only_as_a_product_is_there():
    """lambda v_max is known to 1 %, lambda and v_max are not."""
    along = np.array([0.1, 0.05, -10.0])
    covariance = 2.0 * np.outer(along, along) + np.diag([1e-6, 1e-6, 1e-2])
    assert is_there(fitted(SlopeByIcr(), [0.1, 0.05, 10.0], covariance), CONFIG)
    assert not is_there(fitted(SlopeByIcr(), [1e-4, 1e-4, 10.0], covariance), CONFIG)


def test_an_effect_within_its_uncertainty_of_none_is_not_there():
    assert not is_there(fitted(HeadingOffset(), [-0.0014], np.array([[1e-6]])), CONFIG)
    assert is_there(fitted(HeadingOffset(), [-0.0014], np.array([[1e-8]])), CONFIG)


@pytest.mark.parametrize(("moment", "there"), [(0.4, False), (2.1, True), (159.9, False)])
def test_a_loss_from_a_moment_at_an_end_of_the_runs_is_not_there(moment, there):
    """However sure its shares are."""
    loss = in_course(TractionLoss(), FromAMoment(((2.0, 158.0),)))
    reason = is_the_effect(fitted(loss, [0.8, 0.7, moment], np.eye(3) * 1e-6), CONFIG)
    assert (reason == "") == there


def test_a_parameter_at_the_end_of_its_search_is_refused():
    sure = np.eye(3) * 1e-6
    assert within_bounds(fitted(Curvature(), [1.0, 3.0, 1.0], sure), CONFIG) == ""
    reason = within_bounds(fitted(Curvature(), [1.0, 20.0, 1.0], sure), CONFIG)
    assert "beta_1 = 20 is at the end" in reason


def test_one_that_shapes_an_effect_may_be_at_an_end_or_do_nothing_at_a_bound():
    sure = np.eye(3) * 1e-6
    assert within_bounds(fitted(Curvature(), [1.0, 3.0, 50.0], sure), CONFIG) == ""
    assert within_bounds(fitted(SlopeByIcr(), [1.0, 0.0, 1.0], sure), CONFIG) == ""


def test_intervals_that_span_the_bounds_are_refused():
    """Of all strengths: where one is known the effect is."""
    values, wide = [0.9, 1.1], np.diag([4.0, 4.0])
    assert within_bounds(fitted(WheelScale(), values, wide), CONFIG) != ""
    assert within_bounds(fitted(WheelScale(), values, np.diag([4.0, 1e-6])), CONFIG) == ""


def test_a_gain_is_that_of_noise():
    loss = in_course(TractionLoss(), FromAMoment(((2.0, 158.0),)))
    gain = fitted(loss, [1.2, 1.1, 60.0], np.eye(3) * 1e-6)
    assert "not what the name says" in is_the_effect(gain, CONFIG)


def test_a_name_must_not_raise_the_gap_that_it_was_fitted_to():
    assert raises_measured(0.095, 0.094) == ""
    assert "rises with it, from 0.095 to 0.097 m" in raises_measured(0.0951, 0.0972)


@pytest.mark.parametrize(("factor", "stands"), [(0.8, True), (1.0, False), (1.2, False)])
def test_a_name_must_close_what_was_held_out(make_scene, known, factor, stands):
    """Wheels slip by a fifth: the right scale, none, and one of the other sign."""
    held = [make_scene(4, lambda _, twist: 0.8 * twist)]
    scale = Added(WheelScale(), np.array([factor, factor]))
    reason = closes_held_out((known.base, ()), (known.base, (scale,)), held, FLOOR, CONFIG)
    assert (reason == "") == stands
    assert factor < 1.1 or "gets worse" in reason


@pytest.mark.parametrize(("gain_m", "reason"), [(0.05, ""), (0.009, "which may be chance")])
def test_a_gain_that_may_be_chance_closes_nothing(make_scene, monkeypatch, gain_m, reason):
    """Errors of 0.2 m that get better by a little, and scatter by 0.05 m from piece to piece."""
    scene = make_scene(4, lambda _, twist: twist)
    piece = numbered_pieces([scene], CONFIG.part_s)
    scatter = np.random.default_rng(0).normal(scale=0.05, size=piece.max() + 1)
    errors = iter([np.full(len(piece), 0.2), 0.2 - gain_m + (scatter - scatter.mean())[piece]])
    monkeypatch.setattr("odometry.gap.name.verdict.squared_errors", lambda *_: next(errors) ** 2)
    found = closes_held_out((None, ()), (None, ()), [scene], FLOOR, CONFIG)
    assert found == reason if not reason else reason in found


def test_a_gain_counts_by_the_mean_error_where_a_few_pieces_hold_the_squares(
    make_scene, monkeypatch
):
    """Two pieces with errors of 3 m, one better and one worse, do not hide a fifth everywhere."""
    scene = make_scene(4, lambda _, twist: twist)
    piece = numbered_pieces([scene], CONFIG.part_s)
    before, after = np.where(piece < 2, 3.0, 0.1), np.where(piece < 2, 3.0, 0.08)
    after = after - 0.02 * (piece == 0) + 0.019 * (piece == 1)
    errors = iter([before, after])
    monkeypatch.setattr("odometry.gap.name.verdict.squared_errors", lambda *_: next(errors) ** 2)
    assert closes_held_out((None, ()), (None, ()), [scene], FLOOR, CONFIG) == ""


@pytest.mark.parametrize(
    ("before", "after", "stands"),
    [
        ([0.1, 0.02, 0.2, 0.02], [0.02, 0.02, 0.025, 0.021], True),  # as slip backward only
        ([0.1, 0.02, 0.2, 0.02], [0.02, 0.02, 0.03, 0.021], False),  # one is not brought within
        ([0.1, 0.02, 0.04, 0.02], [0.02, 0.02, 0.02, 0.02], False),  # one alone is far off
    ],
)
def test_pieces_that_are_far_off_are_all_brought_within_the_floor(before, after, stands):
    assert brings_within(np.array([before, after]), FLOOR, CONFIG) == stands


def test_a_sum_is_sure_where_it_is_alike_or_lasts_without_the_best():
    alike = np.full(10, 4.0)
    assert sure_sum(alike, 2) == pytest.approx(40.0)
    rare = np.array([300.0, 200.0, 100.0, *np.zeros(9)])
    assert sure_sum(rare, 2) == pytest.approx(100.0)
    assert sure_sum(np.array([300.0, 200.0, *np.zeros(10)]), 2) <= 0.0
    assert sure_sum(np.array([7.0]), 2) == -np.inf


def test_a_base_leaves_its_calibration_by_chi_squared():
    """Of six numbers: 22.46 is the 0.1 % point of the tables."""
    for moved, left in ((22.3, False), (22.6, True)):
        fit = Fitted(None, (), np.empty((0, 0)), np.ones(3), np.ones(3), 0.0, moved)
        assert base_left_calibration(fit, 6, CONFIG) == left
    assert not base_left_calibration(fit, 0, CONFIG)


@pytest.mark.parametrize(
    ("spread", "closed", "stands"),
    [(1.2, 0.3, True), (3.0, 0.95, True), (3.0, 0.7, False), (190.0, -0.2, False)],
)
def test_names_leave_noise_or_close_nearly_all(spread, closed, stands):
    reason = leaves_noise(spread, closed, CONFIG.left_over, CONFIG.mostly_closed)
    assert (reason == "") == stands
    assert stands or f"leaves {spread:.1f} times" in reason


@pytest.mark.parametrize("discovered", [True, False])
def test_names_leave_no_structure(discovered):
    left = [
        Predictor("speed", "m/s", 1e-4, discovered, 0.3, "along"),
        Predictor("roll", "rad", 0.2, False, 0.0, "size"),
    ]
    reason = leaves_no_structure(0.6, left)
    assert (reason != "") == discovered
    assert not reason or "closes 60 % of the gap, and what it leaves depends on speed" in reason


@pytest.mark.parametrize(
    ("low", "high", "stands"),
    [(0.034, 0.041, True), (0.034, 0.043, False), (0.029, 0.037, False), (0.05, 0.049, True)],
)
def test_a_name_needs_a_gap_that_is_surely_above_the_floor(low, high, stands):
    """0.02 m above it: more than 0.016 and 0.011 at right angles, less than 0.016 and 0.013."""
    held_out = Gap(0.05, low, 0.06), Gap(0.03, 0.025, high)
    reason = within_noise(Shown(held_out, (Gap(0.03, 0.02, 0.04), held_out[1])), CONFIG)
    assert (reason == "") == stands
    assert stands or "0.05 m, is not surely above the noise floor" in reason


@pytest.mark.parametrize(
    ("held", "measured", "stands"),
    [
        ((0.05, 0.02, 0.09), (0.07, 0.05, 0.09), True),
        ((0.05, 0.02, 0.09), (0.06, 0.02, 0.10), False),
        ((0.034, 0.02, 0.09), (0.07, 0.05, 0.09), False),
    ],
)
def test_few_stretches_that_differ_are_enough_where_the_measured_ones_are_sure(
    held, measured, stands
):
    """Held-out data alone are never sure here, and once are within the interval of the floor."""
    floor = Gap(0.03, 0.02, 0.042)
    assert (
        within_noise(Shown((Gap(*held), floor), (Gap(*measured), floor)), CONFIG) == ""
    ) == stands


@pytest.mark.parametrize(("value", "sure"), [(0.16, True), (0.06, False)])
def test_a_gap_that_noise_alone_does_not_reach_is_sure_though_its_stretches_differ(value, sure):
    """As that of robots that are seldom fast: 0.0046 m scatter in 20 stretches, 0.0103 in four."""
    gap, floor = Gap(value, 0.03, 0.27, 4), Gap(0.0316, 0.027, 0.0362, 20)
    assert gap.is_surely_above(floor, 1.0) == sure


@pytest.mark.parametrize(
    ("gap", "floor"),
    [
        ((1.05e-3, 7e-4, 1.4e-3, 4), (1e-3, 1e-3, 1e-3, 20)),  # the least floor that there is
        ((0.032, 0.02, 0.045, 4), (0.03, 0.0299, 0.0301, 2)),  # two stretches that happen to agree
        ((0.034, 0.02, 0.05, 300), (0.03, 0.025, 0.035, 20)),  # less than the floor is known to
    ],
)
def test_noise_decides_by_itself_only_where_it_is_known(gap, floor):
    assert not Gap(*gap).is_surely_above(Gap(*floor), 1.0)


@pytest.mark.parametrize(("share", "stands"), [(0.05, False), (0.22, True), (1.0, True)])
def test_a_name_closes_more_than_a_small_part(share, stands):
    assert (closes_a_part(share, CONFIG.least_held_out) == "") == stands


@pytest.mark.parametrize(
    ("share", "spread", "least_m", "least", "stands"),
    [
        (0.43, 2.0, 0.1, 0.5, False),
        (0.43, 1.1, 0.1, 0.5, True),
        (0.43, 1.1, 0.13, 0.5, False),
        (0.6, 2.0, 0.13, 0.5, True),
        (0.6, 2.0, 0.13, 0.8, False),
    ],
)
def test_a_name_that_leaves_more_than_noise_closes_the_most(share, spread, least_m, least, stands):
    """Of chi-squared on the measured runs, or of the gap on held-out data."""
    left = Gap(0.2, least_m, 0.3), Gap(0.1, 0.08, 0.12)
    assert (closes_the_most(share, spread, left, least, CONFIG) == "") == stands
