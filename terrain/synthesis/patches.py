"""Labelled patches by the run's own camera, of terrain that the run never shows."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import ByteImage
from odometry.io.csv_table import write_csv_table
from odometry.io.files import atomic_write
from odometry.simulation.ground import GroundMap
from terrain.camera import Camera
from terrain.errors import SynthesisError
from terrain.region import Rectangle
from terrain.synthesis.config import SynthesisConfig
from terrain.synthesis.photos import Photo
from terrain.synthesis.texture import Texture
from terrain.synthesis.view import Illumination, Scene, View, encode_jpeg, expose, jpeg_image
from terrain.warp import ground_view

PATCH_JPEG_QUALITY = 95
_REACH_M = (0.05, 0.4)  # how far beyond the nearest possible place a patch may lie


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
