"""Images of a live run that got no name of a terrain, and why."""

from collections import Counter

from odometry.run import UNKNOWN
from terrain.classification.answer import colourless_note
from terrain.image_labels.image_label import ASTRIDE, ImageLabel
from terrain.image_labels.image_labeller import OTHER_SIZE

ENOUGH = 20  # images, before a lack of names is said
MOST_REASONS = 3


class ImagesSoFar:
    """Counts images, and those without a name by their reason."""

    def __init__(self, image_size: tuple[int, int]) -> None:
        self._size = image_size
        self._count = 0
        self._unnamed = Counter[str]()

    def add(self, seen: ImageLabel) -> None:
        """Take in the label of an image."""
        self._count += 1
        if seen.label in ("", UNKNOWN):
            reason = seen.reason or "unlike any training patch"
            self._unnamed["astride two terrains" if reason.startswith(ASTRIDE) else reason] += 1

    def notes(self) -> list[str]:
        """What is to be said of them."""
        width, height = self._size
        found = []
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
