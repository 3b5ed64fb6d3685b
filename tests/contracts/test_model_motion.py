"""The motion of every kinematic model: its signs, mirror, special case and limits."""

import numpy as np
import pytest
from hypothesis import assume, given

from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot
from tests.contracts.model_draws import draws, inputs_, values_of
from tests.contracts.test_models import CONVENTIONS, INERTIA, each_model, ordinary

WIDTH = 0.5

# Parameters under which a model is the ideal differential drive of width WIDTH.
STRAIGHT_ICRS = {"y_left": WIDTH / 2, "y_right": -WIDTH / 2, "x_icr": 0.0}
NO_INERTIA = dict.fromkeys(INERTIA, 0.0) | {"eta_0": 1.0, "h": 1.0, "mass": 50.0}
NO_INERTIA |= {"track_width": WIDTH}
IDEAL = {
    "differential_drive": {"track_width": WIDTH},
    "icr_symmetric": {"alpha": 1.0, "b_hat": WIDTH},
    "icr": STRAIGHT_ICRS,
    "radius_of_curvature": {"alpha": 1.0, "beta_1": 0.0, "beta_2": 1.0, "track_width": WIDTH},
    "full_linear": dict(
        zip(CONVENTIONS["full_linear"], (0.5, 0.5, 0, 0, -1 / WIDTH, 1 / WIDTH), strict=True)
    ),
    "icr_slope": {
        **STRAIGHT_ICRS,
        "lambda_1": 0.0,
        "lambda_2": 0.0,
        "v_max": 1.0,
        "half_width": WIDTH / 2,
        "half_length": WIDTH / 2,
    },
    "icr_inertia": NO_INERTIA,
    "icr_inertia_measured": NO_INERTIA,
    "traction_mode": {"k": 1.0, "m": 1.0, "track_width": WIDTH},
}
NEVER_IDEAL = {"contact"}  # its treads scrub: only a force balance without friction would not

# Seen in a mirror, left is right: the parameters that swap, change sign, or turn over.
SWAPPED = {"y_left": "y_right", "alpha_left": "alpha_right", "gamma_11": "gamma_12"}
SWAPPED |= {"gamma_21": "gamma_22", "gamma_31": "gamma_32"}
SWAPPED |= {right: left for left, right in SWAPPED.items()}
NEGATED = {"y_left", "y_right", "gamma_21", "gamma_22", "gamma_31", "gamma_32"}
NEGATED |= {"epsilon_0", "eta_1", "y_cm"}
INVERTED = {"h"}  # V_l + H V_r and V_r + V_l / H have the same sign


@each_model
@given(drawn=draws, inputs=inputs_())
def test_mirror_symmetry(model, drawn, inputs):
    """Swap treads, roll and sideways acceleration, mirror the parameters: v_x alone stays."""
    values = values_of(model, drawn)
    if "h" in ordinary(model):
        assume(abs(inputs.left + values[7] * inputs.right) > 1e-9)
    named = dict(zip(ordinary(model), values, strict=True))
    mirrored = []
    for name in named:
        value = named[SWAPPED.get(name, name)] * (-1 if name in NEGATED else 1)
        mirrored.append(1 / value if name in INVERTED else value)
    seen = Inputs(
        inputs.tread_speeds_m_s[::-1],
        -inputs.roll_rad,
        inputs.pitch_rad,
        inputs.accelerations_m_s2 * [1, -1],
    )
    expected = model.twist(values, inputs) * [1, -1, -1]
    np.testing.assert_allclose(
        model.twist(np.array(mirrored), seen), expected, rtol=1e-9, atol=1e-12
    )


def test_every_model_is_ideal_somewhere():
    assert set(MODELS) - set(IDEAL) == NEVER_IDEAL, "IDEAL of tests/contracts/test_model_motion.py"


@pytest.mark.parametrize("name", IDEAL)
@given(inputs=inputs_())
def test_ideal_differential_drive_is_a_special_case(name, inputs):
    v_left, v_right = inputs.tread_speeds_m_s
    twist = MODELS[name].twist(MODELS[name].pack(IDEAL[name]), inputs)
    expected = [(v_left + v_right) / 2, 0, (v_right - v_left) / WIDTH]
    np.testing.assert_allclose(twist, expected, rtol=1e-12, atol=1e-12)


@each_model
def test_a_left_turn_on_the_spot(model):
    """data/README.md: v_left < 0 < v_right, omega > 0."""
    inputs = Inputs(np.array([-1.0, 1.0]), accelerations_m_s2=np.zeros(2))
    assert model.twist(model.pack(ordinary(model)), inputs)[2] > 0.1


@each_model
@pytest.mark.parametrize("tilt", [0.0, 0.1], ids=["level", "tilted"])
def test_all_is_finite_at_a_standstill_straight_and_on_the_spot(model, tilt):
    """A standstill stays one; equal speeds drive straight unless a model has other slip."""
    speeds = np.array([[0, 0], [1, 1], [-1, -1], [1, -1], [-1, 1], [0, 1], [1, 0]], float)
    attitude = np.full(len(speeds), tilt)
    inputs = Inputs(speeds, attitude, attitude, np.zeros((len(speeds), 2)))
    for named in (ordinary(model), model.guess(Robot(WIDTH))):
        values = model.pack(named)
        for function in (model.twist, model.parameter_jacobian, model.speed_jacobian):
            assert np.all(np.isfinite(function(values, inputs)))
        if tilt == 0:
            np.testing.assert_allclose(model.twist(values, inputs)[0], 0, atol=1e-12)
