"""Photographs of terrain, split from what the run drives over, and labelled patches of them."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import skimage.data

from odometry.arrays import ByteImage
from odometry.io.csv_table import write_csv_table
from odometry.io.files import atomic_write
from odometry.simulation.ground import GroundMap
from terrain.camera.camera import Camera
from terrain.classification.photographs.patches import LabelledPhoto, find_photos
from terrain.errors import SynthesisError, TerrainError
from terrain.images import read_image, to_grey
from terrain.region.region import Rectangle
from terrain.region.warp import ground_view
from terrain.synthesis.config import SynthesisConfig
from terrain.synthesis.texture import Texture
from terrain.synthesis.view import Illumination, Scene, View, encode_jpeg, expose, jpeg_image

BUILT_IN = ("brick", "grass", "gravel")

PATCH_JPEG_QUALITY = 95
_REACH_M = (0.05, 0.4)  # how far beyond the nearest possible place a patch may lie

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
                "are needed, one for the terrain and one for the patches"
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


@dataclass(frozen=True, eq=False)
class Patch:
    """One labelled patch, square."""

    terrain: str
    photo_id: str
    image: ByteImage


def patch_ahead(camera: Camera, edge_m: float) -> Rectangle:
    """Nearest square straight ahead that lies in the image whole.

    Raises
    ------
    SynthesisError
        If there is none within 10 m.
    """
    for middle_m in np.arange(0.0, 10.0, 0.02):
        square = _square(middle_m, edge_m)
        if camera.in_image(camera.ground_to_pixels(square.corners)).all():
            return square
    raise SynthesisError(f"the camera shows no square of {edge_m:.2f} m straight ahead within 10 m")


def render_patches(
    config: SynthesisConfig,
    view: View,
    photos: Mapping[str, tuple[Photo, ...]],
    rng: np.random.Generator,
) -> Iterator[Patch]:
    """Lay each photograph on the terrain, image it from random angles, warp it as a run does.

    Blur, noise and JPEG of the patches are therefore those of the run's regions.
    """
    edge_m = config.patch_size_px * config.metres_per_pixel
    nearest_m = patch_ahead(config.camera, edge_m).x_min + edge_m / 2
    for terrain, own in photos.items():
        frames = -(-config.patches_per_terrain // len(own))
        for photo in own:
            for middle_m in nearest_m + rng.uniform(*_REACH_M, size=frames):
                image = _look_at(photo, float(middle_m), config, view, rng)
                square = _square(float(middle_m), edge_m)
                patch = ground_view(image, config.camera, square, config.metres_per_pixel)
                yield Patch(terrain, photo.photo_id, patch)


def write_patches(folder: Path, patches: Iterator[Patch], config: SynthesisConfig) -> int:
    """Write `folder/<terrain>/*.jpg` and a manifest with their scale; return their number."""
    rows = []
    for i, patch in enumerate(patches):
        name = f"{patch.terrain}/{i:04d}.jpg"
        with atomic_write(folder / name) as part:
            part.write_bytes(encode_jpeg(patch.image, PATCH_JPEG_QUALITY))
        rows.append((name, patch.terrain, patch.photo_id, f"{config.metres_per_pixel:g}"))
    names = ("path", "class", "photo_id", "metres_per_pixel")
    columns = zip(names, np.array(rows).T, strict=True)
    write_csv_table(folder / "manifest.csv", dict(columns))
    return len(rows)


def _square(middle_m: float, edge_m: float) -> Rectangle:
    half = edge_m / 2
    return Rectangle(middle_m - half, middle_m + half, -half, half)


def _look_at(
    photo: Photo, middle_m: float, config: SynthesisConfig, view: View, rng: np.random.Generator
) -> ByteImage:
    """Frame of the run's camera over one photograph, laid so that the patch shows its inside."""
    height, width = photo.image.shape[:2]
    margin = np.minimum(0.45 * np.array([width, height]), 0.7 * config.patch_size_px)
    texture = Texture.laid(
        photo.image,
        config.metres_per_pixel,
        angle_rad=rng.uniform(-np.pi, np.pi),
        photo_point_px=rng.uniform(margin, np.array([width, height]) - margin),
        world_point=(middle_m, 0.0),
    )
    scene = Scene(view, GroundMap(np.empty(0), ("any",)), (texture,))
    light = Illumination.at(rng.uniform(0.0, 1000.0), (0.0, 0.0))
    image = expose(scene.brightness(np.zeros(3)), light, rng)
    return jpeg_image(encode_jpeg(image, config.jpeg_quality))
