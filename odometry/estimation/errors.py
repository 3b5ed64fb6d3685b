"""What a filter, or a bank of filters, refuses."""

from odometry.errors import OdometryError


class EstimationError(OdometryError):
    """A belief, a chain of modes or a filter is not as it must be."""
