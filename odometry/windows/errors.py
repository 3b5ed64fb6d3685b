"""What cutting a recording into windows raises."""

from odometry.errors import OdometryError


class WindowError(OdometryError):
    """A recording that cannot be cut into the required windows."""
