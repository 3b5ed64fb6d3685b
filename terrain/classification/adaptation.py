"""A trained model and a few labelled photographs of a new camera: which samples to train on."""

from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.evaluation import balanced_accuracy
from terrain.classification.patches import (
    LabelledPatches,
    find_photos,
    load_patches,
    stated_metres_per_pixel,
)
from terrain.classification.trained_on import TrainedOn
from terrain.classification.training import Training
from terrain.errors import PatchError

ALONE, MIXED, OLD = "the new photographs alone", "both mixed", "the old model as it is"


@dataclass(frozen=True)
class Adaptation:
    """A model for a new camera.

    Attributes
    ----------
    training : Training
        The classifier that was kept, and the new patches.
    kept : str
        What it learned from.
    scores : dict of str to float
        Balanced accuracy by patch on new photographs that were held out; empty where a terrain has
        one photograph, so that none could be.
    forgotten : tuple of str
        Terrains of the old model that no new photograph shows: the new one does not know them.
    """

    training: Training
    kept: str
    scores: dict[str, float]
    forgotten: tuple[str, ...]


def adapt(
    root: str | Path,
    old: TerrainClassifier,
    *,
    metres_per_pixel: float | None = None,
    colour: bool = False,
    rejected_share: float = 0.05,
    processes: int = 1,
    show_progress: bool = False,
) -> Adaptation:
    """Train on the photographs of a folder, with the samples of an old model where they help.

    Whether they do is decided by cross-validation that holds whole new photographs out: nothing of
    an old photograph is evaluated. Where a terrain has one photograph alone this is undetermined,
    and only the new photographs are trained on.

    Parameters
    ----------
    root : path
        `root/<class>/*.jpg|png`, as for `train`, of the new camera.
    old : TerrainClassifier
        Of the ``default`` preset; features, patch size and, where nothing else is said, the scale
        are its own.
    metres_per_pixel : float, optional
    colour : bool
        Whether the new photographs alone are learned from in colour; mixed they are as the old.
    rejected_share : float
    processes : int
        That share the patches; -1 takes all cores.
    show_progress : bool

    Raises
    ------
    PatchError
        As `train`, or if the old model has no samples that could be mixed.
    """
    if old.old_samples_ is None:
        raise PatchError("the old model holds no samples (version 0.9, or chen2023): train it anew")
    photos = find_photos(Path(root))
    patches = load_patches(photos, old.patch_size_px)
    single = min(Counter(photo.label for photo in photos).values()) < 2
    used = _in_parts(patches) if single else patches
    scale = metres_per_pixel or stated_metres_per_pixel(Path(root)) or old.metres_per_pixel
    found: dict[str, TerrainClassifier] = {}
    for name, beside, in_colour in (
        (ALONE, None, colour or old.colour_),
        (MIXED, old.old_samples_, old.colour_),
    ):
        found[name] = TerrainClassifier(
            old.preset,
            colour=in_colour,
            metres_per_pixel=scale,
            rejected_share=rejected_share,
            features=old.features,
        ).fit(
            used.images,
            used.labels,
            used.groups,
            beside=beside,
            trained_on=_both(patches.trained_on, old.trained_on_ if beside else None),
            processes=processes,
            progress=show_progress,
        )
    forgotten = tuple(sorted(set(map(str, old.classes_)) - set(patches.labels)))
    if single:
        return Adaptation(Training(found[ALONE], patches), ALONE, {}, forgotten)
    scores = {name: _held_out(classifier) for name, classifier in found.items()}
    found[OLD], scores[OLD] = old, _as_it_is(old, patches)
    kept = max(scores, key=lambda name: scores[name])
    return Adaptation(
        Training(found[kept], patches), kept, scores, () if kept == OLD else forgotten
    )


def _held_out(classifier: TerrainClassifier) -> float:
    found = classifier.cross_validation_
    return balanced_accuracy(found.codes, found.probabilities.argmax(axis=1))


def _as_it_is(old: TerrainClassifier, patches: LabelledPatches) -> float:
    said = np.asarray(old.predict(patches.images))
    names, codes = np.unique(patches.labels, return_inverse=True)
    right = said == np.array(patches.labels)
    return float(np.mean([right[codes == code].mean() for code in range(len(names))]))


def _in_parts(patches: LabelledPatches) -> LabelledPatches:
    """Halves of photographs as groups, so that parts can be held out for k and rejection."""
    seen: Counter[str] = Counter()
    total = Counter(patches.groups)
    groups = []
    for group in patches.groups:
        groups.append(f"{group}, half {int(2 * seen[group] >= total[group]) + 1}")
        seen[group] += 1
    return replace(patches, groups=groups)


def _both(new: TrainedOn, old: TrainedOn | None) -> TrainedOn:
    if old is None:
        return new
    return TrainedOn(new.image_sums | old.image_sums, new.photo_ids | old.photo_ids)
