"""Filtered copies of a grey patch: SFTA describes each as a texture.

Every filter takes the `Scales` of a grey patch, or its RGB image, and returns an 8-bit image.
Gains are fixed where they keep the contrast of the terrain, and relative to the patch
where it is not.
"""

from collections.abc import Callable
from functools import lru_cache

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.classification.features.orientation import half_turn_bytes

WIDE_PX = 10.0  # sigma
LEAST_REDUCED_PX = 32  # of the shorter side
QUARTER = 4
KEPT, MOST_KEPT_PX = 8, 2**16  # patches, and pixels of one
# variance of the mean over a square of pixels, and of linear interpolation between such means
SPREAD_OF_REDUCING_PX2 = (QUARTER**2 - 1) / 12 + QUARTER**2 / 6


class Scales:
    """A grey patch and what several filters need of it, computed once.

    Parameters
    ----------
    grey : (rows, columns) array
        Taken as float32.
    """

    def __init__(self, grey: AnyArray) -> None:
        self.grey: AnyArray = grey.astype(np.float32)
        self._blurred: dict[float, AnyArray] = {}
        self._gradients: dict[float, tuple[AnyArray, AnyArray]] = {}

    def blurred(self, sigma_px: float) -> AnyArray:
        """The patch under a Gaussian of `sigma_px`."""
        if sigma_px not in self._blurred:
            self._blurred[sigma_px] = blur(self.grey, sigma_px)
        return self._blurred[sigma_px]

    def gradient(self, sigma_px: float) -> tuple[AnyArray, AnyArray]:
        """Its derivatives across and down, greys a pixel."""
        if sigma_px not in self._gradients:
            smooth = self.blurred(sigma_px)
            across = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=0.125)
            down = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=0.125)
            self._gradients[sigma_px] = np.asarray(across), np.asarray(down)
        return self._gradients[sigma_px]


def latest_scales(grey: ByteImage) -> Scales:
    """`Scales` of a patch; those of the latest small ones are kept.

    A run asks twice for those of an image's patches: for their features, and for their look.
    """
    if grey.size > MOST_KEPT_PX:
        return Scales(grey)
    return _latest_scales(grey.tobytes(), grey.shape)


@lru_cache(maxsize=KEPT)
def _latest_scales(content: bytes, shape: tuple[int, ...]) -> Scales:
    return Scales(np.frombuffer(content, np.uint8).reshape(shape))


Filter = Callable[[Scales], ByteImage]
ColourFilter = Callable[[ByteImage], ByteImage]


def reduced(factor: int) -> Filter:
    """Average over squares of `factor` x `factor` pixels: a coarser scale of the grey image."""

    def apply(scales: Scales) -> ByteImage:
        grey = scales.grey
        size = (max(grey.shape[1] // factor, 1), max(grey.shape[0] // factor, 1))
        return rounded_bytes(cv2.resize(grey, size, interpolation=cv2.INTER_AREA))

    return apply


def band_pass(sigma_px: float) -> Filter:
    """Difference of Gaussians of `sigma_px` and its double, 8 grey levels a level."""
    return lambda scales: rounded_bytes(
        128 + 8 * (scales.blurred(sigma_px) - scales.blurred(2 * sigma_px))
    )


def gradient_magnitude(sigma_px: float) -> Filter:
    """Logarithm of the gradient at `sigma_px`: the strength of edges, over decades."""

    def apply(scales: Scales) -> ByteImage:
        across, down = scales.gradient(sigma_px)
        return rounded_bytes(90 + 40 * np.log(_length(across, down) + 0.2))

    return apply


def gradient_orientation(sigma_px: float) -> Filter:
    """Direction of the gradient at `sigma_px`, modulo half a turn: indifferent to contrast."""

    def apply(scales: Scales) -> ByteImage:
        across, down = scales.gradient(sigma_px)
        return half_turn_bytes(across, down)

    return apply


def local_contrast(sigma_px: float) -> Filter:
    """Local contrast normalisation: grey less its local mean, in local standard deviations."""

    def apply(scales: Scales) -> ByteImage:
        grey, mean = scales.grey, scales.blurred(sigma_px)
        variance = np.maximum(blur(grey * grey, sigma_px) - mean * mean, 0)
        return rounded_bytes(128 + 50 * (grey - mean) / (np.sqrt(variance) + 1.5))

    return apply


def coherence(sigma_px: float) -> Filter:
    """Coherence of the structure tensor at `sigma_px`: 255 for lines, 0 for grains."""

    def apply(scales: Scales) -> ByteImage:
        across, down = scales.gradient(sigma_px)
        xx, yy, xy = (blur(p, 2 * sigma_px) for p in (across * across, down * down, across * down))
        return rounded_bytes(255 * _length(xx - yy, 2 * xy) / (xx + yy + 1e-3))

    return apply


def red_green(image: ByteImage) -> ByteImage:
    """Red less green of an RGB image (rows, columns, 3), 2 grey levels a level."""
    red, green, _ = cv2.split(image.astype(np.float32))
    return rounded_bytes(128 + 2 * (red - green))


def yellow_blue(image: ByteImage) -> ByteImage:
    """Mean of red and green less blue of an RGB image, 2 grey levels a level."""
    red, green, blue = cv2.split(image.astype(np.float32))
    return rounded_bytes(128 + 2 * ((red + green) / 2 - blue))


def blur(image: AnyArray, sigma_px: float) -> AnyArray:
    """The image under a Gaussian of `sigma_px`; a wide one blurs the image reduced to a quarter.

    On photographs that is within 0.12 grey of the Gaussian itself (root mean square), and 1.2 at
    most, at the edge, where the mirror lies half a pixel farther out.
    """
    rows, columns = image.shape
    if sigma_px < WIDE_PX or min(rows, columns) < LEAST_REDUCED_PX:
        return np.asarray(cv2.GaussianBlur(image, (0, 0), sigma_px))
    size = (columns // QUARTER, rows // QUARTER)
    small = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    left_px = float(np.sqrt(sigma_px**2 - SPREAD_OF_REDUCING_PX2)) / QUARTER
    slow = cv2.GaussianBlur(small, (0, 0), left_px, borderType=cv2.BORDER_REFLECT)
    return np.asarray(cv2.resize(slow, (columns, rows), interpolation=cv2.INTER_LINEAR))


def _length(across: AnyArray, down: AnyArray) -> AnyArray:
    """`np.hypot` of float32 but for the last digit; it takes less time."""
    squared = across * across
    squared += down * down
    return np.asarray(np.sqrt(squared, out=squared))


def rounded_bytes(image: AnyArray, offset: float = 0.0, gain: float = 1.0) -> ByteImage:
    """Times `gain`, with `offset` added, rounded, half to even, and held within 0 to 255."""
    return np.asarray(cv2.addWeighted(image, gain, image, 0.0, offset, dtype=cv2.CV_8U))
