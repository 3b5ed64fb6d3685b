"""Traction modes of three sets of wheels, made up."""

import numpy as np

from odometry.modes.models.traction import TractionModes

WIDTH = 0.5
LAGS_S = np.array([0.0, 0.08, 0.3])
RNG = np.random.default_rng(11)
GAINS = np.array([[0.9, 0.05, 0, 0, 0], [-0.08, 0.03, 0, 0, 0], [0.2, 0.6, 0, 0, 0]])
GAINS = GAINS + 0.05 * RNG.normal(size=(3, 2, 3, 5))
MODES = TractionModes(
    ("none", "left", "all"),
    GAINS,
    LAGS_S,
    WIDTH,
    np.array([2e-3, 5e-4, 1e-4]),
    np.array([4e-4, 4e-4, 1e-4, 1e-3]),
    variance_growth=2.0,
)
