"""A robot that turns about a point outside of it has a reference that is elsewhere."""

from types import SimpleNamespace

import pytest

from odometry.identification.plausibility import turns_outside
from odometry.recording.run import Robot


@pytest.mark.parametrize(
    ("x_m", "length_m", "words"),
    [
        (-1.1, 1.0, "behind its rear. The reference is probably 1.1 m ahead of"),
        (0.7, 1.0, "ahead of its front. The reference is probably 0.7 m behind"),
        (0.4, 1.0, ""),
        (-0.5, None, ""),
        (-0.7, None, "behind its rear"),
    ],
)
def test_icrs_lie_between_the_ends_of_a_robot(x_m, length_m, words):
    fit = SimpleNamespace(values={"x_icr": x_m}, scale=1.0)
    said = turns_outside(fit, Robot(track_width=0.6, length=length_m))
    assert words in said
    assert bool(said) == bool(words)


def test_a_model_without_the_parameter_says_nothing():
    assert turns_outside(SimpleNamespace(values={"alpha": 1.0}), Robot(0.6)) == ""


def test_where_residuals_are_far_beyond_the_noise_late_positions_are_another_cause():
    fit = SimpleNamespace(values={"x_icr": -1.1}, scale=10.0)
    assert turns_outside(fit, Robot(0.6)).endswith("positions are late, or late along one axis")
