"""Factors on the stated noise of slip and of poses, estimated from the innovations."""

import math
from typing import NamedTuple

from odometry.arrays import FloatArray

SLIP_LOGS = (-3.0, 6.0)  # least and largest logarithm of a scale of variance
POSE_LOGS = (-3.0, 6.0)
MOST_SQUARED = 4.0  # normalised innovation squared for each entry: more counts no more
SHARE_OF_CORRELATION = 0.5


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
