"""ICRs by terrain are those of `icr` on the samples of each label."""

import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.models.icr import Icr, IcrByTerrain
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

MODEL = IcrByTerrain(("sand", "ice"))
ON_SAND = np.array([0.45, -0.38, 0.07, 0.95, 0.9])
ON_ICE = np.array([0.8, -0.75, -0.02, 0.6, 0.7])
VALUES = np.concatenate([ON_SAND, ON_ICE])


@pytest.fixture
def inputs(rng):
    """A third of the samples on ice, a third on sand, a third with another label."""
    labels = np.array(["ice", "sand", "mud"] * 20, dtype=object)
    return Inputs(rng.uniform(-1, 1, (60, 2)), terrain=labels)


def test_each_sample_moves_as_icr_does_on_its_terrain(inputs):
    """Another label than those identified is the first of them."""
    by_label = {"ice": ON_ICE, "sand": ON_SAND, "mud": ON_SAND}
    for name in ("twist", "speed_jacobian"):
        found = getattr(MODEL, name)(VALUES, inputs)
        for label, own in by_label.items():
            here = inputs.terrain == label
            plain = getattr(Icr(), name)(own, Inputs(inputs.tread_speeds_m_s[here]))
            np.testing.assert_allclose(found[here], plain, rtol=1e-14)


def test_without_labels_the_first_terrain_is_meant(rng):
    inputs = Inputs(rng.uniform(-1, 1, (10, 2)))
    np.testing.assert_array_equal(MODEL.twist(VALUES, inputs), Icr().twist(ON_SAND, inputs))


def test_the_jacobian_is_that_of_finite_differences(inputs):
    step = 1e-6
    differences = [
        (MODEL.twist(VALUES + dp, inputs) - MODEL.twist(VALUES - dp, inputs)) / (2 * step)
        for dp in step * np.eye(len(VALUES))
    ]
    found = MODEL.parameter_jacobian(VALUES, inputs)
    np.testing.assert_allclose(found, np.stack(differences, axis=-1), atol=1e-8)


def test_values_of_one_terrain():
    np.testing.assert_array_equal(MODEL.values_on("ice", VALUES), ON_ICE)
    np.testing.assert_array_equal(MODEL.values_on("mud", VALUES), ON_SAND)


def test_parameters_are_named_after_the_terrain_and_guessed_alike():
    robot = Robot(0.6)
    guess = MODEL.guess(robot)
    assert guess["y_left"] == guess["y_left_ice"] == Icr().guess(robot)["y_left"]
    packed = MODEL.pack(guess)
    with pytest.raises(ParameterError, match="y_left"):
        MODEL.check(packed * np.where(np.arange(10) == 5, -1, 1))
