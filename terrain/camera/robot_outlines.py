"""Parts of the image that show the robot itself: outlines of them, and the pixels within."""

from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np

from odometry.arrays import BoolArray, FloatArray
from terrain.camera.camera_values import finite_array
from terrain.errors import CameraError

FEWEST_CORNERS = 3


def checked_outlines(outlines: Any, image_size: tuple[int, int]) -> tuple[FloatArray, ...]:
    """Polygons (n, 2) in raw pixels, each of three corners or more in the image.

    Raises
    ------
    CameraError
        Naming the outline that is none.
    """
    if not isinstance(outlines, Sequence) or isinstance(outlines, str):
        raise CameraError(
            f"robot_outlines = {outlines!r}, expected polygons [[[u, v], [u, v], [u, v]], ...]"
        )
    return tuple(
        _checked(f"robot_outlines[{place}]", outline, image_size)
        for place, outline in enumerate(outlines)
    )


def _checked(name: str, outline: Any, image_size: tuple[int, int]) -> FloatArray:
    count = len(outline) if isinstance(outline, Sequence) else 0
    if count < FEWEST_CORNERS:
        raise CameraError(f"{name} = {outline!r}, expected at least {FEWEST_CORNERS} pixels [u, v]")
    corners = finite_array(name, outline, (count, 2))
    outside = (corners < -1).any(axis=1) | (corners > image_size).any(axis=1)
    if outside.any():
        raise CameraError(
            f"{name} has the corner {corners[outside][0].tolist()}, which is outside of an image "
            f"of {image_size[0]}x{image_size[1]} pixels"
        )
    return corners


def covered(outlines: Sequence[FloatArray], image_size: tuple[int, int]) -> BoolArray:
    """Pixels (H, W) that any of the outlines has within it or on it."""
    width, height = image_size
    image = np.zeros((height, width), dtype=np.uint8)
    for outline in outlines:
        cv2.fillPoly(image, [np.rint(outline).astype(np.int32)], 1)
    return image > 0
