"""Gains of both sides that were found from turns to one side hold for these alone."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.identification.plausibility import turns_one_way

BOTH = ("y_left", "y_right", "alpha_left", "alpha_right")


@pytest.mark.parametrize(
    ("turns_rad", "names", "words"),
    [
        ([0.5, 1.2, 0.0, -0.02], BOTH, "go to the left"),
        ([-0.5, -1.2, 0.01], BOTH, "go to the right"),
        ([0.5, 1.2, -0.2], BOTH, ""),
        ([0.5, 1.2], ("alpha", "b_hat"), ""),
    ],
)
def test_a_robot_that_turns_to_one_side_is_said_to(turns_rad, names, words):
    measured = np.zeros((len(turns_rad), 3))
    measured[:, 2] = turns_rad
    fit = SimpleNamespace(windows=SimpleNamespace(measured=measured), names=names)
    said = turns_one_way(fit)
    assert words in said
    assert bool(said) == bool(words)
