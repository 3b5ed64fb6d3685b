"""Errors of the gap workflow."""

from odometry.errors import OdometryError


class GapError(OdometryError):
    """Runs or settings from which no gap can be found."""
