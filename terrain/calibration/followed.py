"""Features followed from one image to another (Lucas and Kanade 1981, in pyramids)."""

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray

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
