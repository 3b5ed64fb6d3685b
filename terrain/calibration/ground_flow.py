"""How the terrain flows through the image of a camera that is carried over it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from terrain.calibration.tracks import Tracks
from terrain.calibration.warp import carried_rays

# Standard deviations of the odometer's steps: shares of the way (x, y) and of the turn
ALONG, ASIDE, ASIDE_PER_RAD_M, TURN_RAD, TURN = 0.02, 0.02, 0.05, 0.003, 0.05
LOST = 1e6  # squared scales by which a ray that meets no terrain counts as off


@dataclass(frozen=True, eq=False)
class GroundFlow:
    """Tracked features, and what they should do under a mount.

    Attributes
    ----------
    tracks : Tracks
    place_m : (2,)
        x and y of the mount.
    focus_px : float
    """

    tracks: Tracks
    place_m: FloatArray
    focus_px: float

    def residuals(self, values: FloatArray, steps: FloatArray) -> FloatArray:
        """Where the second images show the features, less where they should.

        Parameters
        ----------
        values : (4,)
            z [m], roll, pitch, yaw [rad] of the mount.
        steps : (P, 3)
            Motion of the robot in each pair.

        Returns
        -------
        (N, 2)
            In pixels near the axis; NaN for rays that do not meet the terrain.
        """
        tracks = self.tracks
        after = carried_rays(tracks.before, values, self.place_m, steps[tracks.pair])
        return np.asarray((after - tracks.after) * self.focus_px)

    def cost(self, values: FloatArray, motions: FloatArray, feature_px: float) -> float:
        """Cauchy's loss of the residuals, and the squares of what was added to the steps (P, 3)."""
        residuals = self.residuals(values, self.tracks.steps + motions)
        squares = (residuals**2).sum(axis=1) / feature_px**2
        loss = np.log1p(np.nan_to_num(squares, nan=LOST))
        return float(loss.sum() + ((motions / self.step_sigmas) ** 2).sum())

    @cached_property
    def step_sigmas(self) -> FloatArray:
        """Standard deviations (P, 3) of the odometer's steps."""
        steps = self.tracks.steps
        length_m, turn_rad = np.linalg.norm(steps[:, :2], axis=1), np.abs(steps[:, 2])
        aside_m = ASIDE * length_m + ASIDE_PER_RAD_M * turn_rad
        return np.column_stack([ALONG * length_m, aside_m, TURN_RAD + TURN * turn_rad])
