"""Of the measured runs, pieces in which the robot moves are held out, and none at rest."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import GapError
from odometry.gap.config import GapConfig
from odometry.gap.prepare.held_out import apart, held_out_pieces, moving_pieces
from odometry.gap.prepare.pieces import pieces

CONFIG = GapConfig()


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
    ],
)
def test_one_moving_piece_in_four_is_held_out(make_scene, resting_s, expected):
    scene = resting(make_scene(4, duration_s=120.0), resting_s)
    (numbers,) = held_out_pieces([scene], CONFIG)
    assert set(numbers) == expected
    fitted, held = apart(([scene], []), [numbers], CONFIG)
    assert set(pieces(held[0], CONFIG.part_s)) == expected
    assert not set(pieces(fitted[0], CONFIG.part_s)) & expected
    assert sum(map(len, (*fitted, *held))) == len(scene)


def test_pieces_of_a_slow_robot_are_those_of_a_fast_one(make_scene):
    fast = resting(make_scene(4, duration_s=120.0), (28.0, 52.0))
    slow = replace(fast, travel_m=fast.travel_m / 30)
    (numbers,) = held_out_pieces([slow], CONFIG)
    assert set(numbers) == {5, 9}


def test_a_run_at_rest_cannot_be_held_out(make_scene):
    scene = resting(make_scene(4, duration_s=120.0), (0.0, 120.0))
    assert len(moving_pieces(scene, CONFIG.part_s)) == 0
    with pytest.raises(GapError, match="too short to hold stretches"):
        held_out_pieces([scene], CONFIG)


def test_runs_that_are_held_out_stay_whole(make_scene):
    scene, other = make_scene(4), make_scene(5)
    (fitted,), (held,) = apart(([scene], [other]), None, CONFIG)
    assert held is other
    assert len(fitted) == min(len(scene), CONFIG.most_windows)
