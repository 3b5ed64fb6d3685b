"""Degrees of freedom with which residuals determine the noise."""

import numpy as np
from scipy.sparse import csr_array

from odometry.arrays import FloatArray
from odometry.windows.noise import by_pose_noise
from odometry.windows.windows import Windows


def residual_freedom(
    windows: Windows, root: FloatArray, jacobian: FloatArray, variances: FloatArray
) -> tuple[float, float]:
    """Mean of the sum of squared residuals under the poses' noise, and its degrees of freedom.

    The residuals after a fit are e = M N z with z standard normal numbers, one for each
    coordinate of each pose: N spreads them over the windows, which share poses, and M = I - X B X'
    takes out what the parameters follow. With G = N' M N the sum e'e has the mean tr G, and is as
    chi-squared of (tr G)^2 / tr G^2 degrees of freedom (Satterthwaite 1946). Nothing dense is
    formed.

    Parameters
    ----------
    windows : Windows
    root : (K, 3, 3)
        Whitening of each window's residuals, with the square root of its weight.
    jacobian : (K, 3, F)
        Derivative of the residuals by the parameters.
    variances : (3,)
        Of a measured pose.
    """
    noise = _noise_matrix(windows, root, variances)
    by_parameters = (root @ jacobian).reshape(3 * len(windows), -1)
    followed = noise.T @ by_parameters  # N' X
    inverted = np.linalg.pinv(by_parameters.T @ by_parameters, rcond=1e-14, hermitian=True)
    taken = inverted @ followed.T @ followed
    shared = noise @ noise.T
    mean = float(noise.power(2).sum() - np.trace(taken))
    crossed = noise @ followed  # N N' X
    squares = float(
        shared.power(2).sum()
        - 2 * np.trace(inverted @ crossed.T @ crossed)
        + np.trace(taken @ taken)
    )
    return mean, mean**2 / squares


def _noise_matrix(windows: Windows, root: FloatArray, variances: FloatArray) -> csr_array:
    """Whitened residuals (3K) by standard normal noise (3P) of the poses."""
    poses, numbers = np.unique([windows.first_pose, windows.last_pose], return_inverse=True)
    numbers = numbers.reshape(2, len(windows))
    values = np.stack([root @ end * np.sqrt(variances) for end in by_pose_noise(windows)])
    axes = np.arange(3)
    rows = 3 * np.arange(len(windows))[:, None, None] + axes[:, None]
    columns = 3 * numbers[..., None, None] + axes
    rows, columns = (np.broadcast_to(places, values.shape) for places in (rows, columns))
    return csr_array(
        (values.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * len(windows), 3 * len(poses))
    )
