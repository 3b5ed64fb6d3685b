"""Unknown terrain by the distances of several images together."""

from collections import deque
from dataclasses import replace

import numpy as np

from odometry.recording.run import UNKNOWN
from terrain.classification.answer import Classifier
from terrain.classification.neighbours.rejection import as_of_one_patch, rejection_limit
from terrain.image_labels.image_label import ImageLabel

LENGTH_M = 2.0  # of wheel travel that is judged together
STEP_M = 0.1  # images taken closer together than this are one
FEWEST = 4  # images


class DistanceTrack:
    """The class distances of the regions along the latest 2 m of wheel travel.

    Their median varies less than the distance of one image, as the median of the patches of one
    photograph does: it is unknown from a smaller distance on, by the limits of the classifier for
    so many patches. Images of a robot that stands are no further evidence.

    Parameters
    ----------
    classifier : Classifier
        Without `rejection_distances_` every label stays as it is.
    """

    def __init__(self, classifier: Classifier) -> None:
        self._limits: tuple[float, ...] = getattr(classifier, "rejection_distances_", ())
        self._limit: float = getattr(classifier, "rejection_distance_", np.inf)
        self._seen: deque[tuple[float, float, int]] = deque()

    def judged(self, image_label: ImageLabel, travel_m: float) -> ImageLabel:
        """The image label, or the same as `unknown` where the track is too far from every class.

        Parameters
        ----------
        image_label : ImageLabel
        travel_m : float
            Wheel travel of the run at the image.
        """
        in_strips = bool(image_label.left)
        if not self._limits or in_strips or not np.isfinite(image_label.class_distance):
            return image_label
        while self._seen and self._seen[0][0] < travel_m - LENGTH_M:
            self._seen.popleft()
        if not self._seen or travel_m >= self._seen[-1][0] + STEP_M:
            self._seen.append((travel_m, image_label.class_distance, image_label.patches))
        if image_label.label == UNKNOWN or not self.is_unknown:
            return image_label
        reason = f"the images of the last {LENGTH_M:g} m together are too far from every terrain"
        return replace(image_label, label=UNKNOWN, reason=reason)

    @property
    def is_unknown(self) -> bool:
        """Whether the track as a whole is too far; never with fewer than four images."""
        if len(self._seen) < FEWEST:
            return False
        medians = [
            distance * rejection_limit(patches, self._limits) / self._limits[0]
            for _, distance, patches in self._seen
        ]
        patches = sum(count for _, _, count in self._seen)
        together = as_of_one_patch(float(np.median(medians)), patches, self._limits)
        return together > self._limit
