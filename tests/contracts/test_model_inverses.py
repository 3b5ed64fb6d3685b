"""Inverse kinematics of every model that has them."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from odometry.models.catalogue import MODELS
from odometry.models.invertible import InvertibleModel
from tests.contracts.model_draws import draws, inputs_, values_of
from tests.contracts.test_models import ordinary

invertible = {name: m for name, m in MODELS.items() if isinstance(m, InvertibleModel)}
each_invertible = pytest.mark.parametrize("model", invertible.values(), ids=invertible)


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


def test_the_smallest_tread_speeds_give_the_motion_wanted():
    """V_l + H V_r is rounded to 0 there, and has no sign."""
    model = MODELS["icr_inertia"]
    values = model.pack(ordinary(model))
    smallest = np.nextafter(0.0, 1.0)
    assert np.isfinite(model.tread_speeds(values, np.array(0.0), np.array(-2 * smallest))).all()


@pytest.mark.parametrize(
    ("name", "factor"),
    [("icr_symmetric", "alpha"), ("icr", "alpha_left"), ("traction_mode", "k")],
)
def test_a_tread_that_slips_away_has_no_speed(name, factor):
    """A slip factor of 0 gives NaN, and no warning."""
    model = MODELS[name]
    values = model.pack({**ordinary(model), factor: 0.0})
    assert np.isnan(model.tread_speeds(values, np.array(1.0), np.array(0.2))[0])
