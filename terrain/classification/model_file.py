"""A trained classifier as a file, and back."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

import numpy as np

from odometry.arrays import AnyArray
from odometry.errors import ConfigError
from odometry.io.array_file import FileKind, read_array_file, write_array_file
from terrain.classification.confidence import AnswerConfidence
from terrain.classification.features.feature_jobs import Transformed, Transformer, features_of
from terrain.classification.features.features import FeatureSettings
from terrain.classification.features.network_features import NetworkFeatures
from terrain.classification.likeness.colour_range import ColourRange
from terrain.classification.likeness.look import look_of
from terrain.classification.likeness.training_look import TrainingLook
from terrain.classification.model_settings import ModelSettings, NetworkSettings
from terrain.classification.neighbours.neighbours import Neighbours
from terrain.classification.no_ground import ShownGround
from terrain.classification.old_samples import OldSamples
from terrain.classification.other_things import OtherThings
from terrain.classification.photographs.trained_on import TrainedOn, check_codes
from terrain.classification.presets import PRESETS
from terrain.errors import ImageError, ModelFileError, NetworkError

CLASSIFIER = FileKind("terrain-odometry classifier", 1, "model file of `train`", ModelFileError)


class ModelFile:
    """What a `TerrainClassifier` can do with a file."""

    preset: str
    colour: bool
    metres_per_pixel: float | None
    rejected_share: float
    classes_: AnyArray
    n_features_in_: int
    patch_size_px: int
    colour_: bool
    n_neighbors_: int
    rejection_distance_: float
    rejection_distances_: tuple[float, ...]
    image_rejection_distances_: tuple[float, ...] | None
    temperature_: float | None
    one_patch_: bool
    trained_on_: TrainedOn | None
    training_look_: TrainingLook | None
    colour_range_: ColourRange | None
    noticed_share_: float | None
    shown_ground_: ShownGround | None
    other_things_: OtherThings | None
    confidence_: AnswerConfidence | None
    old_samples_: OldSamples | None
    features: Transformer | None
    _features: FeatureSettings | Transformed | None
    _neighbours: Neighbours

    def save(self, path: str | Path, made: Mapping[str, Any] | None = None) -> None:
        """Write the classifier to one file of arrays and JSON; see `persistence`.

        `made` says what made it, and is kept in the file.

        Raises
        ------
        ModelFileError
            If it was fitted on features: such a model can look at no image. If a transformer
            makes its features that is no `NetworkFeatures`: a file would have to hold a program.
        """
        if self._features is None:
            raise ModelFileError(f"{path}: the classifier was fitted on features, not on images")
        features: FeatureSettings | NetworkSettings
        arrays = self._neighbours.arrays()
        if self.training_look_ is not None:
            arrays |= self.training_look_.arrays()
        if self.colour_range_ is not None:
            arrays |= self.colour_range_.arrays()
        if self.shown_ground_ is not None:
            arrays |= self.shown_ground_.arrays()
        if self.other_things_ is not None:
            arrays |= self.other_things_.arrays()
        if self.confidence_ is not None:
            arrays |= self.confidence_.arrays()
        if self.old_samples_ is not None:
            arrays |= self.old_samples_.arrays(self.classes_)
        if isinstance(self._features, FeatureSettings):
            features = self._features
        elif isinstance(made_by := self._features.transformer, NetworkFeatures):
            features, network = NetworkSettings.taken_from(made_by)
            arrays |= network
        else:
            raise ModelFileError(
                f"{path}: a model file holds SFTA or an image network (NetworkFeatures), not a "
                f"{type(made_by).__name__}; pickle or joblib keep such a classifier"
            )
        settings = ModelSettings.taken_from(self, features)
        write_model(Path(path), settings.to_table(), arrays, made)

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read what `save` wrote. The loaded classifier gives the same answers.

        Raises
        ------
        ModelFileError
            If the file is missing, damaged, foreign, or of a newer program. Nothing in it is
            executed.
        """
        table, arrays = read_model(Path(path))
        try:
            return cls._from_file(ModelSettings.from_table(table), arrays)
        except (KeyError, TypeError, ValueError, ConfigError, NetworkError, ImageError) as error:
            raise ModelFileError(f"{path}: its settings or arrays do not fit: {error!r}") from error

    @classmethod
    def _from_file(cls, settings: ModelSettings, arrays: dict[str, AnyArray]) -> Self:
        model = cls()
        settings.put_into(model)
        model.classes_, model.colour = np.array(settings.classes), settings.colour
        features = settings.features
        if isinstance(features, NetworkSettings):
            model.features = features.restored(arrays)
            model._features = Transformed(model.features, model.colour_)
        else:
            model._features = features
        model.old_samples_ = OldSamples.from_arrays(arrays, model.classes_)
        model.training_look_ = TrainingLook.from_arrays(arrays, len(settings.classes))
        model.colour_range_ = ColourRange.from_arrays(arrays)
        model.shown_ground_ = ShownGround.from_arrays(arrays, len(settings.classes))
        model.other_things_ = OtherThings.from_arrays(arrays, len(settings.classes))
        model.confidence_ = AnswerConfidence.from_arrays(arrays)
        check_codes(arrays["codes"], len(settings.classes))
        model._neighbours = PRESETS[model.preset].neighbours.from_arrays(arrays)
        model._check_that_parts_fit(model._features)
        return model

    def _check_that_parts_fit(self, made_by: FeatureSettings | Transformed) -> None:
        """Ask about one blank patch: ValueError if the parts of a file contradict each other."""
        blank = np.zeros((self.patch_size_px, self.patch_size_px, 3), np.uint8)
        features = features_of([blank], made_by)
        self.n_features_in_ = features.shape[1]
        self._neighbours.labels(features, self.n_neighbors_)
        self._neighbours.distances(features)
        if self.image_rejection_distances_ is not None:
            self._neighbours.labels_and_image_distances(features, 1, [np.arange(1)])
        things = self.other_things_
        if things is not None and len(things.direction) != self.n_features_in_:
            raise ValueError(f"a direction of things for {len(things.direction)} features")
        look = self.training_look_
        if self.confidence_ is not None and look is not None:
            look.displacement(look.differences(np.array([look_of(blank)])))
        if len(self.classes_) != len(self._neighbours.class_weights_):
            raise ValueError(f"{len(self.classes_)} class names for the samples of others")


def write_model(
    path: Path,
    settings: Mapping[str, Any],
    arrays: Mapping[str, AnyArray],
    made: Mapping[str, Any] | None = None,
) -> None:
    """Write settings (JSON values) and arrays (numeric); the same content gives the same bytes.

    `made` says what made the model; it is kept in the header, for people alone.
    """
    write_array_file(path, CLASSIFIER, settings, arrays, made)


def read_model(path: Path) -> tuple[dict[str, Any], dict[str, AnyArray]]:
    """Read what `write_model` wrote: the settings and the arrays.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, not a model, or of a newer version.
    """
    return read_array_file(path, CLASSIFIER)


def is_model(path: Path) -> bool:
    """Whether a file is a whole model file of a format that this program reads."""
    try:
        read_model(path)
    except ModelFileError:
        return False
    return True
