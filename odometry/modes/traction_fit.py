"""Fit the gains of one traction mode to measured motion and yaw rates."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from odometry.arrays import FloatArray, IntArray
from odometry.models.icr import GUESSED_WIDTHS
from odometry.modes.first_order_lag import SHORTEST_LAG_S, lagged
from odometry.modes.traction_gains import requested, turns_of, twists_of
from odometry.modes.yaw_rate_noise import Heard, YawRateNoise
from odometry.windows.dense import DenseWindows, off_measured, poses_at
from odometry.windows.dense_noise import Noise, whitening
from odometry.windows.motion import level_path

FIRST_LAG_S = 0.05
USUAL = 0.3  # deviation of each gain from eq. 3: what the runs leave open stays near
EQ_3 = np.array([[1, 0, 0, 0, 0], [0, 0, 0, 0, 0], [0, 1, 0, 0, 0]], dtype=np.bool_)
"""Gains that eq. 3 has."""
SHARED, BY_TURN = [0, 1], [2, 3, 4]  # columns of gains


@dataclass(frozen=True)
class TractionFit:
    """One mode.

    Attributes
    ----------
    gains : (2, 3, 5)
        As in `TractionModes`.
    lag_s : float
    covariances : (2, 3, 5, 5)
        Of the gains of each speed.
    """

    gains: FloatArray
    lag_s: float
    covariances: FloatArray

    def twist_variances(self, scene: DenseWindows) -> FloatArray:
        """What the runs leave open of (v_x, v_y, omega) at each sample (N, 3) of a scene."""
        speeds = scene.inputs.tread_speeds_m_s
        inputs = requested(speeds, scene.run.robot.track_width)
        of_turn = self.covariances[turns_of(speeds)]
        return np.asarray(np.einsum("ni,nqij,nj->nq", inputs, of_turn, inputs))


def fitted(
    scenes: Sequence[DenseWindows],
    heard: Sequence[Heard],
    noise: Noise,
    yaw_rate_noise: YawRateNoise,
    *,
    paper: bool = False,
) -> TractionFit:
    """Gains and lag, 0 with `paper`, of the windows of scenes and what a gyroscope heard."""
    parameter = _parameters(paper=paper)
    whiteners = [whitening(scene, noise) for scene in scenes]

    def fit_at(values: FloatArray) -> tuple[FloatArray, float]:
        gains = np.where(parameter >= 0, values[parameter], 0.0)
        return gains, 0.0 if paper else float(values[-1])

    def rows_at(values: FloatArray) -> FloatArray:
        gains, lag_s = fit_at(values)
        poses = [
            np.einsum("kij,kj->ki", white, residuals(gains, lag_s, scene).reshape(len(scene), -1))
            for white, scene in zip(whiteners, scenes, strict=True)
        ]
        yaw_rates = [
            one.errors(gains, lag_s) / np.sqrt(yaw_rate_noise.variances(one.accelerations_m_s2))
            for one in heard
        ]
        prior = (values - first)[:-1] / USUAL
        return np.concatenate([*poses, *yaw_rates, prior], axis=None)

    first = np.append(np.zeros(parameter.max() + 1), FIRST_LAG_S)
    for of_turn in parameter:
        first[of_turn[EQ_3]] = (1.0, 1.0 / GUESSED_WIDTHS)
    low = np.append(np.full(len(first) - 1, -np.inf), 0.0)
    found = least_squares(rows_at, first, bounds=(low, np.inf), x_scale="jac")
    covariance = np.linalg.pinv(found.jac.T @ found.jac)
    of_gains = covariance[parameter[..., :, None], parameter[..., None, :]]
    free = parameter >= 0
    of_gains = np.where(free[..., :, None] & free[..., None, :], of_gains, 0.0)
    return TractionFit(*fit_at(np.asarray(found.x)), of_gains)


def residuals(gains: FloatArray, lag_s: float, scene: DenseWindows) -> FloatArray:
    """Measured less predicted motion (K, n, 3) of the windows of a scene."""
    twists = twists_of(gains, scene.inputs.tread_speeds_m_s, scene.run.robot.track_width)
    yaw_rates = lagged(twists[:, 2], scene.time_s, lag_s)
    # the mean over a step: lag d(omega)/dt = asked - omega, integrated
    twists[:-1, 2] -= max(lag_s, SHORTEST_LAG_S) * np.diff(yaw_rates) / np.diff(scene.time_s)
    path = level_path(twists, scene.steps_s, scene.inputs)
    return off_measured(poses_at(path, scene, scene.pose_s), scene)


def _parameters(*, paper: bool) -> IntArray:
    """Which parameter each gain (2, 3, 5) is, -1 for those that are 0.

    Left and right turns share what u_1 and u_2 move, so that the twist does not jump where one
    becomes the other: on straights and on the spot the rest is 0.
    """
    if paper:
        return np.tile(np.where(EQ_3, np.cumsum(EQ_3).reshape(EQ_3.shape) - 1, -1), (2, 1, 1))
    parameter = np.empty((2, 3, 5), dtype=np.int64)
    parameter[..., SHARED] = np.arange(6).reshape(3, 2)
    parameter[..., BY_TURN] = 6 + np.arange(18).reshape(2, 3, 3)
    return parameter
