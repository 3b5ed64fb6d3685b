"""What a comparison raises."""

from odometry.errors import OdometryError


class ComparisonError(OdometryError):
    """Runs or models that cannot be compared as asked."""
