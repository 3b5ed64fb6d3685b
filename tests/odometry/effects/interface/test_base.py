import numpy as np
import pytest

from odometry.effects.interface.base_model import Base, slip_factors, tread_icrs
from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

ROBOT = Robot(0.6)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("differential_drive", [0.6]),
        ("icr_symmetric", [0.8, 0.9]),
        ("icr", [0.4, -0.5, 0.1, 0.8, 0.8]),
        ("radius_of_curvature", [0.8, 1.0, 0.5, 0.6]),
        ("traction_mode", [0.8, 0.5, 0.6]),
    ],
)
def test_slip_factors_are_those_of_straight_ahead(name, values):
    base = Base(MODELS[name], np.array(values), ROBOT)
    straight = MODELS[name].twist(np.array(values), Inputs(np.array([1.0, 1.0])))
    np.testing.assert_allclose(slip_factors(base), straight[0])


def test_slip_factors_by_side():
    base = Base(MODELS["icr"], np.array([0.4, -0.5, 0.1, 0.8, 0.9]), ROBOT)
    np.testing.assert_array_equal(slip_factors(base), [0.8, 0.9])
    np.testing.assert_array_equal(tread_icrs(base, "any"), [0.4, -0.5, 0.1])


def test_a_model_without_tread_icrs_has_none():
    base = Base(MODELS["full_linear"], np.arange(6.0), ROBOT)
    np.testing.assert_array_equal(slip_factors(base), [1, 1])
    with pytest.raises(ParameterError, match=r"'slide' moves tread ICRs.*'full_linear'"):
        tread_icrs(base, "slide")
