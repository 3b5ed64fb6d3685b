import numpy as np

from odometry.effects.interface.corrected import Added, Corrected
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.models.catalogue import MODELS


def test_it_shifts_x_icr(bench, rng):
    inputs = bench.drive(rng)
    model = Corrected(MODELS["icr"], bench.robot, [Added(LateralSkid(), np.array([0.13]))])
    shifted = MODELS["icr"].twist(bench.values + np.array([0, 0, 0.13, 0, 0]), inputs)
    np.testing.assert_allclose(model.twist(bench.values, inputs), shifted, atol=1e-14)


def test_a_lever_arm_does_exactly_the_same():
    assert set(LateralSkid().same_as(np.array([0.1]))) == {"lever_arm"}
