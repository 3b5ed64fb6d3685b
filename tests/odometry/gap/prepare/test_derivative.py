"""The derivative of a hypothesis against differences of its rows."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.late_treads import ActuatorLag
from odometry.effects.commands.tread_slip import SlipBySpeed
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.measurement.gyroscope_error import GyroscopeError
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.contact_effects import InertiaByContact, SlopeByContact
from odometry.effects.motion.curvature import Curvature
from odometry.effects.motion.inertia_icr import InertiaByIndices
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.unknown.residual import COMPONENTS, Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.hypothesis import Hypothesis
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.uncertain_base import Uncertain
from odometry.gap.solve import differences

SMALL = 1e-4  # of the steps of a search
SMOOTH = Residual("time", tuple((c, k) for c in COMPONENTS for k in (0, 1)), "", (0.0, 10.0, 20.0))
HYPOTHESES = {
    "the base": (),
    "commands": (ActuatorLag(), WheelScale()),
    "motion": (Curvature(), SMOOTH),
    "motion after a smooth function": (SMOOTH, SlipBySpeed()),
    "sensors": (LeverArm(), HeadingOffset(), TimeOffset(), GyroscopeError()),
    "all": (WheelScale(), Curvature(), LeverArm(), TimeOffset()),
    "inertia": (WheelScale(), InertiaByIndices(), LateralSkid()),
    "one physics": (SlopeByContact(0.3), InertiaByContact(0.3)),
}


@pytest.fixture(scope="module")
def uncertain(known):
    free = np.array([True, True, True, True, False])
    base = replace(known.base, latency_s=0.03, gyro_latency_s=0.02)
    base = Uncertain(base, free, latency_is_free=True, has_gyroscope=True)
    count = len(base.values)
    information = np.diag(np.linspace(10.0, 20.0, count))
    return replace(known, uncertain=base, information=information)


@pytest.fixture(scope="module")
def measured(make_scene, uncertain):
    scene = make_scene(31, duration_s=24.0)
    rates = np.sin(scene.time_s)
    scene = replace(scene, inputs=replace(scene.inputs, yaw_rate_rad_s=rates))
    return measured_of((scene,), uncertain, GapConfig())


def started(uncertain, measured, effects):
    """Values of the base, then those where a search of each effect starts."""
    inputs, base = measured.scenes[0].inputs, uncertain.base
    of_effects = [effect.starts(inputs, base)[0] for effect in effects]
    return np.concatenate([uncertain.uncertain.values, *of_effects])


@pytest.mark.parametrize("effects", HYPOTHESES.values(), ids=HYPOTHESES)
def test_it_is_that_of_differences(uncertain, measured, effects):
    """Also next to a bound, and zero where a value is held."""
    hypothesis = Hypothesis(uncertain, measured, effects)
    values = started(uncertain, measured, effects)
    values += 0.3 * hypothesis.scales
    scales, rows = SMALL * hypothesis.scales, hypothesis.rows(values)
    low, high = (bound.copy() for bound in hypothesis.bounds)
    low[1] = high[1] = values[1]
    high[2] = values[2]
    elsewhere = hypothesis.held(np.zeros(len(values), dtype=np.bool_))
    low, high = np.where(elsewhere, values, low), np.where(elsewhere, values, high)
    expected = differences(hypothesis.rows, values, rows, scales, (low, high))
    found = hypothesis.derivative(hypothesis.rows, values, rows, scales, (low, high))
    assert (expected[:, 1] == 0).all()
    size = np.abs(expected).max(axis=0)
    np.testing.assert_array_less(np.abs(found - expected).max(axis=0), 1e-3 * size + 1e-9)


@pytest.mark.parametrize("effects", HYPOTHESES.values(), ids=HYPOTHESES)
def test_rows_of_several_values_are_those_of_each(uncertain, measured, effects):
    hypothesis = Hypothesis(uncertain, measured, effects)
    start = started(uncertain, measured, effects)
    values = [start + share * hypothesis.scales for share in np.linspace(0.0, 0.4, 12)]
    one_by_one = np.stack([hypothesis.rows(each) for each in values])
    size = np.abs(one_by_one).max()
    np.testing.assert_allclose(hypothesis.rows_of_each(values), one_by_one, atol=1e-9 * size)
    np.testing.assert_allclose(hypothesis.costs(values), (one_by_one**2).sum(axis=1))
