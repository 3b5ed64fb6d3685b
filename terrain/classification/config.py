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
    same_camera : bool
        The camera is that of training: names stay that would be ``unknown`` since a model of
        photographs of many cameras does not notice another one, see `noticed_share_`.
    """

    own_statistics: bool = False
    same_camera: bool = False
