"""How the residuals of windows answer to small changes of motion and values, to first order."""

from collections.abc import Callable, Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import MeasurementEffect
from odometry.effects.base_model import Base
from odometry.effects.chain import Chain
from odometry.effects.corrected import Added, reported_yaw_rate, seen_poses
from odometry.effects.residual import Residual
from odometry.gap.prepare.simulate import measured_s, path_of, reported_of, residuals_on
from odometry.geometry import se2
from odometry.geometry.tilt import level_step_jacobian
from odometry.windows.dense import DenseWindows, poses_at

STEP = 1e-6  # m, rad, rad/s: over which sensors are linearised

At = Callable[[FloatArray], tuple[Base, tuple[Added, ...]]]


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
        self.path = path_of(self.chain.twist, scene)
        self._scene = scene
        self._by_twist = _by_twist(self.chain.twist, self.path, scene)
        seen_s = measured_s(base, effects, scene)
        self._seen = _Between(scene, seen_s)
        poses = poses_at(self.path, scene, seen_s)
        self._poses = seen_poses(effects, poses, reported_of(scene)).T
        self._by_pose = _by_pose(effects, poses, scene)
        self._felt = _Between(scene, scene.pose_s - base.gyro_latency_s)
        self._by_rate = _by_rate(effects, self.chain.twist[:, 2], scene)

    def of(self, changes: FloatArray) -> FloatArray:
        """Derivative (C, K, R) of residuals by the size of changes (C, N, 3) of the twist."""
        v_x, v_y, omega = np.ascontiguousarray(np.moveaxis(changes, -1, 0))
        x_by, y_by, yaw_by = self._by_twist[:3], self._by_twist[3:6], self._by_twist[6]
        x, y, _ = self.path.T
        turned = _summed(yaw_by * omega)
        moved = np.stack(
            [
                _summed(x_by[0] * v_x + x_by[1] * v_y + x_by[2] * omega) - y * turned,
                _summed(y_by[0] * v_x + y_by[1] * v_y + y_by[2] * omega) + x * turned,
                turned,
            ]
        )
        rows = self._off_first(self._seen.of(moved))
        if self._scene.reported_turns is not None:
            felt = self._felt.of(_summed(omega * (self._by_rate * self._scene.steps_s)))
            rows = np.concatenate([rows, felt[..., :-1] - felt[..., 1:]], axis=-1)
        return rows

    def _off_first(self, moved: FloatArray) -> FloatArray:
        """Change (C, K, 3 n) of residuals, of changes (3, C, K, n + 1) of all poses."""
        windows = self._scene.windows
        if self._by_pose is not None:
            moved = np.einsum("klij,jckl->ickl", self._by_pose[windows], moved)
        poses = self._poses[:, windows]
        yaw = poses[2, :, :1]
        cosine, sine = np.cos(yaw), np.sin(yaw)
        off_x, off_y = poses[:2, :, 1:] - poses[:2, :, :1]
        along, across = cosine * off_x + sine * off_y, cosine * off_y - sine * off_x
        by_x, by_y, by_yaw = moved[..., 1:] - moved[..., :1]
        swung = moved[2][..., :1]
        motion = np.empty((*by_x.shape, 3))
        motion[..., 0] = -cosine * by_x - sine * by_y - across * swung
        motion[..., 1] = sine * by_x - cosine * by_y + along * swung
        motion[..., 2] = -by_yaw
        return motion.reshape(*motion.shape[:2], -1)


class _Between:
    """Where run times of poses lie between samples, of the poses of each window."""

    def __init__(self, scene: DenseWindows, times_s: FloatArray) -> None:
        time_s = scene.time_s
        before = np.searchsorted(time_s, times_s, side="right") - 1
        before = np.clip(before, 0, len(time_s) - 2)
        share = (times_s - time_s[before]) / (time_s[before + 1] - time_s[before])
        self._before = before[scene.windows]
        self._share = np.clip(share, 0.0, 1.0)[scene.windows]

    def of(self, values: FloatArray) -> FloatArray:
        """Values (..., N) there (..., K, n + 1), linear between samples, level beyond them."""
        first = values.take(self._before, axis=-1)
        after = values.take(self._before + 1, axis=-1)
        after -= first
        after *= self._share
        first += after
        return first


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
    """Columns (C, K, R) as those (K R, C) of whitened residuals."""
    return (white @ np.moveaxis(columns, 0, -1)).reshape(-1, len(columns))


def simulated_scenes(
    base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows]
) -> list[Responses]:
    """Each scene, simulated."""
    return [Responses(base, effects, scene) for scene in scenes]


def _by_twist(twist: FloatArray, path: FloatArray, scene: DenseWindows) -> FloatArray:
    """What twists (N, 3) move: x (3), y (3) and yaw (by the turn alone) in rows (7, N).

    x and y are those of all later samples, turned about the origin.
    """
    arcs, by_arc = se2.linearised_exp(twist * scene.steps_s[:, None])
    along, across, turn = np.moveaxis(by_arc, 0, -1)
    swings = turn[2]
    if scene.inputs.tilt is not None:
        level = np.moveaxis(level_step_jacobian(arcs, scene.inputs.tilt), 0, -1)
        along, across = level[0, 0] * along + level[0, 1] * across, level[1, 1] * across
        swings = level[2, 2]
    x, y, yaw = path.T
    cosine, sine = np.cos(yaw), np.sin(yaw)
    by_x, by_y = cosine * along - sine * across, sine * along + cosine * across
    by_x[2] += np.append(y[1:], y[-1]) * swings  # a turn swings what comes after its step
    by_y[2] -= np.append(x[1:], x[-1]) * swings
    return np.stack([*by_x, *by_y, swings]) * scene.steps_s


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


def _summed(steps: FloatArray) -> FloatArray:
    """Sums (..., N) of the steps (..., N) before each one."""
    sums = np.empty_like(steps)
    sums[..., 0] = 0.0
    np.cumsum(steps[..., :-1], axis=-1, out=sums[..., 1:])
    return sums


def whitened_derivative(
    at: At,
    values: FloatArray,
    steps: FloatArray,
    scenes: Sequence[DenseWindows],
    whiteners: Sequence[FloatArray],
) -> FloatArray:
    """Derivative (R, V) of `whitened_residuals` by values (V,), over steps (V,); 0: not taken."""
    free = np.flatnonzero(steps)
    stepped = [at(values + step) for step in np.diag(steps)[free]]
    found = []
    for scene, white in zip(scenes, whiteners, strict=True):
        here = Responses(*at(values), scene)
        columns = _of_scene(here, stepped, steps[free], at(values), scene)
        found.append(whitened(white, columns))
    jacobian = np.zeros((sum(map(len, found)), len(values)))
    jacobian[:, free] = np.concatenate(found)
    return jacobian


def _of_scene(
    here: Responses,
    stepped: Sequence[tuple[Base, tuple[Added, ...]]],
    steps: FloatArray,
    at: tuple[Base, tuple[Added, ...]],
    scene: DenseWindows,
) -> FloatArray:
    """Derivative (F, K, R) of the residuals of one scene."""
    columns = np.empty((len(steps), len(scene), scene.rows_per_window))
    moving = np.array([here.chain.is_moved_by(*one) for one in stepped], dtype=np.bool_)
    if moving.any():
        changes = [
            (here.chain.at(*stepped[place]) - here.chain.twist) / steps[place]
            for place in np.flatnonzero(moving).tolist()
        ]
        columns[moving] = here.of(np.stack(changes))
    if not moving.all():
        rows = residuals_on(here.chain.twist, here.path, *at, scene)
        for place in np.flatnonzero(~moving).tolist():
            other = residuals_on(here.chain.twist, here.path, *stepped[place], scene)
            columns[place] = (other - rows) / steps[place]
    return columns
