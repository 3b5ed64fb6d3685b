"""Of the measured runs, pieces in which the robot moves are held back, and none at rest."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.gap.prepare.pieces import held_back, pieces


def resting(scene, resting_s):
    """The same with treads that stand from one run time to another."""
    steps = np.diff(scene.travel_m, prepend=0.0)
    begin_s, end_s = resting_s
    steps[(scene.time_s > begin_s) & (scene.time_s <= end_s)] = 0.0
    return replace(scene, travel_m=np.cumsum(steps))


@pytest.mark.parametrize(
    ("resting_s", "expected"),
    [
        ((0.0, 0.0), {3, 7, 11}),
        ((28.0, 52.0), {5, 9}),  # pieces 3 and 4 rest
        ((0.0, 120.0), set()),
    ],
)
def test_one_moving_piece_in_four_is_held_back(make_scene, resting_s, expected):
    scene = resting(make_scene(4, duration_s=120.0), resting_s)
    out = held_back(scene, 10.0, 4)
    assert set(pieces(scene, 10.0)[out]) == expected
    whole = np.isin(pieces(scene, 10.0), list(expected))
    np.testing.assert_array_equal(out, whole)
