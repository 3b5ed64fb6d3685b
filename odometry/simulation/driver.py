"""A driver who weaves along the way, so that every ICR shows itself in the motion."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray


@dataclass(frozen=True)
class WeavingDriver:
    """Steers smooth alternating turns about world +x at a changing speed.

    The driver sees the true pose and corrects the heading as a person would; the correction
    knows nothing of ICRs.

    Attributes
    ----------
    speed_m_s, speed_swing : float
        Mean tread speed, and the relative amplitude of its slow change.
    weave_rad, weave_period_s : float
        Amplitude and period of the desired heading's main swing.
    phases_rad : (float, float, float)
        Phases of the main swing, of a second and faster swing, and of the speed.
    steering_m : float
        Difference of tread speeds the driver gives for a desired yaw rate [m/s per rad/s].
    heading_gain_hz : float
        Yaw rate desired per radian of heading error.
    return_rad_per_m : float
        Heading turned back towards the middle of the way per metre away from it.
    largest_difference_m_s : float
        Limit of the difference of tread speeds.
    start_s : float
        Time taken to reach full speed from rest.
    """

    speed_m_s: float = 0.68
    speed_swing: float = 0.12
    weave_rad: float = 0.35
    weave_period_s: float = 12.0
    phases_rad: tuple[float, float, float] = (0.0, 0.0, 0.0)
    steering_m: float = 0.75
    heading_gain_hz: float = 1.5
    return_rad_per_m: float = 0.15
    largest_difference_m_s: float = 0.6
    start_s: float = 2.0

    def tread_speeds_m_s(self, time_s: float, pose_world: FloatArray) -> FloatArray:
        """Tread speeds (left, right) [m/s] at a time and true pose (x, y, yaw)."""
        main, second, pace = self.phases_rad
        rate = 2 * np.pi / self.weave_period_s
        swing = np.array([self.weave_rad, 0.3 * self.weave_rad])
        rates = np.array([rate, 2.3 * rate])
        angles = rates * time_s + [main, second]
        heading = swing @ np.sin(angles) - self.return_rad_per_m * pose_world[1]
        error = np.arctan2(np.sin(heading - pose_world[2]), np.cos(heading - pose_world[2]))
        yaw_rate = (swing * rates) @ np.cos(angles) + self.heading_gain_hz * error
        difference = np.clip(
            self.steering_m * yaw_rate, -self.largest_difference_m_s, self.largest_difference_m_s
        )
        mean = self.speed_m_s * (1 + self.speed_swing * np.sin(0.4 * rate * time_s + pace))
        start = min(1.0, time_s / self.start_s) if self.start_s > 0 else 1.0
        return np.asarray(start * (mean + difference / 2 * np.array([-1.0, 1.0])))
