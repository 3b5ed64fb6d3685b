"""Features followed between images, and the second image warped to the place of the first."""

from dataclasses import dataclass

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.calibration.carried_rays import carried_rays
from terrain.camera_files.lens_models import Lens

FEATURES = 150
QUALITY = 0.01  # of a corner, relative to the best
APART = 80  # features have this share of the image's width between them
LEVELS = 4
WINDOWS, LEAST_PX, MOST_PX = 30, 9, 31  # of the width; the side of a window
RETURN_PX = 0.5  # a feature followed there and back comes so near to where it was


def window_px(width: int) -> int:
    """Side of the window in which a feature is compared, an odd number, in an image so wide."""
    return 2 * (int(np.clip(width / WINDOWS, LEAST_PX, MOST_PX)) // 2) + 1


def followed(
    first: ByteImage, second: ByteImage, mask: ByteImage | None = None
) -> tuple[FloatArray, FloatArray]:
    """Pixels (N, 2) of features in both grey images, of those that come back where they were.

    Parameters
    ----------
    first, second : (H, W)
    mask : (H, W), optional
        Features are taken where it is not 0.
    """
    width = first.shape[1]
    everywhere = np.ones_like(first) if mask is None else mask
    apart = max(3.0, width / APART)
    found = cv2.goodFeaturesToTrack(first, FEATURES, QUALITY, apart, mask=everywhere)
    if not np.size(found) or np.ndim(found) < 2:  # None where there is none
        return np.empty((0, 2)), np.empty((0, 2))
    start = np.asarray(found, dtype=np.float32).reshape(-1, 1, 2)
    side = window_px(width)
    there, ok_there = _flow(first, second, start, side)
    back, ok_back = _flow(second, first, there, side)
    away = np.linalg.norm((back - start).reshape(-1, 2), axis=1)
    good = (ok_there.ravel() == 1) & (ok_back.ravel() == 1) & (away < RETURN_PX)
    return start.reshape(-1, 2)[good].astype(float), there.reshape(-1, 2)[good].astype(float)


def _flow(
    first: ByteImage, second: ByteImage, points: AnyArray, side: int
) -> tuple[AnyArray, AnyArray]:
    """Where pixels (N, 1, 2), float32, went, and whether (N, 1) they were found."""
    moved, found, _ = cv2.calcOpticalFlowPyrLK(
        first, second, points, points.copy(), winSize=(side, side), maxLevel=LEVELS
    )
    return np.asarray(moved), np.asarray(found)


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
