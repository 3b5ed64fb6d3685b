"""Zones of terrain laid along the way, each of one or more photographs."""

from collections.abc import Mapping

import numpy as np

from odometry.simulation.ground import GroundMap
from terrain.errors import SynthesisError
from terrain.synthesis.config import SynthesisConfig
from terrain.synthesis.photos import Photo
from terrain.synthesis.texture import Texture


def lay_out(
    config: SynthesisConfig, photos: Mapping[str, tuple[Photo, ...]], rng: np.random.Generator
) -> tuple[GroundMap, tuple[Texture, ...]]:
    """Ground of the run and the texture of each of its strips.

    The run starts at world x = 0, where the first zone begins; a zone whose terrain has several
    photographs is parted into as many strips.

    Raises
    ------
    SynthesisError
        If a zone names a terrain without photographs.
    """
    for zone in config.zones:
        if zone not in photos:
            raise SynthesisError(
                f"there are no photographs of {zone!r}; there are of: {', '.join(sorted(photos))}"
            )
    strips = [
        (zone, photo, config.zone_length_m / len(photos[zone]))
        for zone in config.zones
        for photo in photos[zone]
    ]
    lengths_m = np.array([length for _, _, length in strips])
    first, second = rng.uniform(0.0, 2 * np.pi, size=2)
    ground = GroundMap(
        np.cumsum(lengths_m)[:-1],
        tuple(zone for zone, _, _ in strips),
        config.edge_wave_m,
        (float(first), float(second)),
    )
    textures = tuple(
        Texture.laid_at_random(photo.image, config.metres_per_pixel, rng) for _, photo, _ in strips
    )
    return ground, textures
