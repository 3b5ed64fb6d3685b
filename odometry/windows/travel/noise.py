"""How the noise of measured poses shows in the measured motion of windows.

With m the measured motion, A and B its derivatives by the noise of the poses at the start and at
the end, each in that pose's own frame: [-I, (m_y, -m_x)'; 0, -1] and [R(m_yaw), 0; 0, 1].
"""

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import Windows


def pose_variances(config: WindowConfig) -> FloatArray:
    """Variances (3,) of a measured pose: x, y [m^2], yaw [rad^2]."""
    return np.square([config.position_sigma_m, config.position_sigma_m, config.yaw_sigma_rad])


def by_pose_noise(windows: Windows) -> tuple[FloatArray, FloatArray]:
    """The derivatives A and B, (K, 3, 3) each."""
    x, y, yaw = windows.measured.T
    at_start = np.broadcast_to(-np.eye(3), (len(windows), 3, 3)).copy()
    at_start[:, 0, 2], at_start[:, 1, 2] = y, -x
    at_end = np.zeros((len(windows), 3, 3))
    at_end[:, 0, 0] = at_end[:, 1, 1] = np.cos(yaw)
    at_end[:, 0, 1], at_end[:, 1, 0] = -np.sin(yaw), np.sin(yaw)
    at_end[:, 2, 2] = 1.0
    return at_start, at_end


def window_covariances(windows: Windows, variances: FloatArray) -> FloatArray:
    """Covariance (K, 3, 3) of the measured motion of each window: Sigma of Baril 2020 eq. 13."""
    at_start, at_end = by_pose_noise(windows)
    return np.asarray(
        (at_start * variances) @ at_start.swapaxes(1, 2)
        + (at_end * variances) @ at_end.swapaxes(1, 2)
    )


def score_covariance(
    windows: Windows, gradients: FloatArray, variances: FloatArray, motion: FloatArray
) -> FloatArray:
    """Covariance (F, F) of the gradient of the loss.

    Parameters
    ----------
    windows : Windows
    gradients : (K, F, 3)
        Derivative of the gradient by each window's measured motion.
    variances : (3,)
        Of a measured pose; windows that share a pose share its noise.
    motion : (3,)
        Variances per metre of wheel travel that the model does not explain, independent from
        window to window.
    """
    at_start, at_end = by_pose_noise(windows)
    poses = int(max(windows.first_pose.max(), windows.last_pose.max())) + 1
    by_pose = np.zeros((poses, gradients.shape[1], 3))
    np.add.at(by_pose, windows.first_pose, gradients @ at_start)
    np.add.at(by_pose, windows.last_pose, gradients @ at_end)
    measured = np.einsum("pfi,i,pgi->fg", by_pose, variances, by_pose)
    moved = np.einsum("kfi,i,k,kgi->fg", gradients, motion, windows.travel_m, gradients)
    return np.asarray(measured + moved)
