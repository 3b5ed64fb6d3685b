"""What a name must be: sure of what makes it that effect, and no part of something else."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.by_side import DelayBySide
from odometry.effects.commands.late_treads import ActuatorLag, CommandDelay
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import HeadingOffset
from odometry.effects.measurement.time_offset import ClockDrift, TimeOffset
from odometry.effects.motion.curvature import Curvature
from odometry.gap.config import GapConfig
from odometry.gap.fit.effect_values import essence_spans_none
from odometry.gap.name.form_gates import (
    is_most_of,
    is_of_one_side,
    is_of_stamps,
    is_resolved,
    is_sure_of_its_essence,
    is_the_main_part,
    is_unbeaten,
    no_wheel_grows,
)

CONFIG = GapConfig()


@pytest.mark.parametrize(
    ("rise", "spans_none", "refused"),
    [
        (9.1, False, False),
        (8.9, False, True),
        (-1.0, False, True),
        (99.0, True, True),
        (101.0, True, False),
    ],
)
def test_a_name_is_sure_of_what_makes_it_what_it_is(rise, spans_none, refused):
    curvature = Added(Curvature(), np.array([1.2, 0.3, 0.5]))
    reason = is_sure_of_its_essence(curvature, rise, GapConfig(), spans_none=spans_none)
    assert ("beta_1, which makes it this effect" in reason) == refused


@pytest.mark.parametrize(("sigma", "spans"), [(0.16, True), (0.15, False)])
def test_the_interval_of_what_makes_a_name_spans_none(sigma, spans):
    """Of beta_1 = 0.3, the second of three numbers behind one of another effect."""
    fit = SimpleNamespace(
        effects=(
            Added(TimeOffset(), np.array([0.1])),
            Added(Curvature(), np.array([1.2, 0.3, 0.5])),
        ),
        covariance=np.diag([1.0, 0.1, sigma, 2.0]) ** 2,
    )
    assert essence_spans_none(fit, 1) == spans


@pytest.mark.parametrize(
    ("factors", "stands"), [((0.94, 1.0), True), ((1.005, 0.95), True), ((0.986, 0.987), False)]
)
def test_a_tyre_is_lost_on_one_side(factors, stands):
    reason = is_of_one_side(np.array(factors), CONFIG)
    assert (reason == "") == stands
    assert stands or "0.986 and 0.987 times as large" in reason


@pytest.mark.parametrize(("closed", "stands"), [(91.0, True), (89.0, False)])
def test_a_name_is_the_main_part_of_a_function_that_does_a_little_more(closed, stands):
    assert is_most_of(closed, 100.0, GapConfig()) == stands


@pytest.mark.parametrize(("of_refused", "stands"), [(115.0, False), (105.0, True), (90.0, True)])
def test_a_refused_candidate_that_explains_more_refuses_the_next(of_refused, stands):
    assert (is_unbeaten(100.0, "traction_loss", of_refused, 10.0) == "") == stands


@pytest.mark.parametrize(
    ("effect", "values", "stands"),
    [
        (TimeOffset(), [-0.03], False),
        (TimeOffset(), [-0.08], True),
        (ClockDrift(), [0.0, 2e-4], False),  # 32 ms at the end of 160 s
        (ClockDrift(), [0.0, -5e-4], True),
        (HeadingOffset(), [0.03], True),
    ],
)
def test_stamps_off_by_less_than_a_period_are_no_name_beside_late_treads(
    make_scene, effect, values, stands
):
    """Speeds are recorded every 50 ms."""
    added, scenes = Added(effect, np.array(values)), [make_scene(1)]
    late = Added(CommandDelay(), np.array([0.2]))
    assert (is_resolved(added, [late], scenes) == "") is stands
    assert is_resolved(added, [], scenes) == ""


@pytest.mark.parametrize("has_gyroscope", [False, True])
def test_a_clock_beside_late_treads_needs_a_gyroscope(has_gyroscope):
    """A lag that changes over the run is a clock that runs fast, to first order."""
    scenes = [SimpleNamespace(reported_turns=np.zeros(1) if has_gyroscope else None)]
    drift, constant = (
        Added(of(), np.array(values))
        for of, values in ((ClockDrift, [0.2, -0.004]), (TimeOffset, [0.2]))
    )
    lag, wheels = Added(ActuatorLag(), np.array([0.3])), Added(WheelScale(), np.ones(2))
    assert (is_of_stamps(drift, [lag], scenes) == "") == has_gyroscope
    assert is_of_stamps(drift, [wheels], scenes) == ""
    assert is_of_stamps(constant, [lag], scenes) == ""
    one_side = Added(DelayBySide(), np.array([0.0, 0.2]))
    assert (is_of_stamps(constant, [one_side], scenes) == "") == has_gyroscope


@pytest.mark.parametrize(("of_names", "stands"), [(63.0, False), (77.0, True), (100.0, True)])
def test_a_name_is_the_main_part_beside_a_smooth_function(of_names, stands):
    assert (is_the_main_part(of_names, 100.0, CONFIG) == "") == stands


@pytest.mark.parametrize(("left", "right", "stands"), [(0.9, 1.0, True), (1.06, 1.06, False)])
def test_no_wheel_grows_from_a_moment_on(left, right, stands):
    reason = no_wheel_grows(np.array([left, right]), CONFIG)
    assert (reason == "") == stands
