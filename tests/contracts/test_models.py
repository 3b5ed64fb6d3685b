"""What holds for every kinematic model of the catalogue; a new row is tested the day it is born.

Finite differences are central, with a step of 1e-5 of a parameter's spread and of 1 m/s:
truncation and rounding are both below 1e-8 for the values and inputs drawn here, away from the
switching surfaces that the models' docstrings name.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS, PARAMETER_NAMES
from odometry.models.inputs import Inputs
from odometry.models.invertible import InvertibleModel
from odometry.run import Robot

STEP = 1e-5
MARGIN = 1e-3  # how far from a switching surface a function is differentiated
WIDTH = 0.5
G = 9.80665

# Names as the table in CONVENTIONS spells them, units, and an ordinary value with a spread.
ICR = {
    "y_left": ("m", 0.45, 0.2),
    "y_right": ("m", -0.35, 0.2),
    "x_icr": ("m", 0.05, 0.2),
    "alpha_left": ("", 0.95, 0.1),
    "alpha_right": ("", 0.9, 0.1),
}
INERTIA = {
    "zeta_0": ("m", 0.05, 0.05),
    "zeta_1": ("m/N", 2e-4, 1e-4),
    "epsilon_0": ("m", 0.1, 0.1),
    "epsilon_1": ("m/N", 1e-3, 1e-3),
    "eta_0": ("", 2.5, 0.5),
    "eta_1": ("1/N", 0.0, 3e-3),
    "eta_2": ("1/N^2", 1e-5, 1e-5),
    "h": ("", 0.7, 0.2),
    "mass": ("kg", 200.0, 50.0),
    "x_cm": ("m", 0.04, 0.04),
    "y_cm": ("m", 0.02, 0.02),
    "track_width": ("m", 0.45, 0.05),
}
CONVENTIONS = {
    "differential_drive": {"track_width": ("m", 0.5, 0.2)},
    "icr_symmetric": {"alpha": ("", 0.9, 0.1), "b_hat": ("m", 0.8, 0.3)},
    "icr": ICR,
    "radius_of_curvature": {
        "alpha": ("", 0.9, 0.1),
        "beta_1": ("", 1.5, 1.0),
        "beta_2": ("", 0.6, 0.8),
        "track_width": ("m", 0.5, 0.2),
    },
    "full_linear": {
        "gamma_11": ("", 0.47, 0.1),
        "gamma_12": ("", 0.44, 0.1),
        "gamma_21": ("", -0.22, 0.3),
        "gamma_22": ("", 0.26, 0.3),
        "gamma_31": ("1/m", -1.0, 0.5),
        "gamma_32": ("1/m", 0.8, 0.5),
    },
    "icr_slope": {
        **ICR,
        "lambda_1": ("s/rad", 1.5, 1.0),
        "lambda_2": ("s/rad", 3.0, 2.0),
        "v_max": ("m/s", 1.0, 0.3),
        "half_width": ("m", 0.2, 0.1),
        "half_length": ("m", 0.2, 0.1),
    },
    "icr_inertia": INERTIA,
    "icr_inertia_measured": INERTIA,
    "traction_mode": {
        "k": ("", 0.9, 0.1),
        "m": ("", 0.6, 0.3),
        "track_width": ("m", 0.5, 0.2),
    },
    "contact": {
        "mu": ("", 0.6, 0.2),
        "mass": ("kg", 50.0, 20.0),
        "x_cm": ("m", 0.03, 0.03),
        "y_cm": ("m", 0.01, 0.03),
        "height": ("m", 0.2, 0.1),
        "half_length": ("m", 0.25, 0.05),
        "half_width": ("m", 0.25, 0.05),
        "contacts": ("", 3.0, 0.0),
        "slip_scale": ("m/s", 0.05, 0.02),
    },
}
KNOWN = {"track_width", "v_max", "half_width", "half_length", "mass", "contacts", "x_cm", "y_cm"}
SEARCHED = {"contact": {"x_cm", "y_cm", "half_length"}}  # turning scrubs by them: motion shows them

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

each_model = pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
invertible = {name: m for name, m in MODELS.items() if isinstance(m, InvertibleModel)}
each_invertible = pytest.mark.parametrize("model", invertible.values(), ids=invertible)

speed = st.floats(-2, 2)
tread_speeds = st.one_of(
    st.tuples(speed, speed), speed.map(lambda v: (v, v)), speed.map(lambda v: (v, -v))
).map(np.array)
small = st.floats(-0.4, 0.4)
draws = st.lists(st.floats(-1, 1), min_size=12, max_size=12)


@st.composite
def inputs_(draw):
    roll, pitch = draw(small), draw(small)
    level = G * np.array([-np.sin(pitch), np.cos(pitch) * np.sin(roll)])
    driven = np.array([draw(st.floats(-3, 3)), draw(st.floats(-3, 3))])
    return Inputs(draw(tread_speeds), np.array(roll), np.array(pitch), level + driven)


def ordinary(model):
    return {name: value for name, (_, value, _) in CONVENTIONS[model.name].items()}


def spreads(model):
    return np.array([spread for _, _, spread in CONVENTIONS[model.name].values()])


def values_of(model, drawn):
    middle = np.array(list(ordinary(model).values()))
    return middle + np.array(drawn)[: len(middle)] * spreads(model)


def distances_slope(model, values, inputs):
    left, right = values[3:5] * inputs.tread_speeds_m_s
    unlimited = values.copy()
    unlimited[8:] = -10, 10
    y_left, y_right, x_icr = model.icrs(unlimited, inputs)
    half_width, half_length = values[8:]
    limits = [y_left - half_width, y_right + half_width, abs(x_icr) - half_length]
    return [right - left, right + left, values[7] - abs(right + left) / 2, *limits]


def distances_inertia(model, values, inputs):
    left, right = inputs.tread_speeds_m_s
    turn = model.turn(values, inputs)
    held = [turn.indices.eta - 0.1, values[8] * G - turn.indices.force_n]
    return [left - right, left + values[7] * right, *held]


def distances_radius(_, values, inputs):
    left, right = inputs.tread_speeds_m_s
    above = np.sqrt(abs(right - left)) + values[2] * np.sqrt(abs(right + left))
    return [(right - left) / 10, (right + left) / 10, above]


DISTANCES = {
    "icr_slope": distances_slope,
    "icr_inertia": distances_inertia,
    "icr_inertia_measured": distances_inertia,
    "radius_of_curvature": distances_radius,
}


def assume_smooth(model, values, inputs):
    if model.name in DISTANCES:
        assume(np.min(np.abs(DISTANCES[model.name](model, values, inputs))) > MARGIN)


def derivative(function, at, scale):
    columns = [
        (function(at + STEP * e) - function(at - STEP * e)) / (2 * STEP) for e in np.diag(scale)
    ]
    return np.stack(columns, axis=-1)


@each_model
@given(drawn=draws, inputs=inputs_())
def test_parameter_jacobian_is_the_derivative(model, drawn, inputs):
    """In units of each parameter's spread."""
    values = values_of(model, drawn)
    assume_smooth(model, values, inputs)
    numeric = derivative(lambda v: model.twist(v, inputs), values, spreads(model))
    exact = model.parameter_jacobian(values, inputs)
    assert exact.shape == (3, len(model.parameters))
    np.testing.assert_allclose(exact * spreads(model), numeric, rtol=1e-6, atol=1e-7)


@each_model
@given(drawn=draws, inputs=inputs_())
def test_speed_jacobian_is_the_derivative(model, drawn, inputs):
    values = values_of(model, drawn)
    assume_smooth(model, values, inputs)
    numeric = derivative(
        lambda v: model.twist(values, replace(inputs, tread_speeds_m_s=v)),
        inputs.tread_speeds_m_s,
        np.ones(2),
    )
    exact = model.speed_jacobian(values, inputs)
    assert exact.shape == (3, 2)
    np.testing.assert_allclose(exact, numeric, rtol=1e-6, atol=1e-7)


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
    assert set(MODELS) - set(IDEAL) == NEVER_IDEAL


@pytest.mark.parametrize("name", IDEAL)
@given(inputs=inputs_())
def test_ideal_differential_drive_is_a_special_case(name, inputs):
    v_left, v_right = inputs.tread_speeds_m_s
    twist = MODELS[name].twist(MODELS[name].pack(IDEAL[name]), inputs)
    expected = [(v_left + v_right) / 2, 0, (v_right - v_left) / WIDTH]
    np.testing.assert_allclose(twist, expected, rtol=1e-12, atol=1e-12)


@each_model
def test_a_left_turn_on_the_spot(model):
    """CONVENTIONS: v_left < 0 < v_right, omega > 0."""
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


@each_model
def test_stacks_are_taken_one_by_one(model, rng):
    """Parameters by row, inputs by column: broadcasting gives what a loop gives."""
    many = np.stack([values_of(model, rng.uniform(-1, 1, 12)) for _ in range(4)])
    inputs = Inputs(
        rng.uniform(-2, 2, (5, 2)), *rng.uniform(-0.4, 0.4, (2, 5)), rng.uniform(-9, 9, (5, 2))
    )
    one_by_one = [
        Inputs(**{name: field[i] for name, field in vars(inputs).items() if field is not None})
        for i in range(inputs.shape[0])
    ]
    for function in (model.twist, model.parameter_jacobian, model.speed_jacobian):
        stacked = function(many[:, None], inputs)
        looped = [[function(v, one) for one in one_by_one] for v in many]
        assert stacked.shape == np.shape(looped)
        np.testing.assert_allclose(stacked, looped, rtol=1e-12, atol=1e-13)


@each_model
def test_inputs_are_not_changed(model):
    values = model.pack(ordinary(model))
    inputs = Inputs(np.array([0.3, 0.5]), np.array(0.1), np.array(0.2), np.array([0.1, 0.2]))
    fields = [field for field in vars(inputs).values() if field is not None]
    before = [values.copy(), *(field.copy() for field in fields)]
    for function in (model.twist, model.parameter_jacobian, model.speed_jacobian):
        function(values, inputs)
    for was, is_now in zip(before, [values, *fields], strict=True):
        np.testing.assert_array_equal(was, is_now)


def test_the_names_are_those_of_the_conventions():
    assert set(PARAMETER_NAMES) == set(MODELS) == set(CONVENTIONS)
    for name, table in CONVENTIONS.items():
        assert PARAMETER_NAMES[name] == tuple(table), name


@each_model
def test_units_bounds_and_sources(model):
    assert model.source
    assert MODELS[model.name] is model
    for parameter in model.parameters:
        unit, value, _ = CONVENTIONS[model.name][parameter.name]
        assert parameter.unit == unit, parameter.name
        assert parameter.low < value < parameter.high, parameter.name
        low, high = parameter.search or (parameter.low, parameter.high)
        assert parameter.low <= low < high <= parameter.high, parameter.name


@each_model
def test_what_is_measured_on_the_robot_is_not_searched(model):
    known = {parameter.name for parameter in model.parameters if parameter.known}
    assert known == KNOWN & set(ordinary(model)) - SEARCHED.get(model.name, set())


@each_model
@pytest.mark.parametrize("robot", [Robot(0.4), Robot(0.4, "", 0.9, 0.6, 0.1, 35.0)])
def test_a_guess_is_a_set_within_the_search(model, robot):
    guess = model.guess(robot)
    assert tuple(guess) == tuple(parameter.name for parameter in model.parameters)
    model.pack(guess)
    for parameter in model.parameters:
        low, high = parameter.search or (parameter.low, parameter.high)
        assert low <= guess[parameter.name] <= high, parameter.name


@each_model
def test_pack_orders_and_checks(model):
    named = ordinary(model)
    backwards = dict(reversed(named.items()))
    np.testing.assert_array_equal(model.pack(backwards), list(named.values()))
    with pytest.raises(ParameterError, match=rf"'wheels'.*{next(iter(named))}"):
        model.pack({**named, "wheels": 4.0})
    for parameter in model.parameters:
        if parameter.default is None:
            rest = {name: value for name, value in named.items() if name != parameter.name}
            with pytest.raises(ParameterError, match=parameter.name):
                model.pack(rest)


@each_model
def test_no_value_is_nan_or_out_of_bounds(model):
    named = ordinary(model)
    for parameter in model.parameters:
        for value in (float("nan"), parameter.low - 1, parameter.high + 1):
            if not np.isinf(value):
                with pytest.raises(ParameterError, match=parameter.name):
                    model.pack({**named, parameter.name: value})


def test_which_models_have_inverse_kinematics():
    constant = {"differential_drive", "icr_symmetric", "icr", "traction_mode"}
    assert set(invertible) == constant | {"icr_inertia"}


@each_invertible
@given(drawn=draws, inputs=inputs_())
def test_tread_speeds_give_the_motion_wanted(model, drawn, inputs):
    """Every motion that the model makes is wanted once, and made again."""
    values = values_of(model, drawn)
    wanted = model.twist(values, inputs)
    speeds = model.tread_speeds(values, wanted[0], wanted[2])
    made = model.twist(values, replace(inputs, tread_speeds_m_s=speeds))
    np.testing.assert_allclose(made, wanted, rtol=1e-9, atol=1e-9)


@each_invertible
def test_wanted_motions_broadcast(model, rng):
    many = np.stack([values_of(model, rng.uniform(-1, 1, 12)) for _ in range(3)])[:, None, None]
    v_x, omega = rng.uniform(0.2, 1, (4, 1)), rng.uniform(0.1, 0.3, 5)
    stacked = model.tread_speeds(many, v_x, omega)
    looped = [
        [[model.tread_speeds(v[0, 0], one, turn) for turn in omega] for one in v_x[:, 0]]
        for v in many
    ]
    assert stacked.shape == (3, 4, 5, 2)
    np.testing.assert_allclose(stacked, looped, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize(
    ("name", "factor"),
    [("icr_symmetric", "alpha"), ("icr", "alpha_left"), ("traction_mode", "k")],
)
def test_a_tread_that_slips_away_has_no_speed(name, factor):
    """A slip factor of 0 gives NaN, and no warning."""
    model = MODELS[name]
    values = model.pack({**ordinary(model), factor: 0.0})
    assert np.isnan(model.tread_speeds(values, np.array(1.0), np.array(0.2))[0])
