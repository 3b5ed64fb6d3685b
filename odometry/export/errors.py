"""The error of this room."""

from odometry.errors import OdometryError


class ExportError(OdometryError):
    """A parameter set or a result does not hold what a format needs."""
