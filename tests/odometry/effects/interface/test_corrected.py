"""A model with effects has the face of any model."""

from dataclasses import replace

import numpy as np

from odometry.effects.commands.late_treads import ActuatorLag
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import (
    Added,
    Corrected,
    corrected_twist,
    delay_s,
    seen_poses,
    with_true_speeds,
)
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.curvature import Curvature
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.motion.terrain import Terrain
from odometry.models.catalogue import MODELS
from tests.odometry.effects.reports import reported

SCALE = Added(WheelScale(), np.array([0.8, 1.2]))
LAG = Added(ActuatorLag(), np.array([0.1]))
SKID = Added(LateralSkid(), np.array([0.2]))
BENDS = Added(Curvature(), np.array([1.2, 0.4, 0.7]))
ARM = Added(LeverArm(), np.array([0.3, 0.1]))
TURNED = Added(HeadingOffset(), np.array([0.25]))
LATE = Added(TimeOffset(), np.array([0.15]))


def test_commands_come_first_whatever_the_order_then_motion_in_order(bench, rng):
    """By hand: scaled speeds, the base, the width, then the skid of what is left of the turn."""
    inputs = bench.drive(rng)
    true = type(inputs)(
        np.array([0.8, 1.2]) * inputs.tread_speeds_m_s, inputs.roll_rad, inputs.pitch_rad
    )
    bent = BENDS.effect.twist(
        BENDS.values, MODELS["icr"].twist(bench.values, true), true, bench.base
    )
    expected = bent - 0.2 * np.outer(bent[:, 2], [0, 1, 0])
    for effects in ([SCALE, BENDS, SKID], [BENDS, SKID, SCALE]):
        found = corrected_twist(bench.base, effects, inputs)
        np.testing.assert_allclose(found, expected, atol=1e-14)


def test_effects_on_the_motion_act_in_order(bench, rng):
    """A width that is changed before the ground is, and after."""
    inputs = bench.drive(rng)
    ice = Added(Terrain(("ice",)), np.array([0.3, -0.2, 0.1, 0.0, 0.05]))
    plain = MODELS["icr"].twist(bench.values, inputs)

    def act(added, twist):
        return added.effect.twist(added.values, twist, inputs, bench.base)

    bent_first, ice_first = act(ice, act(BENDS, plain)), act(BENDS, act(ice, plain))
    assert np.abs(bent_first - ice_first).max() > 0.01
    for effects, expected in (([BENDS, ice], bent_first), ([ice, BENDS], ice_first)):
        np.testing.assert_array_equal(corrected_twist(bench.base, effects, inputs), expected)


def test_true_speeds_pass_from_effect_to_effect_and_all_else_stays(bench, rng):
    inputs = bench.drive(rng)
    found = with_true_speeds([SCALE, SKID, LAG], inputs)
    scaled = type(inputs)(np.array([0.8, 1.2]) * inputs.tread_speeds_m_s, time_s=inputs.time_s)
    lagged = LAG.effect.tread_speeds(LAG.values, scaled)
    np.testing.assert_allclose(found.tread_speeds_m_s, lagged, atol=1e-15)
    for name, values in vars(inputs).items():
        if name != "tread_speeds_m_s":
            np.testing.assert_array_equal(getattr(found, name), values)


def test_without_effects_it_is_the_base(bench, rng):
    inputs, base = bench.drive(rng), MODELS["icr"]
    model = Corrected(base, bench.robot, [])
    for function in ("twist", "speed_jacobian"):
        np.testing.assert_array_equal(
            getattr(model, function)(bench.values, inputs),
            getattr(base, function)(bench.values, inputs),
        )
    np.testing.assert_allclose(
        model.parameter_jacobian(bench.values, inputs),
        base.parameter_jacobian(bench.values, inputs),
        atol=1e-8,
    )
    assert model.parameters == base.parameters
    assert model.guess(bench.robot) == base.guess(bench.robot)


def test_the_jacobian_is_that_of_the_effect_too(bench, rng):
    """Under a skid, v_y has -x_shift times the derivative of omega added."""
    inputs = bench.drive(rng)
    plain = MODELS["icr"].parameter_jacobian(bench.values, inputs)
    expected = plain.copy()
    expected[:, 1] -= 0.2 * plain[:, 2]
    model = Corrected(MODELS["icr"], bench.robot, [SKID])
    found = model.parameter_jacobian(bench.values, inputs)
    np.testing.assert_allclose(found, expected, atol=1e-8)


def test_the_measurement_is_no_part_of_the_motion(bench, rng):
    inputs = bench.drive(rng)
    model = Corrected(MODELS["icr"], bench.robot, [ARM, TURNED, LATE])
    np.testing.assert_array_equal(
        model.twist(bench.values, inputs), MODELS["icr"].twist(bench.values, inputs)
    )
    assert model.name == "icr+lever_arm+heading_offset+time_offset"


def test_a_sensor_is_moved_then_turned():
    robot = np.array([[1.0, 2.0, np.pi / 2]])
    seen = [[0.9, 2.3, np.pi / 2 + 0.25]]
    np.testing.assert_allclose(
        seen_poses([SCALE, ARM, TURNED, LATE], robot, reported(robot)), seen, atol=1e-15
    )
    np.testing.assert_allclose(delay_s([LATE, ARM, LATE], np.zeros(2)), 0.3)


def test_under_effects_on_commands_alone_the_derivative_is_the_base_s(bench, rng):
    inputs, base = bench.drive(rng), MODELS["icr"]
    model = Corrected(base, bench.robot, [SCALE, LAG])
    found = model.linearised(bench.values, inputs)
    expected = base.linearised(bench.values, with_true_speeds([SCALE, LAG], inputs))
    np.testing.assert_array_equal(found.twist, model.twist(bench.values, inputs))
    np.testing.assert_array_equal(found.by_parameters, expected.by_parameters)
    steps = 1e-6 * np.eye(5)
    numeric = [
        (model.twist(bench.values + h, inputs) - model.twist(bench.values - h, inputs)) / 2e-6
        for h in steps
    ]
    np.testing.assert_allclose(found.by_parameters, np.stack(numeric, axis=-1), atol=1e-8)


def test_ordinary_sizes_are_those_of_the_base(bench):
    """What is per newton is scaled by the robot's mass, with an effect added as without."""
    base, robot = MODELS["icr_inertia"], replace(bench.robot, mass=50.0)
    model = Corrected(base, robot, [SCALE])
    np.testing.assert_array_equal(model.ordinary_sizes(robot), base.ordinary_sizes(robot))
