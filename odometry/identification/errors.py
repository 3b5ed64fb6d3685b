"""What an identification raises."""

from odometry.errors import OdometryError


class IdentificationError(OdometryError):
    """Runs that do not tell what is asked of them."""
