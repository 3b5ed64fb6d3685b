"""How the residuals of windows answer to small changes of the motion, to first order."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.corrected import Added, corrected_twist, delay_s, with_true_speeds
from odometry.effects.residual import Residual
from odometry.gap.measured import Measured
from odometry.geometry import se2
from odometry.geometry.levelled import level_step_jacobian
from odometry.windows.dense import DenseWindows
from odometry.windows.motion import level_path


def columns_of(
    residual: Residual, base: Base, effects: Sequence[Added], measured: Measured
) -> FloatArray:
    """Derivative (R, P) of the rows of measured windows by a smooth function's coefficients."""
    found = []
    for scene, whiteners in zip(measured.scenes, measured.whiteners, strict=True):
        changes = changes_by(residual, base, effects, scene)
        found.append(responses(base, effects, scene, whiteners, changes))
    return np.concatenate(found)


def changes_by(
    residual: Residual, base: Base, effects: Sequence[Added], scene: DenseWindows
) -> FloatArray:
    """What a smooth function adds to the twist (P, N, 3) after the effects."""
    inputs = with_true_speeds(effects, scene.inputs)
    return residual.columns(corrected_twist(base, effects, scene.inputs), inputs, base)


def responses(
    base: Base,
    effects: Sequence[Added],
    scene: DenseWindows,
    whiteners: FloatArray,
    changes: FloatArray,
) -> FloatArray:
    """Derivative (R, C) of whitened residuals by the size of changes (C, N, 3) of the twist.

    Parameters
    ----------
    base, effects
        The simulation; what effects on the measurement do to a change is neglected.
    scene : DenseWindows
        Of N samples.
    whiteners : (K, R / K, R / K)
    changes : (C, N, 3)
        Twists that are added.
    """
    twist = corrected_twist(base, effects, scene.inputs)
    seen_s = scene.pose_s - base.latency_s - delay_s(effects, scene.pose_s)
    moved = _moved_path(twist, scene, changes)
    path = level_path(twist, scene.steps_s, scene.inputs)
    rows = _off_first(_at(path.T, scene, seen_s), _at(moved, scene, seen_s), scene)
    if scene.reported_turns is not None:
        turned = _summed(changes[..., 2] * scene.steps_s)
        felt = _at(turned, scene, scene.pose_s - base.gyro_latency_s)
        rows = np.concatenate([rows, np.diff(felt[:, scene.windows], axis=-1)], axis=-1)
    return -(whiteners @ np.moveaxis(rows, 0, -1)).reshape(-1, len(changes))


def _moved_path(twist: FloatArray, scene: DenseWindows, changes: FloatArray) -> FloatArray:
    """Change (3, C, N) of the poses before each sample: of x, y and yaw."""
    arcs, by_twist = se2.linearised_exp(twist * scene.steps_s[:, None])
    if scene.inputs.tilt is not None:
        by_twist = level_step_jacobian(arcs, scene.inputs.tilt) @ by_twist
    along, across, turn = np.einsum(
        "nij,cnj->icn", by_twist * scene.steps_s[:, None, None], changes, optimize=True
    )
    x, y, yaw = level_path(twist, scene.steps_s, scene.inputs).T
    after_x, after_y = (np.append(place[1:], place[-1]) for place in (x, y))
    cosine, sine = np.cos(yaw), np.sin(yaw)
    turned = _summed(turn)
    moved_x = _summed(cosine * along - sine * across + after_y * turn) - y * turned
    moved_y = _summed(sine * along + cosine * across - after_x * turn) + x * turned
    return np.stack([moved_x, moved_y, turned])


def _off_first(poses: FloatArray, moved: FloatArray, scene: DenseWindows) -> FloatArray:
    """Change (C, K, 3 n) of the motion from each window's first pose, of poses (3, M)."""
    first, others = scene.windows[:, :1], scene.windows[:, 1:]
    x, y, yaw = poses
    cosine, sine = np.cos(yaw[first]), np.sin(yaw[first])
    along = cosine * (x[others] - x[first]) + sine * (y[others] - y[first])
    across = cosine * (y[others] - y[first]) - sine * (x[others] - x[first])
    by_x, by_y, by_yaw = moved[..., others] - moved[..., first]
    swung = moved[2][:, first]
    motion = [
        cosine * by_x + sine * by_y + across * swung,
        cosine * by_y - sine * by_x - along * swung,
        by_yaw,
    ]
    return np.stack(motion, axis=-1).reshape(moved.shape[1], len(first), -1)


def _at(values: FloatArray, scene: DenseWindows, times_s: FloatArray) -> FloatArray:
    """Values (..., N) at run times (M,), linear between the samples, level beyond them."""
    time_s = scene.time_s
    before = np.clip(np.searchsorted(time_s, times_s, side="right") - 1, 0, len(time_s) - 2)
    share = np.clip((times_s - time_s[before]) / (time_s[before + 1] - time_s[before]), 0.0, 1.0)
    return np.asarray(values[..., before] * (1 - share) + values[..., before + 1] * share)


def _summed(steps: FloatArray) -> FloatArray:
    """Sums (..., N) of the steps (..., N) before each one."""
    sums = np.zeros_like(steps)
    np.cumsum(steps[..., :-1], axis=-1, out=sums[..., 1:])
    return sums
