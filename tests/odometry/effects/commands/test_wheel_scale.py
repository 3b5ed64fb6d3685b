import numpy as np

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added, Corrected
from odometry.models.catalogue import MODELS


def test_it_is_what_the_slip_factors_of_icr_are(bench, rng):
    inputs = bench.drive(rng)
    scaled = Corrected(
        MODELS["icr"], bench.robot, [Added(WheelScale(), np.array([0.8, 1.1]))]
    ).twist(bench.values, inputs)
    by_factors = MODELS["icr"].twist(bench.values * [1, 1, 1, 0.8, 1.1], inputs)
    np.testing.assert_allclose(scaled, by_factors, rtol=1e-13)


def test_one_factor_of_both_wheels_looks_like_slip_and_two_do_not():
    effect = WheelScale()
    assert set(effect.same_as(np.array([0.9, 0.905]))) == {"traction_loss"}
    assert not effect.same_as(np.array([0.9, 0.95]))
