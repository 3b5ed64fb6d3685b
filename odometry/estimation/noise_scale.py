"""How far treads can be off, and factors on the stated noise found from the innovations."""

import math
from typing import NamedTuple

from odometry.arrays import FloatArray
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.transition import Y_LEFT, Y_RIGHT

SLIP_LOGS = (-3.0, 6.0)  # least and largest logarithm of a scale of variance
POSE_LOGS = (-3.0, 6.0)
MOST_SQUARED = 4.0  # normalised innovation squared for each entry: more counts no more
SHARE_OF_CORRELATION = 0.5

CORRELATED_S = 0.5  # slip stays about the same for so long
STANDING_RAD_S, BY_SPEED, BY_TURN = 0.02, 0.05, 0.1  # sigma at rest, by speed over width, by turn
HUBER_SQUARED = 4.0  # two standard deviations of a yaw rate of the treads


class NoiseScale(NamedTuple):
    """Scales of the variances of slip and of measured poses.

    Attributes
    ----------
    slip_log, pose_log : float
        Natural logarithms of the scales.
    weighed : (3,) or None
        The last innovation of a full pose times the inverse of its covariance, shortened like
        an innovation of `MOST_SQUARED`.
    """

    slip_log: float = 0.0
    pose_log: float = 0.0
    weighed: FloatArray | None = None

    @property
    def slip(self) -> float:
        """Factor on the variance of slip."""
        return math.exp(self.slip_log)

    @property
    def pose(self) -> float:
        """Factor on the variance of measured poses."""
        return math.exp(self.pose_log)


def adapted(
    scale: NoiseScale, residual: FloatArray, weighed: FloatArray, squared: float, rate: float
) -> NoiseScale:
    """The scales after one more innovation.

    Innovations of a well-tuned filter are white and as large as it thinks. Larger ones call for
    more of both noises; ones that resemble those before them call for more slip and less pose
    noise, ones that alternate for the reverse (Mehra 1970, IEEE Transactions on Automatic
    Control 15(2): correlations of innovations distinguish the two).

    Parameters
    ----------
    scale : NoiseScale
    residual, weighed : (m,), (m,)
        The innovation, and the inverse of its covariance times it.
    squared : float
        Its normalised square.
    rate : float
        By which share of itself a scale may change.
    """
    size = len(residual)
    limit = MOST_SQUARED * size
    shortened = residual
    if squared > limit:
        factor = math.sqrt(limit / squared)
        weighed, shortened = weighed * factor, residual * factor
    excess = min(squared, limit) / size - 1.0
    likeness = 0.0
    if scale.weighed is not None and len(scale.weighed) == size:
        likeness = SHARE_OF_CORRELATION * float(shortened.dot(scale.weighed)) / size
        likeness = _within(likeness, (-1.0, 1.0))
    return NoiseScale(
        _within(scale.slip_log + rate * (excess + likeness), SLIP_LOGS),
        _within(scale.pose_log + rate * (excess - likeness), POSE_LOGS),
        weighed,
    )


def _within(value: float, bounds: tuple[float, float]) -> float:
    least, most = bounds
    return least if value < least else most if value > most else value


def tread_variance(
    tread_speeds: FloatArray, yaw_rate: float, track_width: float, slip_scale: float, step_s: float
) -> float:
    """Variance of the treads' yaw rate over a step [rad^2/s^2], of tread speeds (2,) [m/s].

    Slip is correlated over `CORRELATED_S`: shorter steps count less each, so that the result does
    not depend on how finely time is cut.
    """
    left, right = tread_speeds.tolist()
    by_speed = BY_SPEED * (abs(left) + abs(right)) / 2 / track_width
    variance = STANDING_RAD_S**2 + slip_scale * by_speed**2 + (BY_TURN * yaw_rate) ** 2
    return float(variance * CORRELATED_S / step_s)


def width_sigma_m(covariance: FloatArray) -> float:
    """Standard deviation of y_left - y_right, by the covariance (9, 9) of the state."""
    of_sides = covariance[Y_LEFT, Y_LEFT] + covariance[Y_RIGHT, Y_RIGHT]
    return math.sqrt(max(float(of_sides - 2 * covariance[Y_LEFT, Y_RIGHT]), 0.0))


def huber_factor(residual: float, variance: float) -> float:
    """Factor on the noise of a number of this variance: above 1 beyond two standard deviations."""
    squared = residual**2 / variance if variance > 0 else 0.0
    return max(1.0, squared / HUBER_SQUARED)


def velocity_variances(
    config: IcrEkfConfig,
    tread_speeds: FloatArray,
    *,
    track_width: float,
    slip_scale: float,
    step_s: float,
    yaw_rate: float,
) -> tuple[float, float, float]:
    """Variances of measured v_x, v_y [m^2/s^2], omega [rad^2/s^2] against treads and gyroscope.

    That of the sensor, and what slip adds to the step before it, at tread speeds (2,) [m/s]. Where
    the yaw rate is NaN, the treads turn the robot.
    """
    left, right = tread_speeds.tolist()
    slip = config.slip_noise**2 * slip_scale * (abs(left) + abs(right)) / 2
    of_position = (slip + config.position_noise**2) / step_s
    of_turn = slip / track_width**2 + config.yaw_noise**2
    of_yaw = config.gyro_noise**2 if not math.isnan(yaw_rate) else of_turn
    of_velocity = config.velocity_sigma_m_s**2 + of_position
    return of_velocity, of_velocity, config.yaw_rate_sigma_rad_s**2 + of_yaw / step_s
