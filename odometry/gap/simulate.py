"""What a model with effects predicts that the reference sensor measures."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.corrected import Added, corrected_twist, delay_s, seen_poses
from odometry.windows.dense import DenseWindows
from odometry.windows.dense_motion import off_measured, poses_at
from odometry.windows.motion import level_path


def simulated_poses(base: Base, effects: Sequence[Added], scene: DenseWindows) -> FloatArray:
    """Poses (M, 3) at the stamps of the measured ones, from the origin; yaw is not wrapped."""
    twists = corrected_twist(base, effects, scene.inputs)
    path = level_path(twists, scene.steps_s, scene.inputs)
    seen_s = scene.pose_s - base.latency_s - delay_s(effects, scene.pose_s)
    return seen_poses(effects, poses_at(path, scene, seen_s), scene.poses[:, 2])


def residuals(base: Base, effects: Sequence[Added], scene: DenseWindows) -> FloatArray:
    """Measured less simulated motion (K, n, 3), in the frame of each window's first pose."""
    return off_measured(simulated_poses(base, effects, scene), scene)


def whitened_residuals(
    base: Base,
    effects: Sequence[Added],
    scenes: Sequence[DenseWindows],
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
