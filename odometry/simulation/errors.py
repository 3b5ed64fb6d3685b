"""The error of simulated drives."""

from odometry.errors import OdometryError


class SimulationError(OdometryError):
    """A drive cannot be simulated from what was given."""
