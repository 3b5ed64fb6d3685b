"""What holds for every effect; a new row is tested the day it is born."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.effects.catalogue import BY_FORM, EFFECTS, added_effects, effect_table
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.base import CommandEffect, MeasurementEffect, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import (
    Added,
    corrected_twist,
    delay_s,
    reported_yaw_rate,
    seen_poses,
)
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment, Gradual
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.terrain import Terrain
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.effects.unknown.residual import Residual
from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import (
    ParameterSet,
    TerrainParameters,
    read_parameters,
    write_parameters,
)
from odometry.recording.run import Robot
from tests.odometry.effects.reports import reported

ICRS = {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}
ACTS_ON = {"commands": CommandEffect, "motion": MotionEffect, "measurement": MeasurementEffect}
ONE_OF_EACH = [
    *(effect() for effect in EFFECTS if effect not in (Terrain, TractionLoss)),
    in_course(TractionLoss(), FromAMoment(((2.0, 30.0),))),
    in_course(TractionLoss(), FromAMoment(((2.0, 30.0), (1.0, 60.0)))),
    in_course(WheelScale(), Gradual(40.0)),
    Terrain(("ice", "wet grass")),
    Residual("heading", (("v_x", 0), ("omega", 3))),
    Residual("pitch", (("v_y", 1),), "speed", (-0.1, 0.0, 0.2)),
]
each_effect = pytest.mark.parametrize(
    "effect", ONE_OF_EACH, ids=lambda effect: "-".join(effect.key)
)


def values_of(effect, rng):
    """Random values near where a search begins, within bounds."""
    near = [p.start + 3 * p.scale * rng.uniform(-1, 1) for p in effect.parameters]
    return np.clip(near, [p.low for p in effect.parameters], [p.high for p in effect.parameters])


@each_effect
@settings(max_examples=15)  # of a seed, which is drawn for 49 effects
@given(seed=st.integers(0, 2**32 - 1))
def test_absent_values_change_nothing(seed, effect):
    """Each parameter at its `absent` value; those without one anywhere within their bounds."""
    if all(parameter.absent is None for parameter in effect.parameters):
        return  # balances of contacts are absent on ground, not by a value: see test_contact_change
    rng = np.random.default_rng(seed)
    anywhere = values_of(effect, rng)
    values = np.array(
        [
            v if p.absent is None else p.absent
            for p, v in zip(effect.parameters, anywhere, strict=True)
        ]
    )
    icr = np.array([*rng.uniform(0.3, 0.8, 1), *rng.uniform(-0.8, -0.3, 1), 0.1, 0.9, 0.95])
    base = Base(MODELS["icr"], icr, Robot(0.5))
    inputs = Inputs(
        rng.uniform(-1.5, 1.5, (30, 2)),
        *rng.uniform(-0.2, 0.2, (2, 30)),
        time_s=np.sort(rng.uniform(0, 9, 30)),
        terrain=np.where(rng.random(30) < 0.5, "ice", "sand"),
        heading_rad=rng.uniform(-9, 9, 30),
    )
    effects = [Added(effect, values)]
    np.testing.assert_allclose(
        corrected_twist(base, effects, inputs), base.model.twist(icr, inputs), atol=1e-9
    )
    poses = rng.uniform(-3, 3, (5, 3))
    np.testing.assert_allclose(seen_poses(effects, poses, reported(poses)), poses, atol=1e-15)
    assert not delay_s(effects, inputs.time_s).any()
    rates = rng.normal(size=30)
    np.testing.assert_array_equal(reported_yaw_rate(effects, rates, inputs), rates)


@each_effect
def test_a_parameter_set_gives_every_effect_back(effect, rng, tmp_path):
    """Through TOML: name, form, settings and values to the last bit."""
    added = Added(effect, values_of(effect, rng))
    table = TerrainParameters("icr", ICRS, effects=(effect_table(added),))
    write_parameters(tmp_path / "set.toml", ParameterSet({"lawn": table}))
    again = read_parameters(tmp_path / "set.toml").terrains["lawn"].effects
    (found,) = added_effects(again, "set.toml: [terrain.lawn]")
    assert type(found.effect) is type(effect)
    assert found.effect.settings() == effect.settings()
    assert [p.name for p in found.effect.parameters] == [p.name for p in effect.parameters]
    np.testing.assert_array_equal(found.values, added.values)
    assert found.by_name == added.by_name


@each_effect
def test_every_effect_says_what_it_is(effect):
    assert isinstance(effect, ACTS_ON[effect.acts_on])
    assert BY_FORM[effect.name, effect.form] is type(getattr(effect, "inner", effect))
    for words in ("in_words", "equation", "source", "looks_like", "remedy", "needs"):
        assert getattr(effect, words)
    names = [parameter.name for parameter in effect.parameters]
    assert len(set(names)) == len(names) > 0
    for p in effect.parameters:
        assert p.low <= p.start <= p.high
        assert p.scale > 0
        assert p.absent is None or p.low <= p.absent <= p.high


@each_effect
def test_starts_lie_within_bounds(effect, bench, rng):
    low, high = np.array([(p.low, p.high) for p in effect.parameters]).T
    starts = effect.starts(bench.drive(rng), bench.base)
    assert starts.shape[1:] == low.shape
    assert ((starts >= low) & (starts <= high)).all()


@pytest.mark.parametrize("course", [FromAMoment(), Gradual(9.0)])
def test_the_measurement_has_no_course_and_no_course_a_second(course):
    for effect in (TimeOffset(), in_course(WheelScale(), Gradual(9.0))):
        with pytest.raises(ParameterError, match="has no course in time"):
            in_course(effect, course)


def test_a_set_of_version_0_6_says_a_moment_alone():
    table = {
        "name": "traction_loss",
        "form": "k_m",
        "parameters": {"k": 0.5, "m": 0.6, "moment": 9},
    }
    (found,) = added_effects([table], "here")
    assert found.effect.course == "from_a_moment"
    assert found.by_name == table["parameters"]


def test_those_that_are_mistaken_for_another_name_one_of_the_catalogue():
    known = {effect.name for effect in EFFECTS}
    assert {other for effect in EFFECTS for other in effect.alike} <= known


def test_the_names_that_the_answer_may_have():
    """At least these, slope in three forms and inertia in two."""
    names = [effect.name for effect in EFFECTS]
    assert (names.count("slope_sliding"), names.count("inertia")) == (3, 2)
    assert set(names) == {
        *("slope_sliding", "inertia", "curvature", "wheel_scale", "terrain", "traction_loss"),
        *("lateral_skid", "time_offset", "actuator_lag", "lever_arm", "heading_offset"),
        *("command_delay", "drive_limit", "tread_slip", "gyroscope_error", "reference_fault"),
    }


SCALE = {"name": "wheel_scale", "form": "factors", "parameters": {"c_l": 1.0, "c_r": 0.9}}


def test_the_source_of_an_effect_may_be_stated():
    (found,) = added_effects([{**SCALE, "source": "measured with a tape"}], "here")
    assert found.by_name == SCALE["parameters"]


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({**SCALE, "name": "wheels"}, r"wheels/factors, expected one of wheel_scale/factors"),
        ({**SCALE, "form": "slip"}, r"wheel_scale/slip, expected one of"),
        ({**SCALE, "name": ["wheel_scale"]}, r"expected one of"),
        ({}, r"None/None, expected one of"),
        ({**SCALE, "parameters": 3}, r"parameters = 3, expected a table"),
        ({**SCALE, "parameters": {"c_l": 1.0}}, r"\['c_l'\], expected \['c_l', 'c_r'\]"),
        ({**SCALE, "parameters": {"c_l": 1.0, "c_r": 1.0, "c": 1.0}}, r"expected \['c_l', 'c_r'\]"),
        ({**SCALE, "parameters": {"c_l": 1.0, "c_r": "one"}}, r"c_r = 'one', expected a finite"),
        ({**SCALE, "parameters": {"c_l": 1.0, "c_r": np.inf}}, r"c_r = inf, expected a finite"),
        ({**SCALE, "colour": "red"}, r"WheelScale"),
        ({"name": "unknown", "form": "residual", "parameters": {}}, r"variable"),
        (
            {
                "name": "slope_sliding",
                "form": "icr_slope",
                "parameters": {"half_width": "wide", "half_length": 1.0},
            },
            r"half_width = 'wide', expected a finite number",
        ),
        (
            {
                "name": "unknown",
                "form": "residual",
                "variable": "speed",
                "knots": [0, 1e300],
                "parameters": {},
            },
            r"knots.*expected a finite number",
        ),
        (
            {
                "name": "unknown",
                "form": "residual",
                "variable": "speed",
                "knots": [1, 0],
                "parameters": {},
            },
            r"expected increasing numbers",
        ),
        ({**SCALE, "course": "at_night"}, r"course = 'at_night', expected one of from_a_moment"),
        ({**SCALE, "course": "gradual", "full_s": "long"}, r"full_s = 'long', expected a finite"),
        ({**SCALE, "course": "from_a_moment", "observed_s": 3}, r"observed_s = 3, expected a list"),
        (
            {**SCALE, "course": "from_a_moment", "observed_s": [[1]]},
            r"observed_s = .*expected a finite",
        ),
        (
            {"name": "terrain", "form": "icr_by_label", "labels": "ice", "parameters": {}},
            r"expected a list of names",
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_place(wrong, words):
    with pytest.raises(ParameterError, match=rf"a\.toml: effects\[1\].*{words}"):
        added_effects([SCALE, wrong], "a.toml")
