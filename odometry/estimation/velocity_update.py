"""What a measured velocity changes: it is compared with treads and gyroscope."""

import math
from dataclasses import dataclass

import numpy as np

from odometry.estimation.bounds import bounded
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.estimate import Estimate
from odometry.estimation.kalman import updated
from odometry.estimation.measurement import Gaussian, velocity_measurement
from odometry.estimation.transition import YAW
from odometry.estimation.tread_noise import velocity_variances
from odometry.frames import Frame


@dataclass(frozen=True)
class VelocityUpdate:
    """Takes measured velocities in.

    Attributes
    ----------
    config : IcrEkfConfig
    track_width : float
        [m]
    """

    config: IcrEkfConfig
    track_width: float

    def seen(self, belief: Gaussian, estimate: Estimate, frame: Frame, yaw_rate: float) -> Gaussian:
        """Mean (9,) and covariance (9, 9) after a frame's velocity, against the speeds before it.

        Parameters
        ----------
        belief : (9,), (9, 9)
            Predicted for the frame's stamp.
        estimate : Estimate
            The one before, whose tread speeds led to the frame.
        frame : Frame
        yaw_rate : float
            Of the gyroscope since then [rad/s]; NaN where the treads turn the robot.
        """
        speeds, step_s = estimate.tread_speeds_m_s, frame.stamp_s - estimate.stamp_s
        known = step_s > 0 and not frame.in_gap and not math.isnan(speeds[0] + speeds[1])
        if frame.velocity is None or not known:
            return belief
        variances = velocity_variances(
            self.config,
            speeds,
            track_width=self.track_width,
            slip_scale=estimate.scale.slip,
            step_s=step_s,
            yaw_rate=yaw_rate,
        )
        measured = velocity_measurement(
            belief[0],
            frame.velocity - estimate.added_twist,
            speeds + estimate.added_speeds_m_s,
            yaw_rate - float(estimate.added_twist[YAW]),
            np.diag(variances),
        )
        if not len(measured.residual):
            return belief
        after = updated(belief, measured)
        return bounded(after.mean, after.covariance, self.track_width)
