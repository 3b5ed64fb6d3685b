"""Models with constant ICRs: what they say in the parameters of `icr`, on which the filter runs."""

import numpy as np
import pytest
from hypothesis import given

from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from tests.contracts.model_draws import draws, tread_speeds, values_of
from tests.contracts.test_models import each_model, ordinary

STEP = 1e-6

with_icrs = pytest.mark.parametrize(
    "model", [m for m in MODELS.values() if m.has_constant_icrs], ids=lambda model: model.name
)


def test_there_are_some():
    names = {name for name, model in MODELS.items() if model.has_constant_icrs}
    assert names == {"icr", "icr_symmetric", "differential_drive", "traction_mode"}


@with_icrs
@given(drawn=draws, speeds=tread_speeds)
def test_it_moves_as_the_model_does(model, drawn, speeds):
    values = values_of(model, drawn)
    form = model.icr_form(values)
    moved = MODELS["icr"].twist(np.concatenate([form.icrs, form.alphas]), Inputs(speeds))
    np.testing.assert_allclose(moved, model.twist(values, Inputs(speeds)), rtol=1e-12, atol=1e-13)


def said(model, values):
    form = model.icr_form(values)
    return np.concatenate([form.icrs, form.alphas])


@with_icrs
@given(drawn=draws)
def test_its_derivative_is_that_of_the_icrs(model, drawn):
    values = values_of(model, drawn)
    columns = [
        (said(model, values + h) - said(model, values - h)) / (2 * STEP)
        for h in STEP * np.eye(len(values))
    ]
    exact = model.icr_form(values).by_parameters
    np.testing.assert_allclose(exact, np.stack(columns, axis=-1), rtol=1e-6, atol=1e-8)


@each_model
def test_a_model_that_has_none_says_so(model):
    if not model.has_constant_icrs:
        with pytest.raises(ParameterError, match=rf"'{model.name}' has no constant ICRs"):
            model.icr_form(model.pack(ordinary(model)))
