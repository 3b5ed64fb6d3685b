import numpy as np
import pytest

from odometry.effects.interface.corrected import Corrected
from odometry.effects.tables import effects_of, model_of, table_of
from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS
from odometry.parameters import TerrainParameters
from odometry.recording.run import Robot

ICRS = {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1, "alpha_left": 1.0, "alpha_right": 0.9}
SCALE = {"name": "wheel_scale", "form": "factors", "parameters": {"c_l": 1.1, "c_r": 0.9}}
ARM = {"name": "lever_arm", "form": "constant", "parameters": {"x_arm": 0.2, "y_arm": 0.0}}
ROBOT = Robot(0.6)


def test_a_table_with_effects_is_a_model_and_a_table_again():
    table = TerrainParameters("icr", ICRS, ("x_icr",), np.array([[0.04]]), "here", (SCALE, ARM))
    model = model_of(table, ROBOT, "[terrain.lawn]")
    assert isinstance(model, Corrected)
    assert (model.base, model.robot) == (MODELS["icr"], ROBOT)
    assert [added.effect.name for added in effects_of(model)] == ["wheel_scale", "lever_arm"]
    again = table_of(model, ICRS, ("x_icr",), np.array([[0.04]]), "here")
    assert (again.model, again.values, again.effects) == ("icr", ICRS, (SCALE, ARM))
    assert (again.covariance_order, again.covariance, again.source) == (("x_icr",), 0.04, "here")


def test_a_plain_table_is_the_model_of_the_catalogue():
    model = model_of(TerrainParameters("icr", ICRS), ROBOT, "here")
    assert model is MODELS["icr"]
    assert effects_of(model) == ()
    assert table_of(model, ICRS, (), np.empty((0, 0)), "").effects == ()


@pytest.mark.parametrize(
    ("model", "effects", "words"),
    [("bicycle", (), r"set: the model 'bicycle'"), ("icr", ({"name": "a"},), r"set: effects\[0\]")],
)
def test_what_cannot_be_computed_is_an_error(model, effects, words):
    with pytest.raises(ParameterError, match=words):
        model_of(TerrainParameters(model, ICRS, effects=effects), ROBOT, "set")
