"""What a model with effects predicts that the reference sensor measures."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Base
from odometry.effects.corrected import Added, corrected_twist, delay_s, seen_poses
from odometry.gap.scene import Scene
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.windows.motion import level_path


def simulated_poses(base: Base, effects: Sequence[Added], scene: Scene) -> FloatArray:
    """Poses (M, 3) at the stamps of the measured ones, from the origin; yaw is not wrapped."""
    twists = corrected_twist(base, effects, scene.inputs)
    path = level_path(twists, scene.steps_s, scene.inputs)
    seen_s = scene.pose_s - base.latency_s - delay_s(effects)
    return seen_poses(effects, poses_at(path, scene, seen_s))


def residuals(base: Base, effects: Sequence[Added], scene: Scene) -> FloatArray:
    """Measured less simulated motion (K, n, 3), in the frame of each window's first pose."""
    return off_measured(simulated_poses(base, effects, scene), scene)


def whitened_residuals(
    base: Base,
    effects: Sequence[Added],
    scenes: Sequence[Scene],
    whiteners: Sequence[FloatArray],
) -> FloatArray:
    """Residuals (R,) of all windows, scene by scene, each scene by its whiteners (K, 3n, 3n)."""
    return np.concatenate(
        [
            np.einsum("kij,kj->ki", white, residuals(base, effects, s).reshape(len(s), -1))
            for white, s in zip(whiteners, scenes, strict=True)
        ],
        axis=None,
    )


def poses_at(path: FloatArray, scene: Scene, seen_s: FloatArray) -> FloatArray:
    """Poses (M, 3) of a path (N, 3) over a scene's samples at run times (M,)."""
    return np.stack([np.interp(seen_s, scene.time_s, column) for column in path.T], axis=-1)


def off_measured(poses: FloatArray, scene: Scene) -> FloatArray:
    """Measured motion less that of poses (M, 3), (K, n, 3), in the frame of each first pose."""
    poses = poses[scene.windows]
    difference = scene.measured - se2.between(poses[:, :1], poses[:, 1:])
    difference[..., 2] = wrap(difference[..., 2])
    return difference
