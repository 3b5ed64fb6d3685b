"""Derivatives of every kinematic model beside central differences.

Their step is 1e-5 of a parameter's spread and of 1 m/s: truncation and rounding are both below
1e-8 for the values and inputs drawn here, away from the switching surfaces that the models'
docstrings name.
"""

from dataclasses import replace

import numpy as np
from hypothesis import assume, given

from tests.contracts.model_draws import G, draws, inputs_, spreads, values_of
from tests.contracts.test_models import each_model

STEP = 1e-5
MARGIN = 1e-3  # how far from a switching surface a function is differentiated


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
    """Derivative (3, n) of a function of stacks (m, n), by its columns in units of a scale (n,)."""
    steps = STEP * np.diag(scale)
    ahead, behind = np.split(function(at + np.concatenate([steps, -steps])), 2)
    return (ahead - behind).T / (2 * STEP)


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
