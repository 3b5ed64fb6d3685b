import numpy as np
import pytest

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.motion.slope_icr import SlopeByIcr, lacks_tilt
from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

VALUES = np.array([4.0, 6.0, 1.5])


@pytest.mark.parametrize("length", [0.8, None])
def test_on_a_base_with_its_icrs_it_is_the_model_of_martinez(bench, rng, length):
    """A contact rectangle 0.4 of the length on either side, else a square."""
    base = Base(bench.base.model, bench.values, Robot(0.6, length=length))
    inputs = bench.drive(rng)
    guessed = MODELS["icr_slope"].guess(base.robot)
    half_length = guessed["half_length"] if length else 0.3
    packed = np.array([*bench.values, *VALUES, 0.3, half_length])
    np.testing.assert_allclose(
        corrected_twist(base, [Added(SlopeByIcr(), VALUES)], inputs),
        MODELS["icr_slope"].twist(packed, inputs),
        atol=1e-12,
    )


def test_it_is_added_to_what_another_effect_has_changed(bench, rng):
    inputs, skid = bench.drive(rng), Added(LateralSkid(), np.array([0.3]))
    plain = bench.base.model.twist(bench.values, inputs)
    sliding, skidding, both = (
        corrected_twist(bench.base, effects, inputs) - plain
        for effects in ([Added(SlopeByIcr(), VALUES)], [skid], [skid, Added(SlopeByIcr(), VALUES)])
    )
    np.testing.assert_allclose(both, sliding + skidding, atol=1e-12)


def test_level_ground_changes_nothing_and_determines_nothing(bench, rng):
    level = Inputs(bench.drive(rng).tread_speeds_m_s)
    plain = bench.base.model.twist(bench.values, level)
    found = corrected_twist(bench.base, [Added(SlopeByIcr(), VALUES)], level)
    np.testing.assert_allclose(found, plain, atol=1e-14)
    assert "not level" in SlopeByIcr().lacks(level, bench.base)
    assert lacks_tilt(bench.drive(rng)) == ""


def test_another_base_is_refused(bench, rng):
    base = Base(MODELS["icr_symmetric"], np.array([1.0, 0.8]), bench.robot)
    assert "tread ICRs" in SlopeByIcr().lacks(bench.drive(rng), base)
    with pytest.raises(ParameterError, match=r"slope_sliding.*expected 'icr'"):
        corrected_twist(base, [Added(SlopeByIcr(), VALUES)], bench.drive(rng))
