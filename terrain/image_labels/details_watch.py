"""From when to when the images of a camera lack details of the terrain that they showed before."""

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.geometry import se2
from terrain.camera.camera import Camera
from terrain.image_labels.slow_return import SlowReturn
from terrain.image_labels.terrain_details import (
    LOSS,
    TileDetails,
    change_of_details,
    may_have_lost,
)

LOSSES = (LOSS, float(np.log(0.65)))  # of contrast, and of focus of one image at once
REGAINED = 2 / 3  # of a loss: the details are back
APART_M = 0.12  # of travel between images that are compared, at least where none has lost details
NEAR_M = 0.4  # of travel from the last image before a loss: farther on terrain looks finer, nearer


class DetailsWatch:
    """Follows the images of a camera, and says from when to when they lack details.

    An image is compared with one that was taken shortly before, and only where both show the same
    terrain: smooth terrain has lost nothing. The last image before a loss is kept while the robot
    is near, so that details may come back over some images there; farther on, by `SlowReturn`.
    Once that knows how clear images change, they are compared where they show less in place.

    Parameters
    ----------
    camera : Camera
    """

    def __init__(self, camera: Camera) -> None:
        self._camera = camera
        self._before: tuple[TileDetails, FloatArray] | None = None
        self._is_clear = True  # the image before; not so where it lacks details as well
        self._lost: tuple[int, FloatArray] | None = None  # contrast or focus, and the change
        self._slow = SlowReturn()

    def has_lost(self, image: AnyArray, pose: FloatArray) -> bool:
        """Whether an image (h, w), `reduced`, lacks details that one before it showed.

        The answer holds until the details of the same terrain are back: where two images have no
        terrain in common, it cannot be determined anew. Poses (3,) are of the robot.
        """
        details = TileDetails.of(image)
        if self._before is None:
            self._before = details, pose
            self._slow.add_clear(details, None, 0.0)
            return False
        earlier, was = self._before
        step = se2.between(was, pose)
        compared = self._is_compared(earlier, details)
        change = change_of_details(self._camera, earlier, image, step) if compared else None
        had_lost, self._lost = self._lost is not None, self._lost_after(change)
        has_lost = self._lost is not None
        kept_m = NEAR_M if has_lost and self._is_clear else APART_M
        is_apart = float(np.hypot(*step[:2])) > kept_m
        if is_apart or has_lost < had_lost or (compared and change is None):
            self._follow(details, None if had_lost > has_lost else change, float(step[0]))
            self._before, self._is_clear = (details, pose), self._lost is None
        return self._lost is not None

    def _is_compared(self, before: TileDetails, after: TileDetails) -> bool:
        """Whether the same terrain has to be compared in two images; of clear ones seldom."""
        is_usual = self._lost is None and self._slow.knows_clear
        return not is_usual or may_have_lost(self._camera, before, after)

    def _follow(self, details: TileDetails, change: FloatArray | None, ahead_m: float) -> None:
        """Follow an image that the next ones are compared with, after a change since the last."""
        contrast = None if change is None else float(change[0])
        if self._lost is None:
            self._slow.add_clear(details, contrast, ahead_m)
        elif self._is_clear:
            self._slow.begin(details, float(self._lost[1][0]) if contrast is None else contrast)
        elif self._slow.is_back(details, contrast, ahead_m):
            self._lost = None

    def _lost_after(self, change: FloatArray | None) -> tuple[int, FloatArray] | None:
        """What is lost after a change: which of the two kinds, and the change (2,) by which."""
        if change is None:
            return self._lost
        if self._lost is None:
            kind = int((change / LOSSES).argmax())
            return (kind, change) if change[kind] < LOSSES[kind] else None
        kind, by = self._lost
        regained = change[kind] - (by[kind] if self._is_clear else 0.0)
        return None if regained > -REGAINED * by[kind] else self._lost
