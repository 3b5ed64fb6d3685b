"""Variance that unmodelled motion adds to the state over a step."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.estimate import ALPHAS, ICRS
from odometry.estimation.transition import GYRO_BIAS, STATES, YAW, X, Y

GAP_DENSITY = 25.0, 9.0  # [m^2/s], [rad^2/s]: while speeds are not known, all may happen


class ProcessNoise:
    """Covariance that a step adds to the state, from the settings of the filter.

    Parameters
    ----------
    config : IcrEkfConfig
    track_width : float
        [m]
    """

    def __init__(self, config: IcrEkfConfig, track_width: float) -> None:
        self._position = config.position_noise**2
        self._yaw = config.yaw_noise**2
        self._slip = config.slip_noise**2
        self._yaw_by_slip = self._slip / track_width**2
        self._gyro = config.gyro_noise**2
        alpha_noise = config.alpha_noise if config.reset_sigma_alpha > 0 else 0.0
        density = np.zeros(STATES)
        density[ICRS] = (config.icr_noise_widths * track_width) ** 2
        density[ALPHAS] = alpha_noise**2
        if config.use_gyroscope:
            density[GYRO_BIAS] = config.bias_noise**2
        self._density = np.diag(density)

    def over_half(
        self,
        tread_speeds: FloatArray,
        step_s: float,
        *,
        slip_scale: float,
        by_gyroscope: bool,
        in_gap: bool,
        bias_walk: float = 1.0,
    ) -> FloatArray:
        """Covariance (9, 9) that half of a step adds: L Q L^T of Chen 2023 eq. 7 and 11.

        Parameters
        ----------
        tread_speeds : (2,)
            [m/s]; slip grows with the distance that they make.
        step_s : float
        slip_scale : float
            Factor on the variance of slip.
        by_gyroscope, in_gap : bool
            Whether the gyroscope turns the robot, and whether the tread speeds are not known.
        bias_walk : float
            Factor on the noise of the random walk of the gyroscope's bias.
        """
        left, right = tread_speeds.tolist()
        travel_per_s = (abs(left) + abs(right)) / 2 * slip_scale
        position = self._position + self._slip * travel_per_s
        yaw = self._gyro if by_gyroscope else self._yaw + self._yaw_by_slip * travel_per_s
        if in_gap:
            position += GAP_DENSITY[0]
            yaw += 0.0 if by_gyroscope else GAP_DENSITY[1]
        half_s = step_s / 2
        covariance = self._density * half_s
        covariance[X, X] = covariance[Y, Y] = position * half_s
        covariance[YAW, YAW] = yaw * half_s
        if bias_walk != 1.0:
            covariance[GYRO_BIAS, GYRO_BIAS] *= bias_walk**2
        return covariance
