"""Copies of patches in another light, so that a model does not learn that of its photographs."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.classification.photographs.patches import LabelledPatches
from terrain.classification.photographs.trained_on import image_sum
from terrain.images import to_grey

# Each is drawn between 1 / MOST and MOST. In colour red and blue beside green, as in shade, a low
# sun, under a lamp, and of cameras that correct some of it; with 1.3 fewer names hold in a warm
# light. In grey how bright a patch is, its gamma and its contrast; with 1.3 fewer names hold under
# another exposure, with 2.0 fewer under their own. In colour these make probabilities too high.
MOST_GAIN = 1.6
MOST_EXPOSURE, MOST_GAMMA, MOST_CONTRAST = 1.6, 1.6, 1.5
EVERY = 2  # of the patches; copies of all bring no more
WHITE = 255.0


def in_another_white_balance(patch: ByteImage) -> ByteImage:
    """A patch (H, W, 3) whose red and blue are as another light shows them.

    What is drawn depends on the pixels alone, so that the same patch gives the same copy.
    """
    red, blue = MOST_GAIN ** _draws_of(patch).uniform(-1.0, 1.0, 2)
    return _as_bytes(patch * np.array([red, 1.0, blue]))


def in_another_exposure(patch: ByteImage) -> ByteImage:
    """A patch (H, W) of another brightness, gamma and contrast about its mean, drawn likewise."""
    most = np.array([MOST_EXPOSURE, MOST_GAMMA, MOST_CONTRAST])
    exposure, gamma, contrast = most ** _draws_of(patch).uniform(-1.0, 1.0, 3)
    lit = exposure * WHITE * (patch / WHITE) ** gamma
    return _as_bytes(lit.mean() + contrast * (lit - lit.mean()))


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
        Whether the model looks at colour: then copies differ in white balance, else in exposure.
    """
    chosen = patches[::EVERY]
    if colour:
        lit = [in_another_white_balance(patch) for patch in chosen]
    else:
        lit = [in_another_exposure(to_grey(patch)) for patch in chosen]
    labels, groups = (values[::EVERY].tolist() for values in named)
    return replace(
        copies,
        images=[*copies.images, *lit],
        labels=[*copies.labels, *labels],
        groups=[*copies.groups, *groups],
    )


def _draws_of(patch: ByteImage) -> np.random.Generator:
    return np.random.default_rng(int(image_sum(patch), 16))


def _as_bytes(values: AnyArray) -> ByteImage:
    return np.asarray(np.clip(np.rint(values), 0, 255), np.uint8)
