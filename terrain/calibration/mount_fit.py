"""A mount with its intervals, from any source."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray

NAMES = ("x", "y", "z", "roll", "pitch", "yaw")
WIDEST_M, WIDEST_RAD = 0.1, float(np.radians(2.0))  # a wider half interval is of no use


@dataclass(frozen=True, eq=False)
class MountFit:
    """Place and attitude of a camera, and how well they are determined.

    Attributes
    ----------
    mount : (6,)
        x, y, z [m], roll, pitch, yaw [rad], as in `[camera]`.
    half_interval : (6,)
        Half of the 95 % interval; NaN of a value that was given, not estimated.
    errors_px : (N,)
        Distance in the image of each point from where the mount puts it.
    notes : tuple of str
        What to know of it.
    contradiction : str
        Which point contradicts the others, "" where none does: the mount is not to be used.
    limit_px : float
        A point farther off does not agree, and counts no more.
    """

    mount: FloatArray
    half_interval: FloatArray
    errors_px: FloatArray
    notes: tuple[str, ...] = ()
    contradiction: str = ""
    limit_px: float = np.inf

    @property
    def agrees(self) -> BoolArray:
        """Which points (N,) agree with the mount."""
        return np.asarray(self.errors_px < self.limit_px)

    @property
    def rms_px(self) -> float:
        """Root mean square of the errors of points that agree."""
        return float(np.sqrt(np.mean(self.errors_px[self.agrees] ** 2)))


def too_wide(half_interval: FloatArray) -> BoolArray:
    """Values (6,) of a mount whose interval is too wide to be of use."""
    widest = np.array([WIDEST_M] * 3 + [WIDEST_RAD] * 3)
    return np.asarray(~(half_interval <= widest))
