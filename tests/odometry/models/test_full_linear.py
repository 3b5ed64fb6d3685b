import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.models.icr import Icr
from odometry.models.inputs import Inputs
from odometry.models.radius_of_curvature import FullLinear

MODEL = FullLinear()
GAMMAS = {
    "gamma_11": 0.4,
    "gamma_12": 0.5,
    "gamma_21": -0.1,
    "gamma_22": 0.3,
    "gamma_31": -0.2,
    "gamma_32": 0.6,
}


def test_by_hand():
    """Rows of eq. 12: 0.4*2 + 0.5*3, -0.1*2 + 0.3*3, -0.2*2 + 0.6*3."""
    twist = MODEL.twist(MODEL.pack(GAMMAS), Inputs(np.array([2.0, 3.0])))
    np.testing.assert_allclose(twist, [2.3, 0.7, 1.4], rtol=1e-15)


def test_the_asymmetric_icr_model_is_one(rng):
    """Baril 2020 eq. 7 is a matrix times the tread speeds: its entries are the gammas."""
    icr = Icr().pack({"y_left": 0.5, "y_right": -0.3, "x_icr": 0.1, "alpha_left": 0.9})
    inputs = Inputs(rng.uniform(-2, 2, (20, 2)))
    gammas = Icr().speed_jacobian(icr, Inputs(np.zeros(2))).ravel()
    np.testing.assert_allclose(MODEL.twist(gammas, inputs), Icr().twist(icr, inputs), atol=1e-14)


@pytest.mark.parametrize(("name", "value"), [("gamma_31", 0.1), ("gamma_32", -0.1)])
def test_a_faster_right_tread_turns_left(name, value):
    """The bounds of Baril's Table I."""
    with pytest.raises(ParameterError, match=name):
        MODEL.pack({**GAMMAS, name: value})
