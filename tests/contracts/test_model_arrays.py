"""Arrays that every kinematic model takes: stacks, one by one, and left as they are."""

import numpy as np

from odometry.models.inputs import Inputs
from tests.contracts.model_draws import values_of
from tests.contracts.test_models import each_model, ordinary


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
