import numpy as np
import pytest

from odometry.effects.interface.recorded import Recorded
from odometry.effects.motion.traction_loss import TractionLoss


def test_it_is_a_share_of_the_twist(bench, rng):
    twist = rng.normal(size=(5, 3))
    found = TractionLoss().twist(np.array([0.7, 0.4]), twist, bench.drive(rng, 5), bench.base)
    np.testing.assert_allclose(found, twist * [0.7, 0.4, 0.4], atol=1e-15)


def test_it_is_offered_in_a_course_of_time_alone(bench, rng):
    recorded = Recorded(bench.base, (bench.drive(rng),), ((1.0, 3.0),))
    offered = TractionLoss.offered(recorded)
    assert [effect.course for effect in offered] == ["from_a_moment", "gradual"]
    assert {effect.name for effect in offered} == {"traction_loss"}


@pytest.mark.parametrize(
    ("k", "m", "meant"),
    [
        *((0.8, 0.9, True), (1.01, 0.9, True), (1.1, 0.9, False), (0.9, 1.2, False)),
        *((0.8, 1.0, False), (0.8, 0.99, False), (0.97, 0.96, True)),
    ],
)
def test_a_loss_is_no_gain_and_one_of_turns(k, m, meant):
    assert TractionLoss().is_meant(np.array([k, m])) == meant
