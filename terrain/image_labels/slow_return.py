"""Whether details that were lost have come back over several metres of terrain."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from terrain.image_labels.terrain_details import DISTINCT, TileDetails

# Limits were chosen on 15 recordings in fog, veils, blur and mist that stay, change or go. Changes
# are logarithms of details, from an image to the next on the same terrain
STEADY_M = 3.0  # of travel on which images change as clear ones do; 2 m err for one camera of 15
# Of change per metre, off that of clear images. Terrain gains as it comes nearer: behind blur or in
# fog that thickens with distance by 0.2 to 1.2 more than in clear air, in even veils -0.1 to 0.1
STEADY_PER_M = 0.05
RISE_M = 4.0  # of travel on which details may rise before: over more the sum of changes drifts
RISEN, LEAST_RISE = 0.8, 0.24  # of the greatest loss of contrast, and at least
ALIKE = 0.2  # details of an image may be lower than those of the last clear ones
ALIKE_M, NOW_M = 3.0, 1.0  # of travel on which these are, and images that are compared with them
CLEAR_M = 2.0  # of travel on clear images, at least, to know how these change
LEARNT_M = 10.0  # ... after which they need not be compared any more
DISTINCT_SHARE = 0.25  # of the tiles: the focus of fewer is uncertain


class SlowReturn:
    """Follows the images of a camera ahead of a robot, clear ones and ones that lack details.

    Details are back where three things agree: they have risen on the same terrain by what was lost,
    terrain gains no more of them on its way through the images than it did in clear ones, and
    images show about as many as the last clear ones, whatever terrain is there.
    """

    def __init__(self) -> None:
        self._clear_m, self._clear_change = 0.0, 0.0
        self._clear: list[_Followed] = []
        self._trail: list[_Followed] = []
        self._first = self._greatest = 0.0

    @property
    def knows_clear(self) -> bool:
        """Whether it has seen enough of how clear images change."""
        return self._clear_m >= LEARNT_M

    def add_clear(self, details: TileDetails, contrast: float | None, ahead_m: float) -> None:
        """Add a clear image, its change of contrast since the one before, and the travel."""
        way_m = abs(ahead_m) + (self._clear[-1].way_m if self._clear else 0.0)
        if contrast is not None and ahead_m > 0 and not self.knows_clear:
            self._clear_m += ahead_m
            self._clear_change += contrast
        recent = [image for image in self._clear if image.way_m >= way_m - ALIKE_M]
        self._clear = [*recent, _Followed(details, way_m)]

    def begin(self, details: TileDetails, contrast: float) -> None:
        """Begin with an image that lacks details, by its contrast against a clear one."""
        self._first = self._greatest = contrast
        self._trail = [_Followed(details)]

    def is_back(self, details: TileDetails, contrast: float | None, ahead_m: float) -> bool:
        """Whether details are back in an image after others that lack them.

        Where two images cannot be compared, or the robot does not drive ahead, all begins anew.
        """
        if contrast is None or ahead_m <= 0 or self._clear_m < CLEAR_M:
            self._trail = [_Followed(details)]
            return False
        before = self._trail[-1]
        risen = before.risen + contrast - self._clear_change / self._clear_m * ahead_m
        self._greatest = min(self._greatest, self._first + risen)
        now = _Followed(details, before.way_m + ahead_m, risen)
        recent = [image for image in self._trail if image.way_m >= now.way_m - STEADY_M - RISE_M]
        self._trail = [*recent, now]
        return self._has_risen() and self._is_alike()

    def _has_risen(self) -> bool:
        """Whether details have risen by what was lost, and change as in clear images since."""
        now = self._trail[-1]
        earlier = [image for image in self._trail if image.way_m <= now.way_m - STEADY_M]
        if not earlier:
            return False
        since = earlier[-1]
        change_per_m = (now.risen - since.risen) / (now.way_m - since.way_m)
        rise = now.risen - min(image.risen for image in earlier)
        least = max(-RISEN * self._greatest, LEAST_RISE)
        return abs(change_per_m) < STEADY_PER_M and rise > least

    def _is_alike(self) -> bool:
        """Whether the latest images show as many details as the last clear ones."""
        now_m = self._trail[-1].way_m
        latest = [image for image in self._trail if image.way_m >= now_m - NOW_M]
        return bool(np.all(_typical(latest) > _typical(self._clear) - ALIKE))


@dataclass(frozen=True, eq=False)
class _Followed:
    """An image, the travel of the robot, and how far details have risen.

    Attributes
    ----------
    risen : float
        Sum of the changes of contrast, less what they are in clear images.
    """

    details: TileDetails
    way_m: float = 0.0
    risen: float = 0.0


def _levels(details: TileDetails) -> FloatArray:
    """Logarithms (2,): contrast over light, and focus where tiles show details (else NaN)."""
    finest, *coarser = details.octaves
    over_light = np.mean(coarser, axis=0) - details.light
    distinct = details.octaves.mean(axis=0) > np.log(DISTINCT)
    enough = np.count_nonzero(distinct) >= DISTINCT_SHARE * len(distinct)
    focus = np.median((finest - coarser[0])[distinct]) if enough else np.nan
    return np.array([np.median(over_light), focus])


def _typical(images: list[_Followed]) -> FloatArray:
    """Median levels (2,); NaN where more than half of the images have none."""
    levels = np.array([_levels(image.details) for image in images])
    known = levels[np.isfinite(levels).all(axis=1)]
    return np.median(known, axis=0) if 2 * len(known) >= len(levels) else np.full(2, np.nan)
