"""A trained model and a few labelled photographs of a new camera: which samples to train on."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, BoolArray, IntArray
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.held_out import paired_difference
from terrain.classification.neighbours.validation import balanced_accuracy
from terrain.classification.photographs.patches import (
    LabelledPatches,
    find_photos,
    load_patches,
    stated_metres_per_pixel,
)
from terrain.classification.photographs.photo_faults import check_no_photo_in_two_classes
from terrain.classification.photographs.scenes import with_scenes
from terrain.classification.photographs.trained_on import TrainedOn
from terrain.classification.training import Training
from terrain.errors import ImageError, PatchError
from terrain.image_depth import check_depth

CLEAR = 2.0  # standard errors
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
    an old photograph is evaluated. The new photographs alone are kept unless old ones help by more
    than twice the standard error of the difference, see `clearly_best`. Where a terrain has one
    photograph alone this is undetermined, and only the new photographs are trained on.

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
    check_depth([photo.path for photo in photos], ImageError)
    check_no_photo_in_two_classes([(photo.path, photo.label) for photo in photos])
    patches = with_scenes(load_patches(photos, old.patch_size_px))
    single = min(Counter(photo.label for photo in photos).values()) < 2
    used = _in_parts(patches) if single else patches
    scale = metres_per_pixel or stated_metres_per_pixel(Path(root)) or old.metres_per_pixel
    before = old.trained_on_ or TrainedOn()
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
            used.scenes,
            beside=beside,
            trained_on=patches.trained_on | before if beside else patches.trained_on,
            processes=processes,
            progress=show_progress,
        )
    forgotten = tuple(sorted(set(map(str, old.classes_)) - set(patches.labels)))
    if single:
        return Adaptation(Training(found[ALONE], patches), ALONE, {}, forgotten)
    rows = found[ALONE].cross_validation_.rows
    right = {name: _held_out(classifier) for name, classifier in found.items()}
    right[OLD] = (np.asarray(old.predict(patches.images)) == np.array(patches.labels))[rows]
    found[OLD] = old
    codes, groups = found[ALONE].cross_validation_.codes, np.asarray(patches.scenes)[rows]
    scores = {name: balanced_accuracy(codes, np.where(of, codes, -1)) for name, of in right.items()}
    kept = clearly_best(codes, right, groups)
    return Adaptation(
        Training(found[kept], patches), kept, scores, () if kept == OLD else forgotten
    )


def clearly_best(codes: IntArray, right: Mapping[str, BoolArray], groups: AnyArray) -> str:
    """The new photographs alone, unless another way is clearly better.

    A few photographs are weak evidence, what an old model holds is of another camera, and in each
    fold the new ones alone learn from fewer photographs than in the end: where held-out photographs
    do not show by two standard errors that old ones help, these are left out.

    Parameters
    ----------
    codes : IntArray, shape (n,)
    right : dict of str to BoolArray, shape (n,)
        Whether each way answers the patches rightly.
    groups : array, shape (n,)
        Their photographs.
    """
    gains = {
        name: paired_difference(codes, of, right[ALONE], groups)
        for name, of in right.items()
        if name != ALONE
    }
    helpful = [name for name, (gain, error) in gains.items() if gain > CLEAR * error]
    return max(helpful, key=lambda name: gains[name][0], default=ALONE)


def _held_out(classifier: TerrainClassifier) -> BoolArray:
    found = classifier.cross_validation_
    return np.asarray(found.probabilities.argmax(axis=1) == found.codes)


def _in_parts(patches: LabelledPatches) -> LabelledPatches:
    """Halves of photographs as groups, so that parts can be held out for k and rejection."""
    seen: Counter[str] = Counter()
    total = Counter(patches.groups)
    groups = []
    for group in patches.groups:
        groups.append(f"{group}, half {int(2 * seen[group] >= total[group]) + 1}")
        seen[group] += 1
    return replace(patches, groups=groups)
