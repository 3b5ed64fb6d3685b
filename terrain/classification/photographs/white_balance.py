"""Copies of colour patches in another white balance, so that a model does not learn the light."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.classification.photographs.patches import LabelledPatches
from terrain.classification.photographs.trained_on import image_sum

# Red and blue, each times or divided by up to this beside green: shade, a low sun, a lamp, and
# cameras that correct some of it. With 1.3 fewer names hold in a warm light.
MOST_GAIN = 1.6
EVERY = 2  # of the patches; copies of all bring no more


def in_another_white_balance(patch: ByteImage) -> ByteImage:
    """A patch (H, W, 3) whose red and blue are as another light shows them.

    What is drawn depends on the pixels alone, so that the same patch gives the same copy.
    """
    rng = np.random.default_rng(int(image_sum(patch), 16))
    red, blue = MOST_GAIN ** rng.uniform(-1.0, 1.0, 2)
    gains = np.array([red, 1.0, blue])
    return np.asarray(np.clip(np.rint(patch * gains), 0, 255), np.uint8)


def with_white_balances(
    copies: LabelledPatches, patches: Sequence[ByteImage], labels: AnyArray, groups: AnyArray
) -> LabelledPatches:
    """The copies, then every second colour patch in another white balance.

    Parameters
    ----------
    copies : LabelledPatches
        Others, perhaps none.
    patches : sequence of ByteImage, each (S, S, 3)
    labels, groups : arrays, shape (n,)
        Terrain and photograph of each patch.
    """
    return replace(
        copies,
        images=[*copies.images, *map(in_another_white_balance, patches[::EVERY])],
        labels=[*copies.labels, *labels[::EVERY].tolist()],
        groups=[*copies.groups, *groups[::EVERY].tolist()],
    )
