import numpy as np
import pytest

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.effects.motion.inertia_icr import InertiaByIndices
from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS

MASS_KG, G = 80.0, 9.80665
WEIGHT_N = MASS_KG * G
VALUES = np.array([0.4, -0.3, 0.9, 0.5 / WEIGHT_N, 0.8 * WEIGHT_N]) / WEIGHT_N  # and h


def test_it_is_the_model_of_martinez(bench, rng):
    """Coefficients are those of the model; the alphas scale the speeds."""
    inputs = bench.drive(rng, highest_m_s=2.5)
    y_left, y_right, x_icr, *alphas = bench.values
    by_name = {
        "zeta_0": x_icr,
        "zeta_1": 0.4 / (MASS_KG * G),
        "epsilon_0": -(y_left + y_right) / 2,
        "epsilon_1": -0.3 / (MASS_KG * G),
        "eta_0": (y_left - y_right) / 0.6,
        "eta_1": 0.9 / (MASS_KG * G),
        "eta_2": 0.5 / (MASS_KG * G) ** 2,
        "h": 0.8,
        "mass": MASS_KG,
        "x_cm": 0.0,
        "y_cm": 0.0,
        "track_width": 0.6,
    }
    model = MODELS["icr_inertia"]
    speeds = type(inputs)(np.array(alphas) * inputs.tread_speeds_m_s)
    expected = model.twist(model.pack(by_name), speeds)
    found = corrected_twist(bench.base, [Added(InertiaByIndices(MASS_KG), VALUES)], inputs)
    plain = bench.base.model.twist(bench.values, inputs)
    assert np.abs(found - plain).max() > 0.05
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_another_base_is_refused(bench, rng):
    base = Base(MODELS["icr_symmetric"], np.array([1.0, 0.8]), bench.robot)
    assert "tread ICRs" in InertiaByIndices().lacks(bench.drive(rng), base)
    with pytest.raises(ParameterError, match=r"inertia.*expected 'icr'"):
        corrected_twist(base, [Added(InertiaByIndices(), VALUES)], bench.drive(rng))
