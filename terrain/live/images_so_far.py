"""Images of a live run that got no name of a terrain, and why, and those that did not come."""

import math
from collections import Counter

import numpy as np

from odometry.recording.frames import Frame
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import colourless_note
from terrain.image_labels.image_label import ASTRIDE, ImageLabel
from terrain.image_labels.image_labeller import OTHER_SIZE

ENOUGH = 20  # images, before a lack of names is said
MOST_REASONS = 3
# Of wheel travel without an image. Cameras that take one for each metre or more have as long a way
# between all of them
LEAST_M, TIMES = 5.0, 5.0


class ImagesSoFar:
    """Counts images, those without a name by their reason, and the way without one.

    Parameters
    ----------
    image_size : (width, height) or None
        None where no images are wanted.
    """

    def __init__(self, image_size: tuple[int, int] | None) -> None:
        self._size = image_size
        self._count = self._came = 0
        self._unnamed = Counter[str]()
        self._before: Frame | None = None
        self._way_m = self._since_m = 0.0
        self._latest_s = math.nan

    def drive(self, frame: Frame) -> None:
        """Take in how far the treads rolled, and whether an image came."""
        if self._before is not None:
            speeds_m_s = self._before.tread_speeds_m_s
            way_m = float(np.abs(speeds_m_s).mean()) * (frame.stamp_s - self._before.stamp_s)
            if math.isfinite(way_m):
                self._since_m += way_m
        if frame.image is not None:
            self._way_m += self._since_m
            self._came += 1
            self._since_m, self._latest_s = 0.0, frame.stamp_s
        self._before = frame

    def add(self, seen: ImageLabel) -> None:
        """Take in the label of an image."""
        self._count += 1
        if seen.label in ("", UNKNOWN):
            reason = seen.reason or "unlike any training patch"
            self._unnamed["astride two terrains" if reason.startswith(ASTRIDE) else reason] += 1

    def notes(self) -> list[str]:
        """What is to be said of them."""
        if self._size is None:
            return []
        width, height = self._size
        found = self._missing()
        if odd := self._unnamed[OTHER_SIZE]:
            found.append(
                f"{odd} image(s) are not of the camera's size, {width} x {height} pixels, and have "
                "no label: see image_size of [camera]"
            )
        if grey := colourless_note(self._unnamed, self._count):
            found.append(grey)
        if not found and self._count == self._unnamed.total() >= ENOUGH:
            most = self._unnamed.most_common(MOST_REASONS)
            words = ", ".join(f"{reason} ({count})" for reason, count in most)
            found.append(f"no image of {self._count} so far has the name of a terrain: {words}")
        return found

    def _missing(self) -> list[str]:
        """That no image came for long while the robot drove."""
        if self._since_m < max(LEAST_M, TIMES * self._way_m / max(self._came, 1)):
            return []
        last = f" (the last one at {self._latest_s:.2f} s)" if self._came else ""
        return [
            f"no image came for the last {self._since_m:.0f} m of wheel travel{last}: the camera "
            "stands still or another topic is heard, or images come later than LiveFrames waits "
            "for them (its notes say so). The terrain in force is old, and ends as unknown"
        ]
