"""Estimates at every frame of a run, and the trajectories that follow from them."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.dead_reckoning import dead_reckon
from odometry.estimation.estimate import Estimate
from odometry.models.icr import icr_twist
from odometry.trajectory import Trajectory


@dataclass(frozen=True)
class Replay:
    """Estimates at every frame of a run, as they were when the frame came in.

    Attributes
    ----------
    estimates : tuple of Estimate
    """

    estimates: tuple[Estimate, ...]

    @property
    def stamps_s(self) -> FloatArray:
        """Stamps (N,)."""
        return np.array([estimate.stamp_s for estimate in self.estimates])

    @property
    def means(self) -> FloatArray:
        """States (N, 6)."""
        return np.stack([estimate.mean for estimate in self.estimates])

    @property
    def sigmas(self) -> FloatArray:
        """Standard deviations (N, 6)."""
        variances = [np.diag(estimate.covariance) for estimate in self.estimates]
        return np.sqrt(np.maximum(variances, 0.0))

    @property
    def terrains(self) -> tuple[str, ...]:
        """Terrain in force at each frame."""
        return tuple(estimate.terrain for estimate in self.estimates)

    @property
    def jumps(self) -> BoolArray:
        """Where a jump of the ICRs was detected (N,)."""
        return np.array([estimate.jumped for estimate in self.estimates])

    def trajectory(self) -> Trajectory:
        """The filter's poses, corrected by measurements."""
        return Trajectory(self.stamps_s, self.means[:, :3])

    def odometer(self) -> Trajectory:
        """The model integrated open loop with the ICRs held at each moment, never corrected.

        The effects of the parameter set are part of the model.
        """
        return self._reckon(np.stack([estimate.twist for estimate in self.estimates]))

    def differential_drive(self, track_width: float) -> Trajectory:
        """The same integration with an ideal differential drive."""
        icrs = np.array([track_width / 2, -track_width / 2, 0.0])
        speeds = np.stack([estimate.tread_speeds_m_s for estimate in self.estimates])
        return self._reckon(icr_twist(icrs, np.nan_to_num(speeds)))

    def _reckon(self, twists: FloatArray) -> Trajectory:
        return dead_reckon(self.stamps_s, twists, self.means[0, :3])
