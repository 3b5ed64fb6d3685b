"""The rows of the catalogue beside the conventions; a new model is tested the day it is born.

Add its row to `CONVENTIONS`: what holds for every model is asked of it here and, by the same rows,
in the other files `test_model_*.py` of this folder.
"""

import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS, PARAMETER_NAMES
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

# Names as the table in data/README.md spells them, units, and an ordinary value with a spread.
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

each_model = pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)


def ordinary(model):
    assert model.name in CONVENTIONS, (
        f"no row of CONVENTIONS in tests/contracts/test_models.py has {model.name!r}: unit, "
        "ordinary value and spread of each parameter"
    )
    return {name: value for name, (_, value, _) in CONVENTIONS[model.name].items()}


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


@each_model
def test_a_neutral_value_is_a_bound_of_the_search(model):
    for parameter in model.parameters:
        if parameter.neutral is not None:
            assert parameter.neutral in (parameter.search or (parameter.low, parameter.high))


@each_model
def test_a_guess_is_of_a_robot_that_is_the_same_on_both_sides(model):
    """Exchanged tread speeds mirror the motion on level terrain."""
    values = model.pack(model.guess(Robot(0.5)))
    speeds, still = np.array([0.3, 0.7]), np.zeros(2)
    one, other = (
        model.twist(values, Inputs(treads, accelerations_m_s2=still))
        for treads in (speeds, speeds[::-1])
    )
    np.testing.assert_allclose(other, one * [1, -1, -1], atol=1e-12)


def test_sizes_of_coefficients_of_a_force_are_those_at_1_m_s2():
    model = MODELS["icr_inertia"]
    light, heavy = (model.ordinary_sizes(Robot(0.5, mass=mass)) for mass in (10.0, 20.0))
    powers = {"m/N": 2.0, "1/N": 2.0, "1/N^2": 4.0, "kg": 0.5}
    expected = [powers.get(parameter.unit, 1.0) for parameter in model.parameters]
    np.testing.assert_allclose(light / heavy, expected)
