"""The width law against Baril's model, and against ICRs moved by hand."""

import numpy as np
import pytest

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, Corrected, corrected_twist
from odometry.effects.motion.curvature import Curvature
from odometry.models.catalogue import MODELS
from odometry.models.icr import icr_twist
from odometry.models.inputs import Inputs

LAW = np.array([1.3, 0.8, 0.4])  # width_factor, beta_1, beta_2


@pytest.mark.parametrize("name", ["icr", "icr_symmetric", "traction_mode"])
def test_on_a_symmetric_base_it_is_the_law_of_baril(bench, rng, name):
    """Of all models that drive alpha v and turn alpha (v_right - v_left) / 0.9."""
    same = {
        "icr": [0.45, -0.45, 0.0, 0.85, 0.85],
        "icr_symmetric": [0.85, 0.9],
        "traction_mode": [0.85, 0.85 * 0.6 / 0.9, 0.6],
    }
    inputs = bench.drive(rng)
    model = Corrected(MODELS[name], bench.robot, [Added(Curvature(), LAW)])
    law = np.array([0.85, LAW[1], LAW[2], LAW[0] * 0.9])
    expected = MODELS["radius_of_curvature"].twist(law, inputs)
    np.testing.assert_allclose(model.twist(np.array(same[name]), inputs), expected, atol=1e-13)


def test_a_constant_factor_moves_the_treads_apart_about_their_middle(bench, rng):
    inputs = bench.drive(rng)
    y_left, y_right, x_icr = bench.values[:3]
    middle, half = (y_left + y_right) / 2, 1.25 * (y_left - y_right) / 2
    moved = np.array([middle + half, middle - half, x_icr])
    expected = icr_twist(moved, bench.values[3:] * inputs.tread_speeds_m_s)
    effect = Added(Curvature(), np.array([1.25, 0.0, 1.0]))
    np.testing.assert_allclose(corrected_twist(bench.base, [effect], inputs), expected, atol=1e-13)


def test_it_is_finite_at_a_standstill_straight_and_on_the_spot(bench):
    inputs = Inputs(np.array([[0.0, 0.0], [1.0, 1.0], [1.0, -1.0]]))
    base = Base(MODELS["icr_symmetric"], np.array([1.0, 0.8]), bench.robot)
    twist = corrected_twist(base, [Added(Curvature(), LAW)], inputs)
    np.testing.assert_allclose(twist[:2], [[0, 0, 0], [1, 0, 0]], atol=1e-15)
    np.testing.assert_allclose(twist[2], [0, 0, -2 / 0.8 / (1.3 * 1.8)], atol=1e-15)
