"""Terrains whose photographs are less sharp, or noisier, than those of any other, by their pixels.

A lens, a sensor and a rough surface give spectra that fall evenly in logarithms, whatever the
terrain. Where an image was blurred or enlarged its spectrum ends before the finest detail that
pixels can hold, with a kink there and nothing but rounding beyond. Noise is as strong at the finest
detail as at twice its size, and no texture makes an image less noisy than its sensor.
"""

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import ByteImage, FloatArray
from terrain.classification.photographs.photo_origins import FEWEST

SHORTEST_PX, LONGEST_PX = 64, 512  # side of what is looked at, in the middle
BLOCK_PX = 32
BANDS = (0.06, 0.09, 0.13, 0.18, 0.25, 0.35, 0.5, 0.72)  # waves per pixel: half an octave each
LEAST_TEXTURED = 0.1  # of the blocks: where noise shows
ROUNDING = 1e-3  # grey levels squared, below that of rounding
MOST_PHOTOS = 50  # of a terrain

# Of natural logarithms of power, but MOST
FINEST, FINE = 5, 6  # bands where a terrain must have a kink, and where others have none
KINK, KINK_APART = 0.8, 0.2  # of nine in ten real photographs 0.7 at most
NOTHING = 1.0  # at the finest detail; noise of two grey levels has more
WHITE, NOISE, NOISE_APART = -0.25, 1.4, 1.4  # 1.4: four times the power, of two grey levels
MOST = 0.8  # of the photographs of a terrain

LESS_SHARP = "less sharp"
NOISIER = "noisier"


def set_apart_by_pixels(label_of: Mapping[Path, str]) -> dict[str, str]:
    """Terrains most of whose photographs are less sharp or noisier than most of any other.

    Parameters
    ----------
    label_of : mapping of Path to str
        The terrain of each photograph. Those that are not read or are small are left out.

    Returns
    -------
    dict of str to str
        `LESS_SHARP` or `NOISIER` by terrain.
    """
    return apart({terrain: _spectra(label_of, terrain) for terrain in set(label_of.values())})


def apart(spectra_of: Mapping[str, FloatArray]) -> dict[str, str]:
    """The same by the spectra (n, 2, bands) of each terrain."""
    spectra_of = {terrain: of for terrain, of in sorted(spectra_of.items()) if len(of)}
    kinks = {terrain: kink(of[:, 0, -FINE:]) for terrain, of in spectra_of.items()}
    floors = {terrain: of[:, 1, -1] for terrain, of in spectra_of.items()}
    found = {}
    for terrain, of in spectra_of.items():
        if len(spectra_of) < 2 or len(of) < FEWEST:
            continue
        own, others = _bounds({**kinks, terrain: kink(of[:, 0, -FINEST:])}, terrain)
        noise, others_noise = _bounds(floors, terrain)
        if np.median(of[:, 0, -1]) < NOTHING and own > KINK > others and own > others + KINK_APART:
            found[terrain] = LESS_SHARP
        elif np.median(of[:, 1, -1] - of[:, 1, -2]) > WHITE and (
            noise > NOISE and noise > others_noise + NOISE_APART
        ):
            found[terrain] = NOISIER
    return found


def kink(spectra: FloatArray) -> FloatArray:
    """How sharply spectra (n, bands) end, (n,): their largest bend upwards."""
    return np.asarray(np.diff(spectra, 2).max(axis=1))


def spectrum(grey: ByteImage) -> FloatArray:
    """Logarithms (2, bands) of power in grey levels squared: of all blocks, of the least textured.

    Parameters
    ----------
    grey : ByteImage, shape (H, W)
        At least `SHORTEST_PX` wide and high; its middle is looked at.
    """
    rows, columns = ((length - min(length, LONGEST_PX)) // 2 for length in grey.shape)
    middle = grey[rows : rows + LONGEST_PX, columns : columns + LONGEST_PX].astype(np.float64)
    blocks = np.lib.stride_tricks.sliding_window_view(middle, (BLOCK_PX, BLOCK_PX))
    blocks = blocks[:: BLOCK_PX // 2, :: BLOCK_PX // 2].reshape(-1, BLOCK_PX, BLOCK_PX)
    window = np.outer(np.hanning(BLOCK_PX), np.hanning(BLOCK_PX))
    waves = np.fft.rfft2((blocks - blocks.mean(axis=(1, 2), keepdims=True)) * window)
    power = np.abs(waves) ** 2 / (window**2).sum()
    waves_per_px = np.hypot(np.fft.fftfreq(BLOCK_PX)[:, None], np.fft.rfftfreq(BLOCK_PX))
    ends = pairwise(BANDS)
    of_block = np.stack(
        [
            power[:, (waves_per_px >= low) & (waves_per_px < high)].mean(axis=1)
            for low, high in ends
        ],
        axis=1,
    )
    by_texture = np.argsort(of_block[:, :4].sum(axis=1))
    least = by_texture[: max(int(LEAST_TEXTURED * len(by_texture)), 1)]
    return np.log(np.stack([of_block.mean(axis=0), of_block[least].mean(axis=0)]) + ROUNDING)


def _bounds(values: Mapping[str, FloatArray], terrain: str) -> tuple[float, float]:
    """What most values of a terrain lie above, and what most of each other terrain lie below."""
    others = [np.quantile(of, MOST) for name, of in values.items() if name != terrain]
    return float(np.quantile(values[terrain], 1 - MOST)), float(max(others))


def _spectra(label_of: Mapping[Path, str], terrain: str) -> FloatArray:
    """Spectra (n, 2, bands) of some photographs of a terrain, spread evenly."""
    photos = [photo for photo, label in label_of.items() if label == terrain]
    chosen = np.linspace(0, len(photos) - 1, min(len(photos), MOST_PHOTOS)).astype(int)
    spectra = []
    for place in chosen.tolist():
        flags = cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION
        grey = cv2.imread(str(photos[place]), flags)
        if grey is not None and min(grey.shape) >= SHORTEST_PX:
            spectra.append(spectrum(np.asarray(grey, np.uint8)))
    return np.array(spectra).reshape(-1, 2, len(BANDS) - 1)
