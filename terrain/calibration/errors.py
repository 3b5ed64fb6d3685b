"""Error of the calibrations."""

from terrain.errors import CameraError


class CalibrationError(CameraError):
    """The input does not determine the lens or the mount."""
