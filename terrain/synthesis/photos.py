"""Photographs of terrain, split so that no patch shows terrain that the run drives over."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import skimage.data

from odometry.arrays import ByteImage
from terrain.classification.patches import LabelledPhoto, find_photos
from terrain.errors import SynthesisError, TerrainError
from terrain.images import read_image, to_grey

BUILT_IN = ("brick", "grass", "gravel")
"""Terrains of the photographs in scikit-image's wheel."""

_AREA_PX = 128
_MOST_GROUND_PHOTOS = 3
_MOST_PATCH_PHOTOS = 16


@dataclass(frozen=True, eq=False)
class Photo:
    """A photograph, or an area of one; grey (H, W) or RGB (H, W, 3)."""

    photo_id: str
    image: ByteImage


@dataclass(frozen=True, eq=False)
class PhotoSets:
    """Photographs by terrain: those for the run and, disjoint, those for patches."""

    ground: Mapping[str, tuple[Photo, ...]]
    patches: Mapping[str, tuple[Photo, ...]]
    origin: str

    @property
    def terrains(self) -> tuple[str, ...]:
        """Names of the terrains, sorted."""
        return tuple(sorted(self.ground))


def built_in_photos() -> PhotoSets:
    """Grass, gravel and brick of scikit-image: left halves for the run, right for patches.

    The right half is parted into areas of 128 x 128 pixels, each with a photo_id of its own.
    The images are 512 x 512, grey, CC0.
    """
    ground, patches = {}, {}
    for terrain in BUILT_IN:
        image = getattr(skimage.data, terrain)()
        middle = image.shape[1] // 2
        ground[terrain] = (Photo(f"{terrain}-left", image[:, :middle]),)
        right = image[:, middle:]
        corners = [
            (row, column)
            for row in range(0, right.shape[0], _AREA_PX)
            for column in range(0, right.shape[1], _AREA_PX)
        ]
        patches[terrain] = tuple(
            Photo(f"{terrain}-right-{i}", right[r : r + _AREA_PX, c : c + _AREA_PX])
            for i, (r, c) in enumerate(corners)
        )
    origin = (
        "grass, gravel and brick of scikit-image (CC0): the left half of each photograph is the "
        "ground, the right half is kept for the patches"
    )
    return PhotoSets(ground, patches, origin)


def photos_from_folder(folder: Path, rng: np.random.Generator) -> PhotoSets:
    """Labelled photographs split at random by photo_id, one half each for run and patches.

    Parameters
    ----------
    folder : Path
        ``root/<class>/*.jpg|png``, as for training.
    rng : numpy.random.Generator
        Decides which photographs go where; at most 3 a class are used for the run and 16 for
        patches.

    Raises
    ------
    SynthesisError
        If the folder or a photograph cannot be read, or a class has fewer than 2 photo_ids.
    """
    ground, patches = {}, {}
    for label, groups in _by_label_and_photo_id(folder).items():
        if len(groups) < 2:
            raise SynthesisError(
                f"{folder / label}: {len(groups)} photo; at least 2 with different photo_id "
                "are needed, one for the ground and one for the patches"
            )
        chosen = [groups[i][0] for i in rng.permutation(len(groups))]
        half = len(chosen) // 2
        ground[label] = _read(chosen[:half][:_MOST_GROUND_PHOTOS], folder)
        patches[label] = _read(chosen[half:][:_MOST_PATCH_PHOTOS], folder)
    origin = f"photographs of the folder {folder.name!r}, parted by photo_id: ground and patches"
    return _of_one_kind(PhotoSets(ground, patches, origin))


def _by_label_and_photo_id(folder: Path) -> dict[str, list[list[LabelledPhoto]]]:
    """Photographs of a folder as lists, one for each photo_id, by label."""
    try:
        photos = find_photos(folder)
    except TerrainError as error:
        raise SynthesisError(f"photographs: {error}") from error
    grouped: dict[str, dict[str, list[LabelledPhoto]]] = {}
    for photo in photos:
        grouped.setdefault(photo.label, {}).setdefault(photo.group, []).append(photo)
    return {label: list(groups.values()) for label, groups in grouped.items()}


def _read(photos: Iterable[LabelledPhoto], folder: Path) -> tuple[Photo, ...]:
    try:
        return tuple(
            Photo(photo.path.relative_to(folder).as_posix(), read_image(photo.path))
            for photo in photos
        )
    except TerrainError as error:
        raise SynthesisError(f"photographs: {error}") from error


def _of_one_kind(sets: PhotoSets) -> PhotoSets:
    """All grey if one is grey: a camera is either a colour camera or not."""
    everything = [
        photo for part in (sets.ground, sets.patches) for own in part.values() for photo in own
    ]
    if all(photo.image.ndim == 3 for photo in everything):
        return sets
    grey = [
        {
            terrain: tuple(Photo(photo.photo_id, to_grey(photo.image)) for photo in own)
            for terrain, own in part.items()
        }
        for part in (sets.ground, sets.patches)
    ]
    return PhotoSets(grey[0], grey[1], sets.origin)
