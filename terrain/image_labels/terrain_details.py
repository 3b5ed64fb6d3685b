"""How many details of the same terrain an image shows, compared with the one before it."""

from itertools import pairwise

import cv2
import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.geometry import se2
from terrain.camera.camera import Camera
from terrain.image_labels.carried_image import carried_back, tiles
from terrain.images import to_grey

WIDTH_PX = 320  # of the images that are compared: larger ones are reduced to it
SIZES_PX = (0.7, 1.4, 2.8)  # details of an octave each, in such images
TILE_PX, FEWEST_TILES = 32, 8
LEAST_GREY, LEAST_DETAIL = 5.0, 0.5  # so that darkness and noise do not count
LEAST_SHARE = 0.5  # of the tiles of common terrain: the median of few of them is uncertain
DISTINCT = 1.0  # grey levels of details: tiles with less may show noise alone
# Logarithm of details over light from an image to the next on the same terrain: seven rocking and
# noisy cameras had -0.30 to 0.20, fog of 0.4 of the contrast -0.5 to -2, mist -0.5 to -2.3. Finest
# over coarsest details: these cameras -0.33 to 0.29 (so do fog and another gamma), blur of 2 px of
# 640 -0.3 to -0.9, blur by motion of 9 px -0.5 at the worst
LOSS = float(np.log(0.6))
REGAINED = 2 / 3  # of a loss, from an image to the next: the details are back
APART_M = 0.12  # of travel between images that are compared, at least where none has lost details


def change_of_details(
    camera: Camera, before: AnyArray, after: AnyArray, step: FloatArray
) -> FloatArray | None:
    """How details in one grey image (h, w) have changed in another.

    Parameters
    ----------
    camera : Camera
    before, after : (h, w)
    step : (3,)
        x, y [m], yaw [rad] of the second robot frame in the first.

    Returns
    -------
    (2,) or None
        Logarithms of the changes of details over light, and of the finest over the coarsest ones:
        medians over tiles of terrain that both show, and of which one shows details. None where
        these are too few.
    """
    if before.shape != after.shape:
        return None
    moved, known = carried_back(camera, after, step)
    common = tiles(known, TILE_PX).min(axis=1) > 0
    if np.count_nonzero(common) < FEWEST_TILES:
        return None
    (here, light), (there, other_light) = map(_details_and_light, (before, moved))
    levels = np.maximum(here.mean(axis=0), there.mean(axis=0))
    compared = common & (levels > np.log(DISTINCT))
    fewest = max(FEWEST_TILES, LEAST_SHARE * np.count_nonzero(common))
    if np.count_nonzero(compared) < fewest:
        return None
    more = (there - here)[:, compared]
    over_light = more.mean(axis=0) - (other_light - light)[compared]
    return np.asarray(np.median([over_light, more[0] - more[-1]], axis=1))


def details_of_tiles(image: AnyArray) -> FloatArray:
    """Logarithm of details over light (K,) of each tile of a grey image (h, w)."""
    details, light = _details_and_light(image)
    return np.asarray(details.mean(axis=0) - light)


def _details_and_light(image: AnyArray) -> tuple[FloatArray, FloatArray]:
    """Logarithms of the details of each tile (3, K), finest octave first, and of its light (K,)."""
    values = image.astype(np.float32)
    levels = [values, *(cv2.GaussianBlur(values, (0, 0), size) for size in SIZES_PX)]
    octaves = [
        0.5 * np.log(tiles((fine - coarse) ** 2, TILE_PX).mean(axis=1) + LEAST_DETAIL**2)
        for fine, coarse in pairwise(levels)
    ]
    light = np.log(tiles(values, TILE_PX).mean(axis=1) + LEAST_GREY)
    return np.array(octaves), np.asarray(light)


class DetailsWatch:
    """Follows the images of a camera, and says from when to when they lack details.

    An image is compared with one that was taken shortly before, and only where both show the same
    terrain: smooth terrain has lost nothing.

    Parameters
    ----------
    camera : Camera
    """

    def __init__(self, camera: Camera) -> None:
        self._camera = camera
        self._before: tuple[AnyArray, FloatArray] | None = None
        self._lost: tuple[int, float] | None = None  # details or the finest of them, and how many

    def has_lost(self, image: AnyArray, pose: FloatArray) -> bool:
        """Whether an image (H, W) or (H, W, 3) lacks details that one before it showed.

        The answer holds until the details of the same terrain are back: where two images have no
        terrain in common, it cannot be determined anew. Poses (3,) are of the robot.
        """
        reduced = _reduced(image)
        if self._before is None:
            self._before = reduced, pose
            return False
        earlier, was = self._before
        step = se2.between(was, pose)
        change = change_of_details(self._camera, earlier, reduced, step)
        lost = self._lost_after(change)
        is_new = (lost is None) != (self._lost is None)
        if change is None or is_new or float(np.hypot(*step[:2])) > APART_M:
            self._before = reduced, pose
        self._lost = lost
        return lost is not None

    def _lost_after(self, change: FloatArray | None) -> tuple[int, float] | None:
        """What is lost after a change: which of the two kinds, and its logarithm."""
        if change is None:
            return self._lost
        if self._lost is None:
            kind = int(change.argmin())
            return (kind, float(change[kind])) if change[kind] < LOSS else None
        kind, loss = self._lost
        return None if change[kind] > -REGAINED * loss else self._lost


def _reduced(image: AnyArray) -> AnyArray:
    """An image in grey, at most WIDTH_PX wide."""
    grey = to_grey(image)
    if grey.shape[1] <= WIDTH_PX:
        return grey
    height = max(1, round(grey.shape[0] * WIDTH_PX / grey.shape[1]))
    return np.asarray(cv2.resize(grey, (WIDTH_PX, height), interpolation=cv2.INTER_AREA))
