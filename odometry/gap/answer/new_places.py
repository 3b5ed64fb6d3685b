"""Whether a change of the robot may be another terrain: it began where the robot came first."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from odometry.arrays import FloatArray
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import CommandsInCourse, MotionInCourse
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.motion.terrain import Terrain
from odometry.gap.answer.result import Equivalent
from odometry.windows.dense.dense import DenseWindows

TERRAIN = Terrain.name
NEAR_M = 1.0  # of a path: nearer it is the same place
MOSTLY = 0.8  # of the poses
DRIVE_BACK = (
    "drive back to where the robot was before the moment: what stays is the robot's, what goes "
    "away was a patch of another terrain"
)


def terrain_instead(
    effects: Sequence[Added], equivalent: Sequence[Equivalent], scenes: Sequence[DenseWindows]
) -> tuple[Equivalent, ...]:
    """Another terrain, in place of an effect that acts from a moment on, at new places alone.

    None where a terrain is named, or is an equivalent already.
    """
    if TERRAIN in [*(added.effect.name for added in effects), *(one.name for one in equivalent)]:
        return ()
    moved = [added.effect.name for added in effects if _at_new_places(added, scenes)]
    return tuple(Equivalent(TERRAIN, name, DRIVE_BACK) for name in moved[:1])


def _at_new_places(added: Added, scenes: Sequence[DenseWindows]) -> bool:
    """Whether nearly all of each run after its moment is at places where it was not before."""
    effect = added.effect
    if not isinstance(effect, CommandsInCourse | MotionInCourse):
        return False
    course = effect.in_time
    if not isinstance(course, FromAMoment):
        return False
    moments_s = added.values[-len(course.parameters) :]
    shares = [
        _share_at_new_places(scene.pose_s, scene.poses[:, :2], moment_s)
        for scene, moment_s in zip(scenes, moments_s, strict=False)
    ]
    return bool(shares) and min(shares) >= MOSTLY


def _share_at_new_places(pose_s: FloatArray, positions_m: FloatArray, moment_s: float) -> float:
    """Share of the positions (M, 2) after a moment that are far from all before it; 0 of none."""
    before, after = positions_m[pose_s < moment_s], positions_m[pose_s >= moment_s]
    if not len(before) or not len(after):
        return 0.0
    apart_m, _ = cKDTree(before).query(after)
    return float(np.mean(apart_m > NEAR_M))
