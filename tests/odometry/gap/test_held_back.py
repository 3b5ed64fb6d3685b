"""Of the measured runs, pieces in which the robot moves are held out, and none at rest."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import GapError
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import calibrated
from odometry.gap.prepare.held_out import apart, held_out_pieces, moving_pieces
from odometry.gap.prepare.pieces import pieces
from odometry.models.icr import Icr
from odometry.run import Robot

CONFIG = GapConfig()


def resting(scene, resting_s):
    """The same with treads that stand from one run time to another."""
    steps = np.diff(scene.travel_m, prepend=0.0)
    begin_s, end_s = resting_s
    steps[(scene.time_s > begin_s) & (scene.time_s <= end_s)] = 0.0
    return replace(scene, travel_m=np.cumsum(steps))


@pytest.fixture(scope="module")
def known(make_scene):
    return calibrated([make_scene(1), make_scene(2)], Icr(), Robot(0.9), CONFIG)


def off_in(scene, numbers):
    """The same with positions that creep away within some pieces."""
    poses = scene.poses.copy()
    odd = np.isin(scene.pose_s // CONFIG.part_s, numbers)
    poses[odd, 0] += scene.pose_s[odd] % CONFIG.part_s
    return replace(scene, poses=poses)


@pytest.mark.parametrize(
    ("resting_s", "count"), [((0.0, 0.0), 12), ((28.0, 52.0), 10), ((0.0, 120.0), 0)]
)
def test_one_moving_piece_in_four_is_held_out(make_scene, known, resting_s, count):
    scene = resting(make_scene(4, duration_s=120.0), resting_s)
    assert len(moving_pieces(scene, CONFIG.part_s)) == count
    if not count:
        with pytest.raises(GapError, match="too short to hold stretches"):
            held_out_pieces([scene], known, CONFIG, has_yaw=True)
        return
    (numbers,) = held_out_pieces([scene], known, CONFIG, has_yaw=True)
    assert len(numbers) == -(-(count - 1) // 4)
    assert set(numbers) <= set(moving_pieces(scene, CONFIG.part_s))
    fitted, held = apart(([scene], []), [numbers], CONFIG)
    assert set(pieces(held[0], CONFIG.part_s)) == set(numbers)
    assert not set(pieces(fitted[0], CONFIG.part_s)) & set(numbers)
    assert sum(map(len, (*fitted, *held))) == len(scene)


def test_of_two_pieces_that_differ_one_is_held_out(make_scene, known):
    """Wherever they are: counted along the run both would have been fitted to, or held out."""
    for odd in ([0, 1], [3, 7], [2, 9]):
        scene = off_in(make_scene(4, duration_s=120.0), odd)
        (numbers,) = held_out_pieces([scene], known, CONFIG, has_yaw=True)
        assert len(set(odd) & set(numbers)) == 1


def test_runs_that_are_held_out_stay_whole(make_scene):
    scene, other = make_scene(4), make_scene(5)
    (fitted,), (held,) = apart(([scene], [other]), None, CONFIG)
    assert held is other
    assert len(fitted) == min(len(scene), CONFIG.most_windows)
