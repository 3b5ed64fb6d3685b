"""What holds for every kinematic model of the catalogue; a new row is tested the day it is born.

Finite differences are central with a step of 1e-6: truncation and rounding are both below 1e-8
for the values and speeds drawn here.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS, PARAMETER_NAMES

STEP = 1e-6
WIDTH = 0.5

# An ordinary value and a spread for every parameter that a model of the catalogue has.
ORDINARY = {
    "track_width": (0.5, 0.2),
    "alpha": (0.9, 0.1),
    "b_hat": (0.8, 0.3),
    "y_left": (0.45, 0.2),
    "y_right": (-0.35, 0.2),
    "x_icr": (0.05, 0.2),
    "alpha_left": (0.95, 0.1),
    "alpha_right": (0.9, 0.1),
}

# Parameters under which a model is the ideal differential drive of width WIDTH.
IDEAL = {
    "differential_drive": {"track_width": WIDTH},
    "icr_symmetric": {"alpha": 1.0, "b_hat": WIDTH},
    "icr": {"y_left": WIDTH / 2, "y_right": -WIDTH / 2, "x_icr": 0.0},
}

# Seen in a mirror, left is right: the parameters that swap, and those that change sign.
SWAPPED = {"y_left": "y_right", "y_right": "y_left"}
SWAPPED |= {"alpha_left": "alpha_right", "alpha_right": "alpha_left"}
NEGATED = {"y_left", "y_right"}

each_model = pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
speeds = st.tuples(st.floats(-2, 2), st.floats(-2, 2)).map(np.array)
equal_speeds = st.floats(-2, 2).map(lambda v: np.array([v, v]))
unit = st.floats(-1, 1)


def values_of(model, unit_draws):
    ordinary = [ORDINARY[parameter.name] for parameter in model.parameters]
    return np.array([m + d * s for (m, s), d in zip(ordinary, unit_draws, strict=False)])


def draws():
    return st.lists(unit, min_size=8, max_size=8)


def derivative(function, at):
    columns = [
        (function(at + STEP * e) - function(at - STEP * e)) / (2 * STEP) for e in np.eye(len(at))
    ]
    return np.stack(columns, axis=-1)


@each_model
@given(drawn=draws(), tread_speeds=speeds | equal_speeds)
def test_parameter_jacobian_is_the_derivative(model, drawn, tread_speeds):
    values = values_of(model, drawn)
    numeric = derivative(lambda v: model.twist(v, tread_speeds), values)
    exact = model.parameter_jacobian(values, tread_speeds)
    assert exact.shape == (3, len(model.parameters))
    np.testing.assert_allclose(exact, numeric, rtol=1e-6, atol=1e-7)


@each_model
@given(drawn=draws(), tread_speeds=speeds | equal_speeds)
def test_speed_jacobian_is_the_derivative(model, drawn, tread_speeds):
    values = values_of(model, drawn)
    numeric = derivative(lambda v: model.twist(values, v), tread_speeds)
    exact = model.speed_jacobian(values, tread_speeds)
    assert exact.shape == (3, 2)
    np.testing.assert_allclose(exact, numeric, rtol=1e-6, atol=1e-8)


@each_model
@given(drawn=draws(), tread_speeds=speeds)
def test_mirror_symmetry(model, drawn, tread_speeds):
    """Swap the treads and mirror the parameters: v_x stays, v_y and omega change sign."""
    names = [parameter.name for parameter in model.parameters]
    named = dict(zip(names, values_of(model, drawn), strict=True))
    mirrored = [named[SWAPPED.get(name, name)] * (-1 if name in NEGATED else 1) for name in names]
    seen = model.twist(np.array(mirrored), tread_speeds[::-1])
    expected = model.twist(np.array(list(named.values())), tread_speeds) * [1, -1, -1]
    np.testing.assert_allclose(seen, expected, rtol=1e-12, atol=1e-12)


@each_model
@given(tread_speeds=speeds)
def test_ideal_differential_drive_is_a_special_case(model, tread_speeds):
    v_left, v_right = tread_speeds
    twist = model.twist(model.pack(IDEAL[model.name]), tread_speeds)
    expected = [(v_left + v_right) / 2, 0, (v_right - v_left) / WIDTH]
    np.testing.assert_allclose(twist, expected, rtol=1e-12, atol=1e-12)


@each_model
def test_a_left_turn_on_the_spot(model):
    """CONVENTIONS: v_left < 0 < v_right, omega > 0."""
    twist = model.twist(model.pack(IDEAL[model.name]), np.array([-1.0, 1.0]))
    np.testing.assert_allclose(twist, [0, 0, 2 / WIDTH], atol=1e-15)


@each_model
def test_stacks_are_taken_one_by_one(model, rng):
    """Parameters by row, speeds by column: broadcasting gives what a loop gives."""
    many = np.stack([values_of(model, rng.uniform(-1, 1, 8)) for _ in range(4)])
    tread_speeds = rng.uniform(-2, 2, (5, 2))
    for function in (model.twist, model.parameter_jacobian, model.speed_jacobian):
        stacked = function(many[:, None], tread_speeds)
        looped = [[function(v, speeds) for speeds in tread_speeds] for v in many]
        assert stacked.shape == np.shape(looped)
        np.testing.assert_allclose(stacked, looped, rtol=0, atol=1e-14)


@each_model
def test_inputs_are_not_changed(model):
    values = values_of(model, np.zeros(8))
    tread_speeds = np.array([0.3, 0.5])
    before = values.copy(), tread_speeds.copy()
    for function in (model.twist, model.parameter_jacobian, model.speed_jacobian):
        function(values, tread_speeds)
    np.testing.assert_array_equal(values, before[0])
    np.testing.assert_array_equal(tread_speeds, before[1])


@each_model
def test_names_are_those_of_the_conventions(model):
    assert tuple(parameter.name for parameter in model.parameters) == PARAMETER_NAMES[model.name]
    assert model.source


@each_model
def test_pack_orders_and_checks(model):
    ordinary = {p.name: ORDINARY[p.name][0] for p in model.parameters}
    backwards = dict(reversed(ordinary.items()))
    np.testing.assert_array_equal(model.pack(backwards), list(ordinary.values()))
    with pytest.raises(ParameterError, match=r"'wheels'.*track_width|'wheels'.*al|'wheels'.*y_"):
        model.pack({**ordinary, "wheels": 4.0})
    needed = next(p.name for p in model.parameters if p.default is None)
    del ordinary[needed]
    with pytest.raises(ParameterError, match=needed):
        model.pack(ordinary)


@each_model
def test_no_value_is_nan(model):
    ordinary = {p.name: ORDINARY[p.name][0] for p in model.parameters}
    for name in ordinary:
        with pytest.raises(ParameterError, match=name):
            model.pack({**ordinary, name: float("nan")})


def test_bounds_are_named():
    with pytest.raises(ParameterError, match=r"b_hat = -1"):
        MODELS["icr_symmetric"].pack({"alpha": 1.0, "b_hat": -1.0})


@pytest.mark.parametrize("y_right", [0.2, 0.3])
def test_y_left_exceeds_y_right(y_right):
    with pytest.raises(ParameterError, match="y_left"):
        MODELS["icr"].pack({"y_left": 0.2, "y_right": y_right, "x_icr": 0.0})


def test_an_asymmetric_twist_by_hand():
    """D = 0.8; omega = 1 / 0.8, v_x = (1.5*0.5 + 0.5*0.3) / 0.8, v_y = -0.1 omega."""
    values = MODELS["icr"].pack({"y_left": 0.5, "y_right": -0.3, "x_icr": 0.1})
    twist = MODELS["icr"].twist(values, np.array([0.5, 1.5]))
    np.testing.assert_allclose(twist, [1.125, -0.125, 1.25], rtol=1e-15)


def test_slip_factors_multiply_the_tread_speeds():
    plain = MODELS["icr"].pack({"y_left": 0.5, "y_right": -0.3, "x_icr": 0.1})
    slipping = MODELS["icr"].pack(
        {"y_left": 0.5, "y_right": -0.3, "x_icr": 0.1, "alpha_left": 0.8, "alpha_right": 0.9}
    )
    np.testing.assert_allclose(
        MODELS["icr"].twist(slipping, np.array([1.0, 2.0])),
        MODELS["icr"].twist(plain, np.array([0.8, 1.8])),
    )


def test_at_each_tread_icr_the_ground_speed_is_the_tread_speed(rng):
    """The definition of a tread ICR: v_x - omega y_left = v_left, and v_y + omega x_icr = 0."""
    for y_left, half, x_icr in rng.uniform([0.1, 0.1, -0.3], [0.6, 0.6, 0.3], (20, 3)):
        v_left, v_right = rng.uniform(-2, 2, 2)
        values = MODELS["icr"].pack({"y_left": y_left, "y_right": -half, "x_icr": x_icr})
        v_x, v_y, omega = MODELS["icr"].twist(values, np.array([v_left, v_right]))
        np.testing.assert_allclose(
            [v_x - omega * y_left, v_x + omega * half, v_y + omega * x_icr],
            [v_left, v_right, 0],
            atol=1e-13,
        )
