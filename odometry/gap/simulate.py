"""What a model with effects predicts that the reference sensor measures."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Base
from odometry.effects.corrected import Added, corrected_twist, delay_s, seen_poses
from odometry.gap.scene import Scene
from odometry.geometry import se2
from odometry.geometry.angles import wrap


def simulated_poses(base: Base, effects: Sequence[Added], scene: Scene) -> FloatArray:
    """Poses (M, 3) at the stamps of the measured ones, from the origin; yaw is not wrapped."""
    twist = corrected_twist(base, effects, scene.inputs)
    path = _path(twist * scene.steps_s[:, None], scene)
    seen_s = scene.pose_s - base.latency_s - delay_s(effects)
    poses = np.stack([np.interp(seen_s, scene.time_s, column) for column in path.T], axis=-1)
    return seen_poses(effects, poses)


def residuals(base: Base, effects: Sequence[Added], scene: Scene) -> FloatArray:
    """Measured less simulated motion (K, n, 3), in the frame of each window's first pose."""
    poses = simulated_poses(base, effects, scene)[scene.windows]
    difference = scene.measured - se2.between(poses[:, :1], poses[:, 1:])
    difference[..., 2] = wrap(difference[..., 2])
    return difference


def _path(displacements: FloatArray, scene: Scene) -> FloatArray:
    """Poses (N, 3) before each arc, in the level frame.

    An arc's chord leads ahead by half its angle, and is shorter than the arc by sin(h) / h of that
    half, here by its series: right to 1e-9 for turns of less than 0.3 rad a step.
    """
    angle = displacements[:, 2]
    half = angle / 2
    shorter = 1 - half**2 / 6 * (1 - half**2 / 20)
    dx, dy = shorter * displacements[:, 0], shorter * displacements[:, 1]
    if scene.tilt is None:
        yaw = _before(angle)
        cosine, sine = np.cos(yaw + half), np.sin(yaw + half)
        return np.column_stack(
            [_before(cosine * dx - sine * dy), _before(sine * dx + cosine * dy), yaw]
        )
    cosine, sine = np.cos(half), np.sin(half)
    dx, dy = cosine * dx - sine * dy, sine * dx + cosine * dy
    cos_pitch, sin_both, cos_roll = scene.tilt
    along, across = cos_pitch * dx + sin_both * dy, cos_roll * dy  # odometry.geometry.levelled
    sine, cosine = 2 * sine * cosine, 1 - 2 * sine**2
    yaw = _before(np.arctan2(cos_roll * sine, cos_pitch * cosine + sin_both * sine))
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return np.column_stack(
        [_before(cosine * along - sine * across), _before(sine * along + cosine * across), yaw]
    )


def _before(steps: FloatArray) -> FloatArray:
    return np.concatenate([[0.0], np.cumsum(steps[:-1])])
