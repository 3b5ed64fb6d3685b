"""Error of the calibrations."""

from terrain.errors import CameraError


class CalibrationError(CameraError):
    """What was given cannot tell the lens or the mount."""
