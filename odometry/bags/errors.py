"""What is raised about bags."""

from odometry.errors import OdometryError


class BagError(OdometryError):
    """A bag, or a map of its topics, cannot be used as it is."""
