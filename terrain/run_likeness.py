"""Similarity of the images of a run to the training photographs, and the weight of labels."""

from collections import deque
from collections.abc import Mapping, Sequence

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from odometry.run import UNKNOWN
from terrain.classification.answer import Classifier
from terrain.classification.likeness import Likeness, TrainingLook, look_of, middle_of

KEPT = 200  # statistics of the latest images
# ground/ to pavements/, standardised: 0.47 right of four terrains is 0.3 of the way from chance
WORTH_OF_UNLIKE = 0.3


class RunLikeness:
    """Statistics of the regions that were classified in a run.

    Parameters
    ----------
    classifier : Classifier
        Without statistics of its training photographs there is no comparison.
    """

    def __init__(self, classifier: Classifier) -> None:
        self._training: TrainingLook | None = getattr(classifier, "training_look_", None)
        self._classifier = classifier
        self._looks: deque[FloatArray] = deque(maxlen=KEPT)
        self._ranks: deque[tuple[float, float]] = deque(maxlen=KEPT)

    def add(self, views: Sequence[ByteImage]) -> None:
        """Add the regions of one image."""
        if self._training is not None:
            looks = [look_of(middle_of(view, self._classifier.patch_size_px)) for view in views]
            look = np.mean(looks, axis=0)
            self._looks.append(look)
            self._ranks.append(self._training.ranks(look))

    @property
    def likeness(self) -> Likeness | None:
        """Of the images so far; None where there is no comparison."""
        if self._training is None:
            return None
        how = self._training.how(np.array(self._looks)) if self._looks else ()
        return Likeness.of(self._ranks, how)

    def weighed(self, label: str, probabilities: Mapping[str, float]) -> Mapping[str, float]:
        """Probabilities of each terrain by a label; closer to chance where images are unlike."""
        given = probabilities or ({} if label == UNKNOWN else {label: 1.0})
        if not Likeness.of(self._ranks).is_unlike or not given:
            return probabilities
        names = list(map(str, self._classifier.classes_))
        chance = (1 - WORTH_OF_UNLIKE) / len(names)
        return {name: WORTH_OF_UNLIKE * given.get(name, 0.0) + chance for name in names}
