"""A trained classifier as a file, and back."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

import numpy as np

from odometry.arrays import AnyArray
from odometry.errors import ConfigError
from terrain.classification.features import FeatureSettings, feature_matrix
from terrain.classification.model_settings import ModelSettings
from terrain.classification.neighbours import Neighbours
from terrain.classification.persistence import read_model, write_model
from terrain.classification.presets import PRESETS
from terrain.classification.trained_on import TrainedOn
from terrain.classification.training_set import check_codes
from terrain.errors import ModelFileError


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
    trained_on_: TrainedOn | None
    _features: FeatureSettings | None
    _neighbours: Neighbours

    def save(self, path: str | Path, made: Mapping[str, Any] | None = None) -> None:
        """Write the classifier to one file of arrays and JSON; see `persistence`.

        `made` says what made it, and is kept in the file.

        Raises
        ------
        ModelFileError
            If it was fitted on features: such a model can look at no image.
        """
        if self._features is None:
            raise ModelFileError(f"{path}: the classifier was fitted on features, not on images")
        settings = ModelSettings(
            self.preset,
            self.colour_,
            self.metres_per_pixel,
            self.rejected_share,
            self.patch_size_px,
            tuple(map(str, self.classes_)),
            self.n_neighbors_,
            self.rejection_distance_,
            self._features,
            self.trained_on_,
        )
        write_model(Path(path), settings.to_table(), self._neighbours.arrays(), made)

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
        except (KeyError, TypeError, ValueError, ConfigError) as error:
            raise ModelFileError(f"{path}: its settings or arrays do not fit: {error!r}") from error

    @classmethod
    def _from_file(cls, settings: ModelSettings, arrays: dict[str, AnyArray]) -> Self:
        model = cls()
        model.preset = settings.preset
        model.colour = model.colour_ = settings.colour
        model.metres_per_pixel = settings.metres_per_pixel
        model.rejected_share = settings.rejected_share
        model.patch_size_px = settings.patch_size_px
        model.classes_ = np.array(settings.classes)
        model.n_neighbors_ = settings.n_neighbors
        model.rejection_distance_ = settings.rejection_distance
        model._features = settings.features
        model.trained_on_ = settings.trained_on
        check_codes(arrays["codes"], len(settings.classes))
        model._neighbours = PRESETS[model.preset].neighbours.from_arrays(arrays)
        model._check_that_parts_fit(settings.features)
        return model

    def _check_that_parts_fit(self, settings: FeatureSettings) -> None:
        """Ask about one blank patch: ValueError if the parts of a file contradict each other."""
        blank = np.zeros((self.patch_size_px, self.patch_size_px, 3), np.uint8)
        features = feature_matrix([blank], settings)
        self.n_features_in_ = features.shape[1]
        self._neighbours.labels(features, self.n_neighbors_)
        self._neighbours.distances(features)
        if len(self.classes_) != len(self._neighbours.class_weights_):
            raise ValueError(f"{len(self.classes_)} class names for the samples of others")
