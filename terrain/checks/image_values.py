"""Depth, exposure and detail of the pixels in the region ahead."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from odometry.checks.findings.finding import Finding, Level, counted
from terrain.image_depth import bits_held, in_words
from terrain.images import to_grey

MOST = 0.5  # share of the images of which something must hold
DARK, BRIGHT = 8, 247  # grey levels of 256 next to the ends, where noise is clipped
CLIPPED = 0.5  # share of such pixels from which too little texture is left
FLAT = 1.5  # standard deviation in grey levels: rounding and the sensor's noise make about as much
# Details of a pixel in grey levels, and as a share of the contrast. Photographs of terrain in
# focus: 1.7 to 19 and 0.045 to 0.6 (smooth concrete 0.4 and 0.13); blurred with a Gaussian of 4
# pixels and compressed: 0.25 to 0.65 and 0.006 to 0.09. Both must be small: the note is cautious.
DETAIL, DETAIL_SHARE = 0.6, 0.05


@dataclass(frozen=True)
class Values:
    """What the pixels of one image are like.

    Attributes
    ----------
    bits : int
        Depth in the file: 8 or 16.
    largest : int
        Value, as stored.
    dark, bright : float
        Shares of pixels near either end, in the region ahead as vision reads it.
    spread : float
        Standard deviation there, in grey levels of 256.
    detail : float
        Standard deviation of details of a pixel, in grey levels.
    """

    bits: int
    largest: int
    dark: float
    bright: float
    spread: float
    detail: float


def values_of(pixels: AnyArray, grey: ByteImage) -> Values:
    """Measure an image.

    Parameters
    ----------
    pixels : (H, W, ...)
        As stored.
    grey : (h, w)
        The region ahead in 8 bits.
    """
    smooth = cv2.GaussianBlur(grey.astype(np.float32), (0, 0), 1.0)
    spread = float(grey.std())
    return Values(
        8 * pixels.dtype.itemsize,
        int(pixels.max()),
        float(np.mean(grey <= DARK)),
        float(np.mean(grey >= BRIGHT)),
        spread,
        float((grey - smooth).std()),
    )


def grey_of(pixels: AnyArray) -> ByteImage:
    """Grey (H, W) of pixels as OpenCV stores them: B, G, R(, A)."""
    return to_grey(pixels if pixels.ndim == 2 else pixels[..., 2::-1])


def image_values(found: Sequence[Values]) -> Iterator[Finding]:
    """Depth of 12 bits in 16, exposure, blur."""
    if not found:
        return
    deep = [values for values in found if values.bits == 16]
    if deep:
        finding = _deep(deep)
        yield finding
        if finding.level is Level.WARNING:
            return  # too dark for that reason
    yield from _exposure(found)
    lively = [values for values in found if values.spread > FLAT]
    blurred = [v for v in lively if v.detail < min(DETAIL, DETAIL_SHARE * v.spread)]
    if lively and len(blurred) > MOST * len(found):
        yield Finding(
            "images_blurred",
            Level.NOTE,
            f"{len(blurred)} of {len(found)} images have hardly any detail of a pixel's size "
            f"(median {float(np.median([v.detail for v in blurred])):.2g} of 255 grey levels)",
            "Images may be blurred (focus, motion, a dirty lens) or enlarged, or the terrain is "
            "smooth: these cannot be distinguished here",
            "Look at an image: the texture of the terrain must be visible",
        )


def _deep(deep: Sequence[Values]) -> Finding:
    largest = max(values.largest for values in deep)
    bits = bits_held(largest)
    if bits is None:
        return Finding(
            "images_16_bit",
            Level.NOTE,
            f"{counted(len(deep), 'image')} of 16 bits, where the largest value is {largest}",
            "The camera stores 16 bits",
            "Nothing to do: they are read as 8 bits, 65535 as 255",
        )
    return Finding(
        "images_12_bit" if bits == 12 else "images_few_bits",
        Level.WARNING,
        in_words(len(deep), largest),
        f"The files hold {bits}-bit data in 16-bit images: far too dark when read as 16 bit",
        f"Multiply the values by {2 ** (16 - bits)}, or store 8 bits",
    )


def _exposure(found: Sequence[Values]) -> Iterator[Finding]:
    count = len(found)
    dark = sum(values.dark > CLIPPED for values in found)
    bright = sum(values.bright > CLIPPED for values in found)
    flat = sum(values.spread <= FLAT for values in found)
    if dark > MOST * count:
        yield _finding(
            "images_dark",
            f"in {dark} of {count} images most of the region ahead is at most {DARK} of 255",
            "Images are black or underexposed (night, a covered lens, exposure or gain too low)",
        )
    elif bright > MOST * count:
        yield _finding(
            "images_bright",
            f"in {bright} of {count} images most of the region ahead is at least {BRIGHT} of 255",
            "Images are white or overexposed (exposure or gain too high, sun in the lens)",
        )
    elif flat > MOST * count:
        yield _finding(
            "images_flat",
            f"in {flat} of {count} images the grey levels of the region ahead spread by less than "
            f"{FLAT}",
            "Images are of one colour: a covered lens, fog, or a driver that fills in",
        )


def _finding(name: str, seen: str, cause: str) -> Finding:
    return Finding(
        name, Level.WARNING, seen, cause, "Record again with other settings; leave vision out here"
    )
