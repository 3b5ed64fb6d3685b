"""What a reference sensor reported: poses with their stamps, of one run."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray


@dataclass(frozen=True)
class Reported:
    """Poses of one run as the reference reported them.

    Attributes
    ----------
    stamps_s : (M,)
        In run time.
    poses : (M, 3)
        x, y [m], yaw [rad]; yaw need not be wrapped.
    run : int or None
        Number of the run among those that effects were fitted to, and those after them that they
        are judged by; None: another, of which nothing that is a run's own is known.
    """

    stamps_s: FloatArray
    poses: FloatArray
    run: int | None = None

    @property
    def yaw_rad(self) -> FloatArray:
        """Yaw (M,)."""
        return np.asarray(self.poses[:, 2])

    def of(self, poses: FloatArray) -> "Reported":
        """The same with other poses (M, 3)."""
        return replace(self, poses=poses)
