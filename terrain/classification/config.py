"""Settings of a classifier in a run."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ClassifierConfig:
    """Settings of the classifier in a run.

    Attributes
    ----------
    own_statistics : bool
        Features are standardised by the images of the run as they arrive, see
        `OwnStatisticsClassifier`: for a camera unlike that of training.
    """

    own_statistics: bool = False
