"""Copies of patches in another light, so that a model does not learn that of its photographs."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.classification.photographs.patches import LabelledPatches
from terrain.classification.photographs.trained_on import image_sum
from terrain.images import to_grey

# Each is drawn between 1 / MOST and MOST: how bright a patch is, its gamma, its contrast, and of
# colour red and blue beside green: shade, a low sun, a lamp, and cameras that correct
# some of it. With 1.3 fewer names hold in another light, with exposures of 2 fewer in their own.
MOST_EXPOSURE, MOST_GAMMA, MOST_CONTRAST, MOST_GAIN = 1.6, 1.6, 1.5, 1.6
EVERY = 2  # of the patches; copies of all bring no more
WHITE = 255.0


def in_another_light(patch: ByteImage) -> ByteImage:
    """A patch, grey (H, W) or RGB (H, W, 3), as another light or exposure shows it.

    What is drawn depends on the pixels alone, so that the same patch gives the same copy.
    """
    rng = np.random.default_rng(int(image_sum(patch), 16))
    most = np.array([MOST_EXPOSURE, MOST_GAMMA, MOST_CONTRAST, MOST_GAIN, MOST_GAIN])
    exposure, gamma, contrast, red, blue = most ** rng.uniform(-1.0, 1.0, len(most))
    gains = np.array([red, 1.0, blue]) if patch.ndim == 3 else 1.0
    lit = exposure * WHITE * (np.minimum(patch * gains, WHITE) / WHITE) ** gamma
    middle = lit.mean()
    return np.asarray(np.clip(np.rint(middle + contrast * (lit - middle)), 0, WHITE), np.uint8)


def with_other_light(
    copies: LabelledPatches,
    patches: Sequence[ByteImage],
    named: tuple[AnyArray, AnyArray],
    *,
    colour: bool,
) -> LabelledPatches:
    """The copies, then every second patch in another light.

    Parameters
    ----------
    copies : LabelledPatches
        Others, perhaps none.
    patches : sequence of ByteImage, each (S, S) or (S, S, 3)
    named : two arrays, shape (n,)
        Terrain and photograph of each patch.
    colour : bool
        Whether the model looks at colour; else the copies are grey.
    """
    shown = patches[::EVERY] if colour else map(to_grey, patches[::EVERY])
    labels, groups = (values[::EVERY].tolist() for values in named)
    return replace(
        copies,
        images=[*copies.images, *map(in_another_light, shown)],
        labels=[*copies.labels, *labels],
        groups=[*copies.groups, *groups],
    )
