"""What an odometer errs by while its parameters are still being learned."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimates import Replay
from odometry.estimation.transition import STATES, Y_LEFT
from odometry.evaluation.open_loop_errors import OpenLoopPath
from odometry.models.icr import icr_speed_matrix, icr_twist_jacobian


def learning_covariances(replay: Replay, path: OpenLoopPath) -> FloatArray:
    """Covariances (N, 3, 3) by which poses of the odometer are less sure than the run's usual.

    The noise of an odometer is measured over the whole run. Where the filter was less sure of a
    parameter than usual (the median of the run), as it is at first, the difference of the two
    variances acts along the path besides. The error of a parameter is taken to keep its sign
    while it shrinks, and those of different parameters to be independent.
    """
    variances = np.square(replay.sigmas[:, Y_LEFT:])
    excess = np.sqrt(np.maximum(variances - np.median(variances, axis=0), 0.0))[:-1]
    steps_s = np.diff(replay.stamps_s)
    slopes = _twist_slopes(replay) * excess[:, None, :] * steps_s[:, None, None]
    moved = np.stack([path.moved_by(slopes[..., k]) for k in range(slopes.shape[-1])])
    return np.asarray(np.einsum("kni,knj->nij", moved, moved))


def _twist_slopes(replay: Replay) -> FloatArray:
    """Derivatives (N - 1, 3, 6) of twists by y_left, y_right, x_icr, bias, alphas."""
    held = replay.estimates[:-1]
    icrs, bias, alphas = np.split(replay.means[:-1, Y_LEFT:], [3, 4], axis=1)
    speeds = np.nan_to_num(
        np.stack([estimate.tread_speeds_m_s + estimate.added_speeds_m_s for estimate in held])
    )
    slopes = np.zeros((len(held), 3, STATES - Y_LEFT))
    slopes[..., :3] = icr_twist_jacobian(icrs, alphas * speeds)
    slopes[..., 4:] = icr_speed_matrix(icrs) * speeds[:, None, :]
    believed = np.array([estimate.believed_yaw_rate_rad_s for estimate in replay.estimates[1:]])
    told = np.isfinite(believed)
    omega = (believed - bias[:, 0])[told]
    by_gyroscope = np.zeros((len(omega), 3, STATES - Y_LEFT))
    by_gyroscope[:, 0, 0] = by_gyroscope[:, 0, 1] = omega / 2
    by_gyroscope[:, 1, 2] = -omega
    by_gyroscope[:, 0, 3] = -icrs[told, :2].sum(axis=1) / 2
    by_gyroscope[:, 1, 3] = icrs[told, 2]
    by_gyroscope[:, 2, 3] = -1.0
    by_gyroscope[:, 0, 4:] = speeds[told] / 2
    slopes[told] = by_gyroscope
    return slopes
