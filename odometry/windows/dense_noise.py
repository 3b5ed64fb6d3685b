"""What noise explains: poses measured with error, and motion that wanders with travel.

The motion of a window is measured from its first pose, so that all of it shares that pose's
noise. Five variances make its covariance: of a measured position and yaw, of what a metre of
wheel travel adds to the place and to the yaw, and of what a second adds to the turn that the
gyroscope reports, which follows the robot where its motion wanders.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.dense import DenseWindows

FIRST_GUESS = np.square([0.02, 0.01, 0.005, 0.005, 0.001])
SMALLEST = np.square([1e-4, 1e-4, 1e-5, 1e-5, 1e-5])
ROUNDS = 10
MOST_WINDOWS = 60  # from which variances are estimated


@dataclass(frozen=True)
class Noise:
    """Standard deviations: position [m], yaw [rad], by the root of a metre of travel, of a second.

    `gyro_rad` is that of the gyroscope's turn [rad] over one second.
    """

    position_m: float
    yaw_rad: float
    wander_m: float
    wander_rad: float
    gyro_rad: float = 1e-3

    @property
    def variances(self) -> FloatArray:
        """Those of poses and travel (4,)."""
        return np.square([self.position_m, self.yaw_rad, self.wander_m, self.wander_rad])

    @property
    def all_variances(self) -> FloatArray:
        """The same and that of the gyroscope (5,)."""
        return np.append(self.variances, self.gyro_rad**2)


def covariance_parts(scene: DenseWindows) -> FloatArray:
    """Derivative (5, K, R, R) of the covariance of a window's residuals by each variance.

    The R residuals are those of n poses, three of each, then the n of a gyroscope if there is one.
    """
    motion = scene.measured
    count, steps, _ = motion.shape
    travel_m = scene.travel_m[np.searchsorted(scene.time_s, scene.pose_s[scene.windows])]
    added_m = np.diff(travel_m, axis=1)
    places = np.concatenate([np.zeros((count, 1, 2)), motion[..., :2]], axis=1)
    level = np.zeros((count, steps, 3, steps, 3))
    j = np.arange(steps)
    shared = np.ones((steps, steps)) + np.eye(steps)
    position, yaw, wander = (level.copy() for _ in range(3))
    for axis in (0, 1):
        position[:, :, axis, :, axis] = shared
    lever = np.concatenate(
        [-motion[..., 1:2], motion[..., :1], np.ones((count, steps, 1))], axis=-1
    )
    yaw += np.einsum("kja,klb->kjalb", lever, lever)
    yaw[:, j, 2, j, 2] += 1.0
    summed = np.cumsum(added_m, axis=1)
    reached = np.minimum(j[:, None], j[None, :])
    for axis in (0, 1):
        wander[:, :, axis, :, axis] = summed[:, reached]
    spread = places[:, None, 1:, :] - places[:, :-1, None, :]  # (K, i, j, 2) from i on
    swing = np.stack([-spread[..., 1], spread[..., 0], np.ones(spread.shape[:-1])], axis=-1)
    swing *= (j[None, :] >= j[:, None])[None, :, :, None]
    swing *= np.sqrt(added_m)[:, :, None, None]
    of_poses = 3 * steps
    turns = swing.reshape(count, steps, of_poses)
    if scene.reported_turns is not None:
        turns = np.concatenate([turns, np.sqrt(added_m)[:, :, None] * np.eye(steps)], axis=-1)
    parts = np.zeros((5, count, turns.shape[-1], turns.shape[-1]))
    for place, part in enumerate((position, yaw, wander)):
        parts[place, :, :of_poses, :of_poses] = part.reshape(count, of_poses, of_poses)
    parts[3] = turns.swapaxes(1, 2) @ turns
    gyro = np.arange(of_poses, turns.shape[-1])
    parts[4][:, gyro, gyro] = np.diff(scene.pose_s[scene.windows], axis=1)[:, : len(gyro)]
    return parts


def end_variance(scene: DenseWindows, noise: Noise) -> FloatArray:
    """Variance (K, 3) of the residuals at the end of each window."""
    of_poses = 3 * (scene.windows.shape[1] - 1)
    last = covariance_parts(scene)[:, :, of_poses - 3 : of_poses, of_poses - 3 : of_poses]
    return np.asarray(np.einsum("p,pkii->ki", noise.all_variances, last))


def whitening(scene: DenseWindows, noise: Noise) -> FloatArray:
    """Matrices (K, R, R) that make the residuals of each window white, of unit variance."""
    covariance = np.einsum("p,pkij->kij", noise.all_variances, covariance_parts(scene))
    factor = np.linalg.cholesky(covariance)
    identity = np.broadcast_to(np.eye(factor.shape[-1]), factor.shape)
    return np.asarray(np.linalg.solve(factor, identity))


def estimated_noise(scenes: Sequence[DenseWindows], residuals: Sequence[FloatArray]) -> Noise:
    """Most likely variances of the residuals (K, R) of each scene, by Fisher scoring."""
    parts, rows = [], []
    share = MOST_WINDOWS / max(1, sum(map(len, scenes)))
    for scene, of in zip(scenes, residuals, strict=True):
        most = max(1, round(share * len(scene)))
        chosen = np.unique(np.linspace(0, len(scene) - 1, min(most, len(scene))).astype(np.int64))
        picked = np.zeros(len(scene), dtype=np.bool_)
        picked[chosen] = True
        parts.append(covariance_parts(scene.where(picked)))
        rows.append(of[picked].reshape(len(chosen), -1))
    variances = FIRST_GUESS.copy()
    for _ in range(ROUNDS):
        score, information = np.zeros(len(variances)), np.zeros((len(variances),) * 2)
        for part, of in zip(parts, rows, strict=True):
            inverse = np.linalg.inv(np.einsum("p,pkij->kij", variances, part))
            weighted = np.einsum("kij,kj->ki", inverse, of)
            products = inverse @ part
            quadratic = np.einsum("ki,pkij,kj->p", weighted, part, weighted)
            score += (quadratic - np.einsum("pkii->p", products)) / 2
            information += np.einsum("pkij,qkji->pq", products, products) / 2
        step = np.linalg.lstsq(information, score, rcond=None)[0]
        variances = np.clip(variances + step, np.maximum(SMALLEST, variances / 20), 20 * variances)
    return Noise(*np.sqrt(variances).tolist())
