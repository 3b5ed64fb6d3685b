"""How a classifier learns from samples: what makes its features, which way, k and limits."""

from collections.abc import Sequence
from functools import cache

import numpy as np
from sklearn.base import clone

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.classification.confidence import WEIGHTS, weight_of_others
from terrain.classification.confidence_learning import (
    Answers,
    Shown,
    altered_patch,
    learned_confidence,
    other_terrains,
    shown_patches,
    shown_squares,
)
from terrain.classification.features.feature_jobs import Transformed, features_of
from terrain.classification.features.features import FeatureSettings
from terrain.classification.likeness.colour_range import ColourRange
from terrain.classification.likeness.look import spread_rows
from terrain.classification.likeness.noticed_alterations import noticed_share
from terrain.classification.likeness.training_look import TrainingLook
from terrain.classification.neighbours.neighbours import DiscriminantNeighbours
from terrain.classification.neighbours.rejection import quantiles, rejection_distances
from terrain.classification.neighbours.validation import CrossValidation, Fold, Samples, best_way
from terrain.classification.no_ground import ShownGround
from terrain.classification.old_samples import OldSamples
from terrain.classification.other_things import PHOTOGRAPHS, OtherThings, squares_of
from terrain.classification.photographs.trained_on import common_size, has_colour
from terrain.classification.presets import PRESETS
from terrain.classification.trained import TrainedClassifier
from terrain.errors import PatchError
from terrain.images import to_grey
from terrain.one_thread import one_thread


class LearningClassifier(TrainedClassifier):
    """What a `TerrainClassifier` does to become a trained one."""

    n_neighbors: int | None

    def _made_by(
        self, images: Sequence[ByteImage], labels: AnyArray
    ) -> FeatureSettings | Transformed:
        """What makes features of square patches, the size that the classifier then requires.

        The first of `images` have the labels (n,); altered copies follow them.
        """
        self.patch_size_px = common_size(images)
        preset = PRESETS[self.preset]
        wanted = self.colour and has_colour(images[: len(labels)], labels)
        settings = preset.colour_features if wanted else preset.features
        if self.features is None:
            self._features, self.colour_ = settings, bool(settings.colour_copies)
        else:
            shown = images if wanted else [to_grey(image) for image in images]
            fitted = clone(self.features).fit(shown)
            self._features, self.colour_ = Transformed(fitted, wanted), wanted
        return self._features

    @one_thread()  # more add up in another order: the last bits of a model are those of the machine
    def _learn(
        self,
        samples: Samples,
        copies: Samples,
        strange: Sequence[ByteImage],
        strange_features: FloatArray,
    ) -> None:
        preset = PRESETS[self.preset]
        self.one_patch_ = preset.one_patch
        counts = (self.n_neighbors,) if self.n_neighbors else preset.neighbour_counts
        try:
            way, found, folds = best_way(
                preset.ways, counts, samples, copies, calibrates=not preset.as_published
            )
            everything = samples.with_copies(np.arange(len(samples.codes)), copies)
            self._neighbours = way().fit(*everything)
        except np.linalg.LinAlgError as error:
            raise PatchError(
                f"{len(samples.codes)} patches of {len(self.classes_)} classes are too few, or too "
                "much alike, to show how patches of one class differ"
            ) from error
        self.cross_validation_: CrossValidation = found
        self.n_neighbors_ = found.n_neighbors
        if self.n_neighbors_ not in counts and self.n_neighbors:
            raise PatchError(
                f"k = {self.n_neighbors}, but with a part held back a class has fewer patches in "
                "training; choose a smaller k"
            )
        self.temperature_ = found.temperature
        limits = rejection_distances(
            found.distances, samples.groups[found.rows], self.rejected_share
        )
        self.rejection_distances_ = limits[:1] if preset.as_published else limits
        self.rejection_distance_ = limits[0]
        self.image_rejection_distances_ = (
            None if preset.as_published else quantiles(found.image_distances, self.rejected_share)
        )
        self._learn_of_others(folds, samples, (strange, strange_features))

    def _learn_of_others(
        self,
        folds: Sequence[Fold],
        samples: Samples,
        strange: tuple[Sequence[ByteImage], FloatArray],
    ) -> None:
        """Learn of images unlike training: what things are, and how sure answers are."""
        self.other_things_ = self.confidence_ = None
        if self._features is None or not isinstance(self._neighbours, DiscriminantNeighbours):
            return
        things = _features_of(PHOTOGRAPHS, self.patch_size_px, self._features)
        scaled = self._neighbours.scaler.transform
        self.other_things_ = OtherThings.of(
            scaled(samples.features), samples.codes, samples.groups, scaled(things)
        )
        if self.training_look_ is None or self.image_rejection_distances_ is None:
            return
        shown = shown_patches(self.training_look_, samples, strange)
        answers = Answers(
            self._neighbours,
            self.n_neighbors_,
            self.temperature_,
            self.image_rejection_distances_,
            self.training_look_,
        )
        self.confidence_ = learned_confidence(
            answers, folds, samples, shown, self._not_known(self.training_look_)
        )

    def _not_known(self, look: TrainingLook) -> list[tuple[float, Shown]]:
        """Squares of things, and of other terrain where few are known, with their weights."""
        kinds: dict[tuple[str, ...], float] = {PHOTOGRAPHS: WEIGHTS[-1]}
        if others := other_terrains(self.classes_.tolist()):
            kinds[others] = weight_of_others(len(self.classes_))
        size_px, made_by = self.patch_size_px, self._features
        return [
            (
                weight,
                shown_squares(
                    look,
                    squares_of(photographs, size_px),
                    _features_of(photographs, size_px, made_by),
                ),
            )
            for photographs, weight in kinds.items()
            if weight and made_by is not None
        ]

    def _strange_patches(self, patches: Sequence[ByteImage], photos: AnyArray) -> list[ByteImage]:
        """Every second of the patches whose looks are kept, altered."""
        if PRESETS[self.preset].as_published:
            return []
        is_to_scale = self.metres_per_pixel is not None
        rows = spread_rows(photos)[::2]
        return [altered_patch(patches[i], is_to_scale=is_to_scale) for i in rows]

    def _look_at(
        self, patches: Sequence[ByteImage] | None, samples: Samples, labels: AnyArray
    ) -> None:
        """Keep how the training patches look, what they show, and some of their features."""
        self.training_look_ = self.old_samples_ = self.shown_ground_ = None
        self.colour_range_ = self.noticed_share_ = None
        if patches is None:
            return
        photographs = samples.codes, samples.groups
        self.training_look_ = TrainingLook.of(patches, *photographs)
        if self.colour_:
            self.colour_range_ = ColourRange.of(patches, *photographs)
        self.noticed_share_ = noticed_share(self.training_look_, patches, *photographs)
        if not PRESETS[self.preset].as_published:
            self.shown_ground_ = ShownGround.of(list(patches), samples.codes)
            rows = spread_rows(samples.groups)
            self.old_samples_ = OldSamples(samples.features[rows], labels[rows])


def _features_of(
    photographs: tuple[str, ...], size_px: int, made_by: FeatureSettings | Transformed
) -> FloatArray:
    """Features (n, F) of `squares_of`; those of settings are made once in a process."""
    if isinstance(made_by, FeatureSettings):
        return _kept_features(photographs, size_px, made_by)
    return features_of(squares_of(photographs, size_px), made_by)


@cache
def _kept_features(
    photographs: tuple[str, ...], size_px: int, settings: FeatureSettings
) -> FloatArray:
    features = features_of(squares_of(photographs, size_px), settings)
    features.flags.writeable = False
    return features
