"""`linearised` of every kinematic model: the twist and the derivative of the other faces.

Here it gives what they give, to the bit; in test_model_derivatives.py these are compared with
finite differences of the twist, for the same values and inputs.
"""

import numpy as np
import pytest
from hypothesis import given

from odometry.models.catalogue import MODELS
from odometry.models.icr_slope import Column as SlopeColumn
from odometry.models.inertia_forces import Column as InertiaColumn
from odometry.models.inputs import Inputs
from tests.contracts.model_draws import draws, inputs_, values_of
from tests.contracts.test_models import each_model, ordinary


@each_model
@given(drawn=draws, inputs=inputs_())
def test_it_is_the_twist_and_its_derivative(model, drawn, inputs):
    values = values_of(model, drawn)
    twist, by_parameters = model.linearised(values, inputs)
    np.testing.assert_array_equal(twist, model.twist(values, inputs))
    np.testing.assert_array_equal(by_parameters, model.parameter_jacobian(values, inputs))


@each_model
def test_stacks_give_what_the_other_faces_give(model, rng):
    many = np.stack([values_of(model, rng.uniform(-1, 1, 12)) for _ in range(4)])[:, None]
    inputs = Inputs(
        rng.uniform(-2, 2, (5, 2)), *rng.uniform(-0.4, 0.4, (2, 5)), rng.uniform(-9, 9, (5, 2))
    )
    twist, by_parameters = model.linearised(many, inputs)
    assert twist.shape == (4, 5, 3)
    assert by_parameters.shape == (4, 5, 3, len(model.parameters))
    np.testing.assert_array_equal(twist, model.twist(many, inputs))
    np.testing.assert_array_equal(by_parameters, model.parameter_jacobian(many, inputs))


@each_model
def test_what_calls_itself_linear_is_a_matrix_times_the_speeds(model, rng):
    """For accelerations, attitudes and speeds of both signs; the others are no such matrix."""
    values = values_of(model, rng.uniform(-1, 1, 12))
    inputs = Inputs(
        rng.uniform(-2, 2, (50, 2)), *rng.uniform(-0.4, 0.4, (2, 50)), rng.uniform(-9, 9, (50, 2))
    )
    at_one = model.linearised(values, Inputs(np.eye(2), 0.0, 0.0, np.zeros((2, 2))))
    found = model.linearised(values, inputs)
    is_linear = all(
        np.allclose(np.tensordot(inputs.tread_speeds_m_s, one, 1), all_of, rtol=1e-9, atol=1e-12)
        for one, all_of in zip(at_one, found, strict=True)
    )
    assert is_linear == model.is_linear_in_speeds


@each_model
def test_stages_share_out_all_that_is_identified(model):
    if model.stages is None:
        return
    searched = {p.name for p in model.parameters if not p.known}
    assert set(model.stages.flat) | set(model.stages.tilted) == searched
    assert not set(model.stages.flat) & set(model.stages.tilted)


@each_model
def test_what_recorded_inputs_tell_is_known_otherwise(model):
    speeds = np.array([[0.2, 0.6], [-1.0, -0.6]])
    known = model.determined_by(Inputs(speeds))
    assert set(known) <= {p.name for p in model.parameters if p.known}
    model.pack(ordinary(model) | known)


@pytest.mark.parametrize("name", ["icr_inertia", "icr_inertia_measured"])
def test_places_by_name_are_those_of_the_inertia_parameters(name):
    names = [parameter.name for parameter in MODELS[name].parameters]
    assert [*names, "v_left", "v_right"] == [column.name.lower() for column in InertiaColumn]
    assert list(InertiaColumn) == list(range(len(InertiaColumn)))


def test_places_by_name_are_those_of_the_slope_parameters():
    names = [parameter.name for parameter in MODELS["icr_slope"].parameters]
    assert names[5:] == [column.name.lower() for column in SlopeColumn]
    assert list(SlopeColumn) == [5, 6, 7, 8, 9]
