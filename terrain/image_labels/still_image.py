"""Whether what a camera shows stays in its place, though the terrain must have moved through it."""

from dataclasses import dataclass

import cv2
import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.geometry import se2
from terrain.camera.camera import Camera
from terrain.image_labels.carried_image import (
    carried_back,
    details_between,
    middles,
    pixels_after,
    places_of_squares,
    tiles,
)
from terrain.images import to_grey

WIDTH_PX = 160  # of the images that are compared: noise and compression are averaged away
FLOW_PX = 4.0  # of the terrain, at least: by then the details are elsewhere
TILE_PX = 16
FEWEST_TILES = 16  # with such flow, of 70: eleven were alike by chance once, on soft soil
# Correlation in one place of nearly all tiles: frozen images have 0.8 (0.98 but for much noise),
# moving terrain 0.6 at most (soft soil after 4 px), behind a dirty lens 0.2
STAYS, NEARLY_ALL = 0.7, 0.9
SURELY = 0.9  # of it, where the terrain has left the image, so that stripes cannot be excluded
AS_WELL = 0.5  # of that correlation, in the place where terrain moved to


def details_of(image: AnyArray) -> FloatArray:
    """Details (h, WIDTH_PX) of an image (H, W) or (H, W, 3), reduced."""
    height = max(1, round(image.shape[0] * WIDTH_PX / image.shape[1]))
    small = cv2.resize(to_grey(image), (WIDTH_PX, height), interpolation=cv2.INTER_AREA)
    return np.asarray(details_between(small), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class StillImage:
    """Compares images of one camera.

    Attributes
    ----------
    camera : Camera
    """

    camera: Camera

    def stays(self, before: FloatArray, after: FloatArray, step: FloatArray) -> bool | None:
        """Whether two images by `details_of` show the same in the same place.

        Judged where the terrain is: what the image shows of the robot itself, and above the
        horizon, may stay.

        Parameters
        ----------
        before, after : (h, WIDTH_PX)
        step : (3,)
            x, y [m], yaw [rad] of the second robot frame in the first, by treads and gyroscope.

        Returns
        -------
        bool or None
            None where the terrain need not have moved by FLOW_PX. False as well where the images
            agree in the place where terrain moved to: stripes along the way look alike in both.
        """
        here = middles(before.shape, TILE_PX)
        places = places_of_squares(self.camera, before.shape, TILE_PX)
        there = pixels_after(self.camera, WIDTH_PX, step, places)
        moves = np.linalg.norm(there - here, axis=1) > FLOW_PX
        if before.shape != after.shape or np.count_nonzero(moves) < FEWEST_TILES:
            return None
        first, second = tiles(before, TILE_PX), tiles(after, TILE_PX)
        in_place = _alike(first[moves], second[moves])
        if in_place < STAYS:
            return False
        moved, in_block, known = carried_back(self.camera, after, step, TILE_PX)
        whole = moves[in_block] & known
        if np.count_nonzero(whole) < FEWEST_TILES:
            return in_place > SURELY
        first, second = first[in_block][whole], second[in_block][whole]
        return _alike(first, tiles(moved, TILE_PX)[whole]) < AS_WELL * _alike(first, second)


class StillWatch:
    """Follows the images of a camera, and says from when on they stay the same.

    Parameters
    ----------
    camera : Camera
    """

    def __init__(self, camera: Camera) -> None:
        self._still = StillImage(camera)
        self._before: tuple[FloatArray, FloatArray] | None = None
        self._stays = False

    def stays(self, image: AnyArray, pose: FloatArray) -> bool:
        """Whether an image is as one before, though the robot moved, by its poses (3,).

        The answer holds until the robot has moved enough for another one.
        """
        details = details_of(image)
        if self._before is not None:
            earlier, was = self._before
            answer = self._still.stays(earlier, details, se2.between(was, pose))
            if answer is None and earlier.shape == details.shape:
                return self._stays
            self._stays = bool(answer)
        self._before = details, pose
        return self._stays


def _alike(one: AnyArray, other: AnyArray) -> float:
    """Correlation that nearly all tiles (K, pixels) of two images have."""
    first, second = (tiles - tiles.mean(axis=1, keepdims=True) for tiles in (one, other))
    sizes = np.sqrt(_products(first, first) * _products(second, second))
    alike = np.sort(_products(first, second) / np.maximum(sizes, 1e-9))
    return float(np.interp((1 - NEARLY_ALL) * (len(alike) - 1), np.arange(len(alike)), alike))


def _products(one: AnyArray, other: AnyArray) -> FloatArray:
    return np.asarray(np.einsum("kp,kp->k", one, other))
