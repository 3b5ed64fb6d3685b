import numpy as np

from odometry.models.icr import Icr
from odometry.models.inputs import Inputs
from odometry.models.symmetric import IcrSymmetric, TractionMode

MODEL = TractionMode()


def test_by_hand():
    """k (1 + 3) / 2 = 1.8 and m (3 - 1) / 0.4 = 3."""
    values = MODEL.pack({"k": 0.9, "m": 0.6, "track_width": 0.4})
    twist = MODEL.twist(values, Inputs(np.array([1.0, 3.0])))
    np.testing.assert_allclose(twist, [1.8, 0, 3.0], rtol=1e-15)


def test_it_is_the_symmetric_model_by_other_names(rng):
    """data/README.md: alpha_left = alpha_right = k and y_left - y_right = b k / m."""
    inputs = Inputs(rng.uniform(-2, 2, (20, 2)))
    for k, m, b in rng.uniform([0.5, 0.3, 0.3], [1.2, 1.2, 1.5], (10, 3)):
        twists = MODEL.twist(np.array([k, m, b]), inputs)
        width = b * k / m
        symmetric = IcrSymmetric().twist(np.array([k, width]), inputs)
        as_icr = Icr().twist(np.array([width / 2, -width / 2, 0, k, k]), inputs)
        np.testing.assert_allclose(twists, symmetric, atol=1e-13)
        np.testing.assert_allclose(twists, as_icr, atol=1e-13)
