"""The second image of a pair as it would look from where the first was taken, over terrain."""

from dataclasses import dataclass

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.calibration.carried import carried_rays
from terrain.calibration.followed import window_px
from terrain.camera_files.calibration import Lens

CELL_PX = 8  # the map is worked out at every so many pixels, and linear between
OUTSIDE_PX = -1e4


@dataclass(frozen=True, eq=False)
class Warp:
    """How a step of the robot moves the terrain through the image.

    Attributes
    ----------
    lens : Lens
    mount : (6,)
    step : (3,)
        x, y [m], yaw [rad].
    """

    lens: Lens
    mount: FloatArray
    step: FloatArray

    def rays(self, rays: FloatArray) -> FloatArray:
        """Rays (N, 2) of the first image in the second one; NaN where they meet no terrain."""
        return carried_rays(rays, self.mount[2:], self.mount[:2], self.step)

    def image(self, first: ByteImage, second: ByteImage) -> tuple[ByteImage, ByteImage]:
        """Second image (H, W), warped, and where (H, W) it can be compared with the first: not 0.

        Where the second image does not show what the first does, it is filled with the first, so
        that there are no edges of black.
        """
        height, width = second.shape
        u, v = self._map(width, height)
        warped = cv2.remap(second, u, v, cv2.INTER_LINEAR)
        seen = (u >= 0) & (u <= width - 1) & (v >= 0) & (v <= height - 1)
        filled = np.where(seen, warped, first).astype(np.uint8)
        side = window_px(width)
        inner = cv2.erode(seen.astype(np.uint8), np.ones((side, side), np.uint8))
        return filled, np.asarray(inner, dtype=np.uint8)

    def _map(self, width: int, height: int) -> tuple[AnyArray, AnyArray]:
        """Pixels u and v (H, W) of the second image for each of the first."""
        columns, rows = -(-width // CELL_PX) + 1, -(-height // CELL_PX) + 1
        u, v = np.meshgrid(CELL_PX * np.arange(columns), CELL_PX * np.arange(rows))
        pixels = np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float64)
        there = self.lens.pixels(self.rays(self.lens.rays(pixels)))
        coarse = np.nan_to_num(there, nan=OUTSIDE_PX).clip(OUTSIDE_PX, -OUTSIDE_PX)
        coarse = coarse.reshape(rows, columns, 2).astype(np.float32)
        at_u, at_v = np.meshgrid(np.arange(width) / CELL_PX, np.arange(height) / CELL_PX)
        fine = cv2.remap(coarse, at_u.astype(np.float32), at_v.astype(np.float32), cv2.INTER_LINEAR)
        return np.asarray(fine[..., 0]), np.asarray(fine[..., 1])
