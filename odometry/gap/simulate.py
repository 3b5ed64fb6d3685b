"""What a model with effects predicts that the reference sensor measures."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Base
from odometry.effects.corrected import Added, corrected_twist, delay_s, seen_poses
from odometry.gap.scene import Scene
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.identification.motion import level_path


def simulated_poses(base: Base, effects: Sequence[Added], scene: Scene) -> FloatArray:
    """Poses (M, 3) at the stamps of the measured ones, from the origin; yaw is not wrapped."""
    twists = corrected_twist(base, effects, scene.inputs)
    path = level_path(twists, scene.steps_s, scene.inputs)
    seen_s = scene.pose_s - base.latency_s - delay_s(effects)
    poses = np.stack([np.interp(seen_s, scene.time_s, column) for column in path.T], axis=-1)
    return seen_poses(effects, poses)


def residuals(base: Base, effects: Sequence[Added], scene: Scene) -> FloatArray:
    """Measured less simulated motion (K, n, 3), in the frame of each window's first pose."""
    poses = simulated_poses(base, effects, scene)[scene.windows]
    difference = scene.measured - se2.between(poses[:, :1], poses[:, 1:])
    difference[..., 2] = wrap(difference[..., 2])
    return difference
