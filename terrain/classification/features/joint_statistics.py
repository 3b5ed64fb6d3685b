"""Joint statistics of a patch: how its filtered copies vary together, pixel by pixel.

SFTA describes each copy alone. Here each pixel is a point whose coordinates are its greys in all
copies; the features are the means and the covariance of these points.

References
----------
Tuzel, Porikli and Meer 2006, "Region covariance: a fast descriptor for detection and
classification", ECCV.
Arsigny, Fillard, Pennec and Ayache 2006, "Log-Euclidean metrics for fast and simple calculus on
diffusion tensors", Magnetic Resonance in Medicine 56, 411-421.
"""

from functools import cache

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.features.byte_moments import byte_moments
from terrain.classification.features.copies import COLOUR_COPIES, GREY_COPIES, Copies
from terrain.classification.features.filters import Scales, blur, rounded_bytes

LEFT_OUT = {"grey_2", "grey_4"}  # smaller than the patch
LEFT_OUT |= {f"orientation_{sigma}" for sigma in (0.7, 1.4, 2.8)}  # they jump from 255 to 0
DIRECTION_SIGMAS_PX = (0.7, 1.4, 2.8)
SMALLEST_VARIANCE = 4.0  # greys squared, added to all: the logarithm of nothing is infinite
MEAN_UNIT = 50.0  # greys
CHROMATICITIES = ("redness", "yellowness", "slow_redness", "slow_yellowness")


def joint_statistics(copies: Copies, *, colour: bool) -> FloatArray:
    """Logarithm of the covariance of the copies of one patch, and their means.

    Distances between logarithms of covariances treat a variance that is twice as large as one
    that is half as large; those between covariances do not.

    Parameters
    ----------
    copies : Copies
        Of the patch.
    colour : bool
        Whether copies in colour and chromaticities take part.

    Returns
    -------
    (r (r + 3) / 2,) array
        For r images, all copies but for LEFT_OUT, directions and, of colour, chromaticities: the
        upper triangle of the matrix logarithm of their covariance [log of greys squared], row by
        row, then r means [50 greys].
    """
    images = [copies[name] for name in _copies_used(colour=colour)]
    for sigma_px in DIRECTION_SIGMAS_PX:
        images += directions(copies.scales, sigma_px)
    if colour:
        images += chromaticities(copies.image)
    means, covariance = byte_moments(images)
    values, vectors = np.linalg.eigh(covariance + SMALLEST_VARIANCE * np.eye(len(images)))
    logarithm = (vectors * np.log(values)) @ vectors.T
    return np.concatenate([logarithm[_upper(len(images))], means / MEAN_UNIT])


def joint_names(*, colour: bool) -> list[str]:
    """Names of the features: of each pair of images, then of each mean."""
    used = _copies_used(colour=colour)
    used += [f"{part}_{s}" for s in DIRECTION_SIGMAS_PX for part in ("along", "aslant")]
    used += CHROMATICITIES if colour else ()
    pairs = zip(*_upper(len(used)), strict=True)
    return [f"joint_{used[i]}_{used[j]}" for i, j in pairs] + [f"joint_mean_{of}" for of in used]


def _copies_used(*, colour: bool) -> list[str]:
    names = (*GREY_COPIES, *COLOUR_COPIES) if colour else GREY_COPIES
    return [name for name in names if name not in LEFT_OUT]


@cache
def _upper(size: int) -> tuple[IntArray, IntArray]:
    return np.triu_indices(size)


def directions(scales: Scales, sigma_px: float) -> list[ByteImage]:
    """Direction of the gradient, half turns alike, as cosine and sine of twice its angle.

    The first is 188 where the gradient points across or back and 68 where it points up or down;
    the second is 188 and 68 on the diagonals. Both are 128 where there is no gradient.
    """
    across, down = scales.gradient(sigma_px)
    across_2, down_2 = cv2.multiply(across, across), cv2.multiply(down, down)
    length_2 = cv2.add(across_2, down_2) + np.float32(0.05)
    cosine = cv2.divide(cv2.subtract(across_2, down_2), length_2, scale=60)
    sine = cv2.divide(cv2.multiply(across, down), length_2, scale=120)
    return [rounded_bytes(np.asarray(part), 128.0) for part in (cosine, sine)]


def chromaticities(image: ByteImage) -> list[ByteImage]:
    """Colour differences over brightness of an RGB image, and their slow changes over the patch.

    What `red_green` and `yellow_blue` show, indifferent to shadow.
    """
    red, green, blue = cv2.split(image.astype(np.float32))
    brightness = red + green + blue + 30
    parts = [(red - green) / brightness, ((red + green) / 2 - blue) / brightness]
    slow: list[AnyArray] = [blur(part, 2.0) for part in parts]
    changes = [part - cv2.mean(part)[0] for part in slow]
    return [rounded_bytes(300 * part, 128.0) for part in parts] + [
        rounded_bytes(1200 * part, 128.0) for part in changes
    ]
