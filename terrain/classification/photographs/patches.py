"""Labelled photographs of terrain: find them, group them, cut them to patches of one size."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from odometry.arrays import BoolArray, ByteImage
from terrain.classification.photographs.manifest import photo_ids_of, read_manifest
from terrain.classification.photographs.opaque import opaque
from terrain.classification.photographs.photo_faults import check_classes
from terrain.classification.photographs.thumbnails import thumbnail_text
from terrain.classification.photographs.trained_on import TrainedOn, check_names, image_sum
from terrain.errors import ImageError, PatchError
from terrain.images import read_image

SUFFIXES = (".jpg", ".jpeg", ".png")
PATCHES_PER_PHOTO = 60
MOST_NAMED = 3  # photographs of an error


@dataclass(frozen=True)
class LabelledPhoto:
    """One photograph: its file, its terrain name and the photo_id that groups it."""

    path: Path
    label: str
    group: str


@dataclass(frozen=True)
class LabelledPatches:
    """Patches of one size with their terrain names, groups and the photographs they are of.

    `image_sums` and `thumbnails` are those of the photographs, by `image_sum` and `thumbnail_text`;
    `sides_px` the shorter side of each; `alike` photographs of several groups that look alike, and
    `scene_of` the scene of each group that has another name than that, both by `with_scenes`.
    """

    images: list[ByteImage] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)
    groups: list[str] = field(default_factory=list)
    photos: list[Path] = field(default_factory=list)
    too_small: list[Path] = field(default_factory=list)
    image_sums: list[str] = field(default_factory=list)
    thumbnails: list[str] = field(default_factory=list)
    sides_px: dict[Path, int] = field(default_factory=dict)
    alike: list[tuple[Path, Path]] = field(default_factory=list)
    scene_of: dict[str, str] = field(default_factory=dict)

    @property
    def scenes(self) -> list[str]:
        """What is held out together: the groups, those of photographs that look alike as one."""
        return [self.scene_of.get(group, group) for group in self.groups]

    @property
    def trained_on(self) -> TrainedOn:
        """What a classifier is trained on that learns from these."""
        given = {
            group
            for photo, group in zip(self.photos, self.groups, strict=True)
            if group != str(photo)
        }
        return TrainedOn(frozenset(self.image_sums), frozenset(given), frozenset(self.thumbnails))


def find_photos(root: Path) -> list[LabelledPhoto]:
    """Return the photographs of ``root/<class>/*.jpg|png``, sorted by path.

    Photographs are grouped by the ``photo_id`` of ``manifest.csv`` in `root` or its parent;
    a photograph that no manifest names is a group of its own. Hidden files and folders, whose
    names begin with a dot, are no photographs.

    Raises
    ------
    PatchError
        If `root` is not a folder, holds no photographs, or uses a name as that of what is
        ``unknown``, if a class would vanish or be taken for two, or if the manifest is damaged or
        names none of the photographs.
    """
    if not root.is_dir():
        raise PatchError(f"{root} is not a folder; expected {root}/<class>/*.jpg or *.png")
    found = sorted(path for path in root.glob("*/*") if path.suffix.lower() in SUFFIXES)
    paths = [path for path in found if not _is_hidden(path)]
    check_classes(root, sorted({path.parent.name for path in paths}), SUFFIXES)
    if not paths:
        beside = any(path.suffix.lower() in SUFFIXES for path in root.iterdir())
        hint = f" (images without labels are given one by one: {root}/*)" if beside else ""
        raise PatchError(
            f"{root} holds no photographs; expected {root}/<class>/*.jpg or *.png{hint}"
        )
    groups = photo_ids_of(read_manifest(root), paths)
    photos = [
        LabelledPhoto(path, path.parent.name, groups.get(path.resolve(), str(path)))
        for path in paths
    ]
    try:
        check_names({photo.label for photo in photos})
    except PatchError as error:
        raise PatchError(f"{root}: {error}") from error
    return photos


def _is_hidden(photo: Path) -> bool:
    return photo.name.startswith(".") or photo.parent.name.startswith(".")


def cut_patches(image: ByteImage, size_px: int, stride_px: int | None = None) -> list[ByteImage]:
    """Cut an image into square patches on a centred grid, row by row.

    Parameters
    ----------
    image : ByteImage, shape (rows, columns) or (rows, columns, 3)
    size_px : int
        Side of a patch.
    stride_px : int, optional
        Step of the grid; side by side if left out.

    Returns
    -------
    list of ByteImage
        Views of `image`; empty if it is smaller than one patch.

    Examples
    --------
    >>> import numpy as np
    >>> import terrain
    >>> len(terrain.cut_patches(np.zeros((200, 300), dtype=np.uint8), size_px=96))
    6
    """
    tops, lefts = (_starts(length, size_px, stride_px or size_px) for length in image.shape[:2])
    return [image[top : top + size_px, left : left + size_px] for top in tops for left in lefts]


def load_patches(
    photos: Sequence[LabelledPhoto],
    size_px: int,
    max_per_photo: int = PATCHES_PER_PHOTO,
) -> LabelledPatches:
    """Read photographs and cut them to patches, each overlapping the next by half.

    Patches with transparent pixels are left out.

    Parameters
    ----------
    photos : sequence of LabelledPhoto
    size_px : int
        Side of a patch.
    max_per_photo : int
        Keep at most so many patches of a photograph, spread evenly over it.

    Raises
    ------
    PatchError
        If a class has no photograph of which `size_px` x `size_px` are opaque.
    ImageError
        If photographs cannot be read; all of them are counted.
    """
    patches = LabelledPatches()
    for photo, image in _read(photos):
        cut = _opaque_patches(image, opaque(photo.path), size_px, max(size_px // 2, 1))
        if len(cut) > max_per_photo:
            cut = [cut[i] for i in np.linspace(0, len(cut) - 1, max_per_photo).astype(int)]
        if not cut:
            patches.too_small.append(photo.path)
        patches.image_sums.append(image_sum(image))
        patches.thumbnails.append(thumbnail_text(image))
        patches.sides_px[photo.path] = min(image.shape[:2])
        patches.images.extend(patch.copy() for patch in cut)  # so that no photograph is kept
        patches.labels.extend([photo.label] * len(cut))
        patches.groups.extend([photo.group] * len(cut))
        patches.photos.extend([photo.path] * len(cut))
    counts = Counter(photo.label for photo in photos)
    for label in sorted(set(counts) - set(patches.labels)):
        raise PatchError(
            f"class '{label}': none of its {counts[label]} photographs is {size_px} x {size_px} "
            "pixels or larger, and opaque there; choose a smaller patch size"
        )
    return patches


def _opaque_patches(
    image: ByteImage, shows: BoolArray | None, size_px: int, stride_px: int
) -> list[ByteImage]:
    """Patches of what shows; all, where nothing is transparent."""
    cut = cut_patches(image, size_px, stride_px)
    if shows is None:
        return cut
    masks = cut_patches(255 * shows.astype(np.uint8), size_px, stride_px)
    return [patch for patch, mask in zip(cut, masks, strict=True) if mask.all()]


def _read(photos: Sequence[LabelledPhoto]) -> Iterator[tuple[LabelledPhoto, ByteImage]]:
    """Each photograph with its pixels; at the end ImageError with all that cannot be read."""
    reasons = []
    for photo in photos:
        try:
            yield photo, read_image(photo.path)
        except ImageError as error:
            reasons.append(str(error))
    if reasons:
        count = "" if len(reasons) == 1 else f"{len(reasons)} photographs cannot be read: "
        more = f"; and {len(reasons) - MOST_NAMED} more" if len(reasons) > MOST_NAMED else ""
        raise ImageError(f"{count}{'; '.join(reasons[:MOST_NAMED])}{more}")


def _starts(length: int, size_px: int, stride_px: int) -> range:
    if length < size_px:
        return range(0)
    count = (length - size_px) // stride_px + 1
    first = (length - size_px - (count - 1) * stride_px) // 2
    return range(first, first + count * stride_px, stride_px)


def fitting_side_px(photos: Sequence[LabelledPhoto]) -> int:
    """Side of the largest square that fits into nine of ten photographs.

    Raises
    ------
    ImageError
        If a photograph cannot be read.
    """
    sides = [min(image.shape[:2]) for _, image in _read(photos)]
    return int(np.percentile(sides, 10, method="lower"))


def stated_metres_per_pixel(root: Path) -> float | None:
    """Scale that `manifest.csv` states in a column `metres_per_pixel`, None where it has none.

    Raises
    ------
    PatchError
        As `read_manifest`.
    """
    manifest = read_manifest(root)
    return None if manifest is None else manifest.metres_per_pixel
