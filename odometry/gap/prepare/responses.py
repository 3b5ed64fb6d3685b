"""How the residuals of windows answer to small changes of motion, to first order."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.chain import Chain
from odometry.effects.interface.base import MeasurementEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, reported_yaw_rate, seen_poses
from odometry.effects.unknown.residual import Residual
from odometry.gap.prepare.simulate import (
    TOGETHER,
    measured_s,
    reported_of,
    rows_of_gyroscope,
)
from odometry.windows.dense.dense import DenseWindows, motion_from_first
from odometry.windows.recorded.between import between
from odometry.windows.travel.motion import linearised_level_path

STEP = 1e-6  # m, rad, rad/s: over which sensors are linearised
MOST_SAMPLES = 1_000_000  # of changes at once: some ten arrays of their size are in memory then


class Responses:
    """A simulation of one scene, and what small changes of its twist do to the residuals.

    Attributes
    ----------
    chain : Chain
        The twists of the simulation.
    path : (N, 3)
        The robot's poses before each sample.
    """

    def __init__(self, base: Base, effects: Sequence[Added], scene: DenseWindows) -> None:
        self.chain = Chain(base, effects, scene.inputs)
        twist, windows = self.chain.twist, scene.windows
        self.path, self._by_twist = linearised_level_path(twist, scene.steps_s, scene.inputs)
        self._scene = scene
        seen = between(scene.time_s, measured_s(base, effects, scene))
        poses = seen.of(self.path.T).T
        self._seen = seen.rows(windows)
        self._by_pose = _by_pose(effects, poses, scene)
        reported = seen_poses(effects, poses, reported_of(scene))
        self._motion = motion_from_first(reported, windows)
        self._first_yaw = reported[windows[:, 0], 2]
        delayed = between(scene.time_s, scene.pose_s - base.gyro_latency_s)
        self._delayed = delayed.rows(windows)
        self._by_rate = _by_rate(effects, twist[:, 2], scene) * scene.steps_s

    @property
    def rows_of_poses(self) -> FloatArray:
        """Residuals (K, 3 n) of all poses of each window."""
        return (self._scene.measured - self._motion).reshape(len(self._scene), -1)

    @cached_property
    def rows_of_turns(self) -> FloatArray:
        """Residuals (K, n) of the gyroscope; (K, 0) without one."""
        chain = self.chain
        return rows_of_gyroscope(chain.twist, chain.base, chain.effects, self._scene)

    def of(self, changes: FloatArray) -> FloatArray:
        """Derivative (C, K, R) of residuals by the size of changes (C, N, 3) of the twist."""
        rows = np.empty((len(changes), len(self._scene), self._scene.rows_per_window))
        together = max(1, MOST_SAMPLES // changes.shape[1])
        for begin in range(0, len(changes), together):
            some = slice(begin, begin + together)
            self._of_some(changes[some], rows[some])
        return rows

    def _of_some(self, changes: FloatArray, rows: FloatArray) -> None:
        """Put the derivative by some changes (C, N, 3) into rows (C, K, R)."""
        v_x, v_y, omega = np.ascontiguousarray(np.moveaxis(changes, -1, 0))
        x_by, y_by, yaw_by = self._by_twist[:3], self._by_twist[3:6], self._by_twist[6]
        x, y, _ = self.path.T
        moved = np.empty((3, *omega.shape))
        _, _, turned = moved
        _sum(yaw_by * omega, turned)
        for place, by, swung in ((0, x_by, -y), (1, y_by, x)):
            _sum(by[0] * v_x + by[1] * v_y + by[2] * omega, moved[place])
            moved[place] += swung * turned
        steps = self._scene.windows.shape[1] - 1
        self._off_first(self._seen.of(moved), rows[..., : 3 * steps])
        if self._scene.reported_turns is not None:
            reported = self._delayed.of(_sum(omega * self._by_rate, np.empty_like(omega)))
            turned = reported[..., :-1] - reported[..., 1:]
            rows[..., 3 * steps :] = self._scene.less_bias(turned)

    def _off_first(self, moved: FloatArray, rows: FloatArray) -> None:
        """Change of residuals into rows (C, K, 3 n), of changes (3, C, K, n + 1) of all poses."""
        if self._by_pose is not None:
            by_pose = self._by_pose[self._scene.windows]
            moved = np.einsum("klij,jckl->ickl", by_pose, moved)
        along, across, _ = np.moveaxis(self._motion, -1, 0)
        cosine, sine = np.cos(self._first_yaw)[:, None], np.sin(self._first_yaw)[:, None]
        by_x, by_y, by_yaw = moved[..., :1] - moved[..., 1:]
        swung = moved[2][..., :1]
        motion = rows.reshape(*by_x.shape, 3)
        motion[..., 0] = cosine * by_x + sine * by_y - across * swung
        motion[..., 1] = cosine * by_y - sine * by_x + along * swung
        motion[..., 2] = by_yaw


def columns_of(
    residual: Residual,
    simulated: Sequence[Responses],
    whiteners: Sequence[FloatArray],
) -> FloatArray:
    """Derivative (R, P) of the rows of measured windows by a smooth function's coefficients."""
    found = []
    for scene, white in zip(simulated, whiteners, strict=True):
        chain = scene.chain
        changes = residual.columns(chain.twist, chain.inputs, chain.base)
        found.append(whitened(white, scene.of(changes)))
    return np.concatenate(found)


def whitened(white: FloatArray, columns: FloatArray) -> FloatArray:
    """Columns (C, K, R) whitened by triangular matrices (K, R, R), as those (K R, C)."""
    made = np.empty_like(columns)
    whiten(white, columns, made)
    return made.reshape(len(columns), -1).T


def whiten(white: FloatArray, columns: FloatArray, made: FloatArray) -> None:
    """Put columns (C, K, R) whitened by triangular matrices (K, R, R) into an array (C, K, R).

    Some rows at a time: their zeros are left out, and small products are fast ones.
    """
    for begin in range(0, columns.shape[-1], TOGETHER):
        rows, before = slice(begin, begin + TOGETHER), slice(begin + TOGETHER)
        np.matmul(
            columns[..., before].swapaxes(0, 1),
            white[:, rows, before].swapaxes(1, 2),
            out=made[..., rows].swapaxes(0, 1),
        )


def simulated_scenes(
    base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows]
) -> list[Responses]:
    """Each scene, simulated."""
    return [Responses(base, effects, scene) for scene in scenes]


def _by_pose(effects: Sequence[Added], poses: FloatArray, scene: DenseWindows) -> FloatArray | None:
    """Derivative (M, 3, 3) of what the reference reports by the robot's pose; None: the pose.

    Of effects pose by pose; what others do to a change of the course is neglected.
    """
    by_pose = [
        one for one in effects if isinstance(one.effect, MeasurementEffect) and one.effect.by_pose
    ]
    if not by_pose:
        return None
    reported = reported_of(scene)
    seen = seen_poses(by_pose, poses, reported)
    stepped = [seen_poses(by_pose, poses + step, reported) for step in STEP * np.eye(3)]
    return np.stack([(one - seen) / STEP for one in stepped], axis=-1)


def _by_rate(effects: Sequence[Added], rates: FloatArray, scene: DenseWindows) -> FloatArray:
    """Derivative (N,) of what the gyroscope reports by the robot's yaw rate (N,)."""
    stepped, at = (reported_yaw_rate(effects, of, scene.inputs) for of in (rates + STEP, rates))
    return np.asarray((stepped - at) / STEP)


def _sum(steps: FloatArray, sums: FloatArray) -> FloatArray:
    """Sums (..., N) of the steps (..., N) before each one."""
    sums[..., 0] = 0.0
    np.cumsum(steps[..., :-1], axis=-1, out=sums[..., 1:])
    return sums
