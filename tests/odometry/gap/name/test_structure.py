"""What a fit leaves depends on what is missing in it, and on nothing where nothing is."""

import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.left_by_names import structure_left
from odometry.gap.prepare.measured import measured_of

CONFIG = GapConfig()


@pytest.fixture(scope="module")
def fitter(make_scene, known):
    """Wheels that slip by a factor."""
    scene = make_scene(1, lambda columns, twist: 0.8 * twist)  # noqa: ARG005 - of the face
    return Fitter(known, measured_of([scene], known, CONFIG))


def discovered(fitter, effects):
    left = structure_left(fitter, fitter.fit(effects), CONFIG)
    return [one.name for one in left if one.discovered]


def test_without_the_effect_the_speed_predicts_what_is_left(fitter):
    assert "speed" in discovered(fitter, [])


def test_with_the_effect_nothing_does(fitter):
    assert discovered(fitter, [WheelScale()]) == []
