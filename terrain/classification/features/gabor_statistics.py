"""Gabor statistics of a patch: how strong its waves are, and how the strengths vary together.

Waves of four lengths in four directions. The features are the same for a patch that is mirrored
or turned by a quarter.

References
----------
Manjunath and Ma 1996, "Texture features for browsing and retrieval of image data", IEEE
Transactions on Pattern Analysis and Machine Intelligence 18, 837-842.
"""

from functools import cache

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.features.byte_moments import byte_moments, third_moments
from terrain.classification.features.filters import blur, rounded_bytes

# How often the patch is halved, and the wavelength then [px].
WAVES = ((0, 3.0), (0, 5.0), (1, 4.25), (2, 3.5))
WAVELENGTHS_PX = tuple(2**halvings * length for halvings, length in WAVES)
ANGLES_DEG = (0, 45, 90, 135)  # of the direction across the crests
SPREAD = 0.5  # sigma of the Gaussian, wavelengths
REACH = 2.5  # of the kernel on either side, sigmas
FAINT = 0.2  # greys; weaker waves are as good as none
STEPS = 32.0  # of the bytes, for each unit of the natural logarithm
SLOW_SIGMA_PX = 3.0  # of the slow change of grey that is taken away, at a quarter of the scale
PAIRS = np.triu_indices(len(WAVES))


def gabor_statistics(grey: AnyArray) -> FloatArray:
    """Statistics of the logarithms of Gabor energies of a patch.

    Parameters
    ----------
    grey : (rows, columns) array of float32

    Returns
    -------
    (46,) array, in units of the natural logarithm, its square and its cube
        For each wavelength the mean over directions (4), and how far the mean goes up and down
        once and twice over the directions (8). The covariance of two wavelengths in directions
        that are 0, 45 and 90 degrees apart (3 x 10). The third moment (4).
    """
    images = log_energies(grey)
    shape = (len(WAVES), len(ANGLES_DEG))
    means, covariance = byte_moments(images)
    by_angle = means.reshape(shape) / STEPS
    apart = covariance.ravel()[_places_apart()].mean(axis=2) / STEPS**2
    third = third_moments(images).reshape(shape).mean(axis=1) / STEPS**3
    over_angles = np.abs(np.fft.rfft(by_angle, axis=1))[:, 1:]
    return np.concatenate([by_angle.mean(axis=1), over_angles.ravel(), apart.ravel(), third])


def gabor_names() -> list[str]:
    """Names of the features, with wavelengths in px and angles in degrees."""
    lengths = [f"{length:g}" for length in WAVELENGTHS_PX]
    pairs = [f"{lengths[i]}_{lengths[j]}" for i, j in zip(*PAIRS, strict=True)]
    return [
        *(f"gabor_mean_{length}" for length in lengths),
        *(f"gabor_{times}_{length}" for length in lengths for times in ("once", "twice")),
        *(f"gabor_covariance_{apart}_{pair}" for apart in (0, 45, 90) for pair in pairs),
        *(f"gabor_third_{length}" for length in lengths),
    ]


def log_energies(grey: AnyArray) -> list[ByteImage]:
    """Energies as bytes, ``32 log(1 + energy / 0.2)``, half as large as the patch.

    16 images: the four directions of the first wavelength, then those of the next.
    """
    rows, columns = grey.shape
    coarse = blur(_reduced(grey, 4), SLOW_SIGMA_PX)
    slow = cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_LINEAR)
    levels = [np.asarray(cv2.subtract(grey, slow))]
    for _ in range(max(halvings for halvings, _ in WAVES)):
        levels.append(_reduced(levels[-1], 2))
    size = (max(columns // 2, 1), max(rows // 2, 1))
    offset = -STEPS * float(np.log(FAINT))
    images = []
    for halvings, wavelength_px in WAVES:
        how = cv2.INTER_AREA if halvings == 0 else cv2.INTER_LINEAR
        for energy in energies(levels[halvings], wavelength_px):
            logarithm = cv2.log(energy + np.float32(FAINT))
            if logarithm.shape != size[::-1]:
                logarithm = cv2.resize(logarithm, size, interpolation=how)
            images.append(rounded_bytes(logarithm, offset, STEPS))
    return images


def energies(grey: AnyArray, wavelength_px: float) -> list[AnyArray]:
    """Moduli of an image under complex Gabor kernels, one for each of ANGLES_DEG.

    A wave along a diagonal is a sum of products of waves across and down, so that all kernels are
    made of passes along rows and columns.
    """
    plain, cosine, sine, slant_cosine, slant_sine = _kernels(wavelength_px)

    def under(across: AnyArray, down: AnyArray) -> AnyArray:
        border = cv2.BORDER_REFLECT_101
        return np.asarray(cv2.sepFilter2D(grey, cv2.CV_32F, across, down, borderType=border))

    cc, ss = under(slant_cosine, slant_cosine), under(slant_sine, slant_sine)
    sc, cs = under(slant_sine, slant_cosine), under(slant_cosine, slant_sine)
    parts = (
        (under(cosine, plain), under(sine, plain)),
        (cv2.subtract(cc, ss), cv2.add(sc, cs)),
        (under(plain, cosine), under(plain, sine)),
        (cv2.add(cc, ss), cv2.subtract(sc, cs)),
    )
    return [np.asarray(cv2.magnitude(*part)) for part in parts]


@cache
def _kernels(wavelength_px: float) -> list[AnyArray]:
    """A Gaussian, and its product with waves along an axis and with their part on a diagonal."""
    sigma = SPREAD * wavelength_px
    reach = int(np.ceil(REACH * sigma))
    at = np.arange(-reach, reach + 1)
    gaussian = np.exp(-(at**2) / (2 * sigma**2))
    gaussian /= gaussian.sum()
    phase = 2 * np.pi / wavelength_px * at
    slant = phase * np.sqrt(0.5)
    waves = (np.ones(len(at)), np.cos(phase), np.sin(phase), np.cos(slant), np.sin(slant))
    return [(gaussian * wave).astype(np.float32) for wave in waves]


def _reduced(image: AnyArray, factor: int) -> AnyArray:
    size = (max(image.shape[1] // factor, 1), max(image.shape[0] // factor, 1))
    return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA))


@cache
def _places_apart() -> IntArray:
    """Which covariances (3, 10, 8) of the flat matrix are of directions 0, 45 and 90 degrees apart.

    Of 10 pairs of wavelengths; the mean of 8 is a feature.
    """
    shape = (len(WAVES), len(ANGLES_DEG))
    places = np.arange((len(WAVES) * len(ANGLES_DEG)) ** 2).reshape(shape * 2)
    angle = np.arange(len(ANGLES_DEG))
    apart = []
    for steps in (0, 1, 2):
        either = [places[:, angle, :, (angle + sign * steps) % len(angle)] for sign in (1, -1)]
        apart.append(np.concatenate(either)[:, *PAIRS].T)
    return np.stack(apart)
