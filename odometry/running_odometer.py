"""The odometer of a filter as it drives: the poses that `Replay.odometer` has afterwards."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimates import Replay
from odometry.estimation.estimate import Estimate
from odometry.geometry import se2
from odometry.geometry.angles import wrap


class RunningOdometer:
    """Integrates the twists that a filter held, never corrected by a pose.

    Parameters
    ----------
    estimate : Estimate
        The first; the odometer starts at its pose.
    """

    def __init__(self, estimate: Estimate) -> None:
        self._held = estimate
        self._start = estimate.mean[:3]
        self._moved = np.zeros(3)  # x, y [m], yaw [rad] since the start, yaw not wrapped

    @property
    def pose(self) -> FloatArray:
        """x, y [m], yaw [rad] (3,) at the latest estimate."""
        x, y, yaw = self._start + self._moved
        return np.array([x, y, wrap(yaw)])

    def step(self, estimate: Estimate) -> FloatArray:
        """Go on to the next estimate, and give the pose (3,) there."""
        twist = Replay((self._held, estimate)).odometer_twists()[0]
        step = se2.exp(twist * (estimate.stamp_s - self._held.stamp_s))
        yaw = self._start[2] + self._moved[2]
        cosine, sine = np.cos(yaw), np.sin(yaw)
        along_x = cosine * step[0] - sine * step[1]
        along_y = sine * step[0] + cosine * step[1]
        self._moved = self._moved + np.array([along_x, along_y, step[2]])
        self._held = estimate
        return self.pose
