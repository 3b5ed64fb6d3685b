"""Whether images of another camera would look unlike the training photographs, as far as is known.

Photographs of many cameras differ so much from each other that any image looks like one of them.
"""

from collections.abc import Callable, Iterator, Sequence

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.classification.likeness.likeness import FEWEST_IMAGES
from terrain.classification.likeness.look import look_of
from terrain.classification.likeness.training_look import TrainingLook

MOST_PHOTOS = 8  # of a terrain: a run shows few
# Photographs of one camera have 1, of as many cameras as photographs (pavements/) 0.2 to 0.8
LEAST_NOTICED = 0.9


def _darker(patch: ByteImage) -> AnyArray:
    return 0.5 * patch.astype(np.float64)


def _blurred(patch: ByteImage) -> AnyArray:
    return np.asarray(cv2.GaussianBlur(patch, (0, 0), 1.5))


def _noisy(patch: ByteImage) -> AnyArray:
    return patch + np.random.default_rng(0).normal(0.0, 12.0, patch.shape)


ALTERATIONS: tuple[Callable[[ByteImage], AnyArray], ...] = (_darker, _blurred, _noisy)


def noticed_share(
    look: TrainingLook, patches: Sequence[ByteImage], codes: AnyArray, groups: AnyArray
) -> float | None:
    """The share of altered training photographs that are unlike training, terrain by terrain.

    The photographs of a terrain (at most eight, a patch of each) are altered alike: half as
    bright, blurred by 1.5 px, or noisy by 12 greys, as by another light, focus or sensor. They are
    compared with the training photographs as they are, themselves among them.

    Parameters
    ----------
    look : TrainingLook
    patches : sequence of ByteImage
    codes, groups : (n,) arrays
        Terrains and photographs.

    Returns
    -------
    float or None
        None where no terrain has five photographs.
    """
    unlike = [
        look.compared(np.array([look_of(_bytes(change(patch))) for patch in run])).is_unlike is True
        for run in _runs(patches, codes, groups)
        for change in ALTERATIONS
    ]
    return float(np.mean(unlike)) if unlike else None


def may_pass_unnoticed(share: float | None) -> bool:
    """Whether images of another camera may look like training, by a `noticed_share`."""
    return share is not None and share < LEAST_NOTICED


def unnoticed(share: float | None) -> str | None:
    """What a `noticed_share` means for images that look like training; None if that is reliable."""
    if share is None or not may_pass_unnoticed(share):
        return None
    return (
        "images of another camera may pass as those of training, whose photographs differ so much "
        f"from each other: made darker, blurred or noisy {100 * share:.0f} % of them are noticed. "
        "Names that are not surely enough right are unknown, unless --same-camera says that the "
        "camera is that of training. Test the model on labelled images of the camera in use "
        "(classify MODEL FOLDER)"
    )


def _runs(
    patches: Sequence[ByteImage], codes: AnyArray, groups: AnyArray
) -> Iterator[list[ByteImage]]:
    """A patch of each of at most eight photographs of each terrain that has five."""
    for code in np.unique(codes):
        of = np.flatnonzero(codes == code)
        _, first = np.unique(groups[of], return_index=True)
        few = np.linspace(0, len(first) - 1, min(len(first), MOST_PHOTOS)).astype(int)
        if len(few) >= FEWEST_IMAGES:
            yield [patches[of[place]] for place in first[few]]


def _bytes(image: AnyArray) -> ByteImage:
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)
