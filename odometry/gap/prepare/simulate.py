"""What a model with effects predicts that the reference sensor measures."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray, components_last
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import (
    Added,
    corrected_twist,
    delay_s,
    reported_yaw_rate,
    seen_poses,
)
from odometry.effects.interface.recorded import Reported
from odometry.effects.interface.time_course import run_numbers
from odometry.windows.dense.dense import DenseWindows, off_measured, poses_at
from odometry.windows.recorded.measured_poses import YAW_FOUND
from odometry.windows.travel.motion import level_path

TOGETHER = 40  # rows of a window that are whitened at once


def simulated_poses(base: Base, effects: Sequence[Added], scene: DenseWindows) -> FloatArray:
    """Poses (M, 3) at the stamps of the measured ones, from the origin; yaw is not wrapped."""
    return poses_on(
        path_of(corrected_twist(base, effects, scene.inputs), scene), base, effects, scene
    )


def path_of(twists: FloatArray, scene: DenseWindows) -> FloatArray:
    """Poses (..., N, 3) of a robot before each sample of a scene, driven by twists (..., N, 3)."""
    return level_path(twists, scene.steps_s, scene.inputs)


def poses_on(
    path: FloatArray, base: Base, effects: Sequence[Added], scene: DenseWindows
) -> FloatArray:
    """Poses (M, 3) that the reference reports of a robot on a path (N, 3)."""
    seen_s = measured_s(base, effects, scene)
    return seen_poses(effects, poses_at(path, scene, seen_s), reported_of(scene))


def measured_s(base: Base, effects: Sequence[Added], scene: DenseWindows) -> FloatArray:
    """Run time (M,) at which the poses of a scene were measured, by their stamps."""
    late_s = delay_s(effects, scene.pose_s, run_of(scene))
    return np.asarray(scene.pose_s - base.latency_s - late_s)


def reported_of(scene: DenseWindows) -> Reported:
    """What the reference reported of a run."""
    pose = scene.run.pose
    by_gyroscope = scene.inputs.yaw_rate_rad_s is not None
    found = pose is not None and YAW_FOUND in pose and by_gyroscope
    return Reported(scene.pose_s, scene.poses, run_of(scene), yaw_is_found=found)


def run_of(scene: DenseWindows) -> int:
    """Number of the run of a scene among several."""
    return int(run_numbers(scene.inputs)[0])


def residuals(base: Base, effects: Sequence[Added], scene: DenseWindows) -> FloatArray:
    """Measured less simulated motion (K, n, 3), in the frame of each window's first pose."""
    return off_measured(simulated_poses(base, effects, scene), scene)


def all_residuals(base: Base, effects: Sequence[Added], scene: DenseWindows) -> FloatArray:
    """Residuals (K, R): of all poses of each window, then of the gyroscope if there is one."""
    twists = corrected_twist(base, effects, scene.inputs)
    return residuals_on(twists, path_of(twists, scene), base, effects, scene)


def all_residuals_of_each(
    models: Sequence[tuple[Base, Sequence[Added]]], scene: DenseWindows
) -> FloatArray:
    """The same (C, K, R) of several models: their paths are found at once."""
    by_component = [corrected_twist(*model, scene.inputs).T for model in models]
    twists = components_last(np.stack(by_component, axis=1))
    paths = path_of(twists, scene)
    each = zip(twists, paths, models, strict=True)
    return np.stack([residuals_on(twist, path, *model, scene) for twist, path, model in each])


def residuals_on(
    twists: FloatArray,
    path: FloatArray,
    base: Base,
    effects: Sequence[Added],
    scene: DenseWindows,
) -> FloatArray:
    """The same of a robot with twists (N, 3) on their path (N, 3)."""
    of_poses = rows_of_poses(path, base, effects, scene)
    of_gyroscope = rows_of_gyroscope(twists, base, effects, scene)
    return np.concatenate([of_poses, of_gyroscope], axis=1)


def rows_of_poses(
    path: FloatArray, base: Base, effects: Sequence[Added], scene: DenseWindows
) -> FloatArray:
    """Residuals (K, 3 n) of all poses of each window, of a robot on a path (N, 3)."""
    return off_measured(poses_on(path, base, effects, scene), scene).reshape(len(scene), -1)


def rows_of_gyroscope(
    twists: FloatArray, base: Base, effects: Sequence[Added], scene: DenseWindows
) -> FloatArray:
    """Residuals (K, n) of the turns of each window under twists (N, 3); (K, 0) without them.

    Less what is the same at all times of the run: a gyroscope has another bias after each start.
    """
    if scene.reported_turns is None:
        return np.empty((len(scene), 0))
    rates = reported_yaw_rate(effects, twists[:, 2], scene.inputs)
    return scene.less_bias(scene.reported_turns - scene.turns_of(rates, base.gyro_latency_s))


def whitened_residuals(
    base: Base,
    effects: Sequence[Added],
    scenes: Sequence[DenseWindows],
    whiteners: Sequence[FloatArray],
) -> FloatArray:
    """Residuals (R,) of all windows, scene by scene, each scene by its whiteners (K, R, R)."""
    found = [
        whitened_rows(white, all_residuals(base, effects, scene)).ravel()
        for white, scene in zip(whiteners, scenes, strict=True)
    ]
    return np.concatenate(found)


def whitened_rows(white: FloatArray, rows: FloatArray) -> FloatArray:
    """Residuals (K, R) whitened by triangular matrices (K, R, R), whose zeros are left out."""
    made = np.empty_like(rows)
    for begin in range(0, rows.shape[1], TOGETHER):
        own, before = slice(begin, begin + TOGETHER), slice(begin + TOGETHER)
        made[:, own] = (white[:, own, before] @ rows[:, before, None])[..., 0]
    return made
