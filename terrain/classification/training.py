"""From a folder of labelled patches to a fitted classifier."""

from dataclasses import dataclass, replace
from pathlib import Path

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.features.feature_jobs import Transformer
from terrain.classification.photographs.augmentation import Augmentation, load_copies
from terrain.classification.photographs.patches import (
    LabelledPatches,
    find_photos,
    fitting_side_px,
    load_patches,
    stated_metres_per_pixel,
)
from terrain.classification.photographs.photo_faults import check_no_photo_in_two_classes
from terrain.classification.photographs.scenes import with_scenes
from terrain.errors import ImageError
from terrain.image_depth import check_depth

LARGEST_PATCH_PX = 128


@dataclass(frozen=True)
class Training:
    """A fitted classifier and the patches that it was fitted on.

    Attributes
    ----------
    classifier : TerrainClassifier
    patches : LabelledPatches

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> training = terrain.train(odometry.shipped_data() / "patches", preset="chen2023")
    >>> len(training.patches.images), training.classifier.classes_.tolist()
    (96, ['brick', 'grass', 'gravel'])
    """

    classifier: TerrainClassifier
    patches: LabelledPatches


def train(
    root: str | Path,
    *,
    preset: str = "default",
    patch_size_px: int | None = None,
    metres_per_pixel: float | None = None,
    colour: bool = False,
    features: Transformer | None = None,
    k: int | None = None,
    rejected_share: float = 0.05,
    augment: bool = False,
    processes: int = 1,
    scheduler: str | None = None,
    show_progress: bool = False,
) -> Training:
    """Cut the photographs of a folder to patches of one size and fit a classifier.

    Parameters
    ----------
    root : path
        `root/<class>/*.jpg|png`, see data/README.md.
    preset : {"default", "fast", "chen2023"}
    patch_size_px : int, optional
        Side of a patch; by default 128, or less where that fits into nine of ten photographs.
    metres_per_pixel : float, optional
        Scale of the photographs, by default what `manifest.csv` states in a column of that name.
        Without either, a run's images are cropped, not warped.
    colour : bool
        Whether colour is used beside grey.
    features : transformer, optional
        Makes the features in place of SFTA, as in `TerrainClassifier`.
    k : int, optional
        Neighbours that vote; by default chosen in cross-validation.
    rejected_share : float
        Share of known patches that may be called unknown.
    augment : bool
        Whether altered copies of the photographs are learned from as well (not ``chen2023``):
        scaled, where their scale is not known, blurred, relit, noisy and compressed, as another
        camera may show the terrain.
    processes : int
        That share the patches; -1 takes all cores. What is learned is the same.
    scheduler : str, optional
        Address of a Dask scheduler, such as tcp://host:8786, whose workers share them instead; the
        photographs are read here and sent to them.
    show_progress : bool

    Raises
    ------
    PatchError
        If the folder does not have the documented format, or too few photographs of a class.
    ImageError
        If a photograph cannot be read, or photographs of 16 bits hold fewer.
    ExtraError, BatchError
        If there is a scheduler and Dask is not installed, or the cluster cannot do it.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> training = terrain.train(odometry.shipped_data() / "patches", preset="chen2023")
    >>> training.classifier.classes_.tolist()
    ['brick', 'grass', 'gravel']
    """
    root = Path(root)
    photos = find_photos(root)
    check_depth([photo.path for photo in photos], ImageError)
    check_no_photo_in_two_classes([(photo.path, photo.label) for photo in photos])
    size_px = patch_size_px or min(LARGEST_PATCH_PX, fitting_side_px(photos))
    patches = with_scenes(load_patches(photos, size_px))
    scale = metres_per_pixel or stated_metres_per_pixel(root)
    classifier = TerrainClassifier(
        preset,
        colour=colour,
        metres_per_pixel=scale,
        rejected_share=rejected_share,
        n_neighbors=k,
        features=features,
    )
    copies = None
    if augment:
        settings = Augmentation() if scale is None else Augmentation(largest_crop=1.0)
        copies = replace(load_copies(photos, size_px, settings), scene_of=patches.scene_of)
        copies = replace(copies, groups=copies.scenes)
    classifier.fit(
        patches.images,
        patches.labels,
        patches.scenes,
        copies=copies,
        progress=show_progress,
        trained_on=patches.trained_on,
        processes=processes,
        scheduler=scheduler,
    )
    return Training(classifier, patches)
