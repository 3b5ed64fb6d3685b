"""How far wheel odometry errs on a robot, in the terms of filters that take it in.

What is measured is the error of the motion over windows of h metres of wheel travel. As all of it
may be one constant error, a velocity errs by the error per metre times the speed; as all of it may
be independent from metre to metre, the variance of a pose grows by the square of the error of a
window over h, times the speed, in a second. Each alone explains the errors; which of them it is,
one length of windows does not show.
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.window_errors import WindowErrors


@dataclass(frozen=True)
class Pace:
    """How fast a robot drove: mean wheel speed, and mean size of its yaw rate."""

    wheel_speed_m_s: float
    yaw_rate_rad_s: float


@dataclass(frozen=True)
class MotionErrors:
    """Standard deviations of the error of motions, per metre of wheel travel.

    Attributes
    ----------
    along_m_per_m : float
        Along each axis.
    yaw_rad_per_m : float
    horizon_m : float
        Wheel travel of the windows.
    source : str
        What they were measured on.
    """

    along_m_per_m: float
    yaw_rad_per_m: float
    horizon_m: float
    source: str

    @classmethod
    def of_windows(cls, errors: WindowErrors, horizon_m: float, source: str) -> "MotionErrors":
        """From errors of windows: half of a squared distance belongs to each axis."""
        along, yaw = (
            float(np.mean(np.square(each)))
            for each in (errors.translation_per_m, errors.rotation_per_m)
        )
        return cls(sqrt(along / 2), sqrt(yaw), horizon_m, source)

    @classmethod
    def of_means(
        cls, translation_m_per_m: float, rotation_rad_per_m: float, horizon_m: float, source: str
    ) -> "MotionErrors":
        """From mean errors, as of normal ones: a distance (Rayleigh), and an absolute value."""
        along, yaw = translation_m_per_m / sqrt(pi / 2), rotation_rad_per_m * sqrt(pi / 2)
        return cls(along, yaw, horizon_m, source)

    def twist_variances(self, pace: Pace, left_over_m: tuple[float, float]) -> FloatArray:
        """Variances (3,) of v_x, v_y [m^2/s^2] and omega [rad^2/s^2] at a pace.

        Parameters
        ----------
        pace : Pace
        left_over_m : (2,)
            Of v_x and v_y over the yaw rate, where the odometry has no such term: the middle of
            the ICRs and `x_icr`.
        """
        own = np.array([self.along_m_per_m, self.along_m_per_m, self.yaw_rad_per_m])
        left_over = np.array([*left_over_m, 0.0]) * pace.yaw_rate_rad_s
        return np.asarray((own * pace.wheel_speed_m_s) ** 2 + left_over**2)

    def pose_variances_per_s(self, pace: Pace) -> FloatArray:
        """Growth (3,) of the variances of x, y [m^2/s] and yaw [rad^2/s] at a pace."""
        own = np.array([self.along_m_per_m, self.along_m_per_m, self.yaw_rad_per_m])
        return np.asarray(own**2 * self.horizon_m * pace.wheel_speed_m_s)
