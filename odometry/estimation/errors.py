"""What a filter, or a bank of filters, refuses."""

from odometry.errors import OdometryError


class EstimationError(OdometryError):
    """An estimate, a chain of modes or a filter is invalid."""
