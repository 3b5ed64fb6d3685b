"""Altered copies of photographs, as another camera, distance or light might have shown them."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.classification.photographs.opaque import opaque
from terrain.classification.photographs.patches import LabelledPatches, LabelledPhoto, cut_patches
from terrain.classification.photographs.trained_on import image_sum
from terrain.images import read_image


@dataclass(frozen=True)
class Augmentation:
    """How far copies differ from their photograph; each copy draws its own share of each.

    Attributes
    ----------
    per_photo : int
        Copies of a photograph at the most; no more than patches fit into it.
    largest_crop : float
        A crop is 1 to so many times as wide as a patch, and is reduced to a patch.
    blur_px : float
        Largest standard deviation of a Gaussian blur.
    contrast : float
        Contrast and gamma are multiplied or divided by up to this.
    brightness : float
        Grey levels are raised or lowered by up to this.
    noise : float
        Largest standard deviation of noise, in grey levels.
    jpeg_quality : int
        Lowest quality of JPEG, 1 to 100.
    seed : int

    Examples
    --------
    >>> from terrain.classification.photographs.augmentation import Augmentation
    >>> Augmentation(largest_crop=1.0).per_photo  # photographs of a known scale
    20
    """

    per_photo: int = 20
    largest_crop: float = 8.0
    blur_px: float = 3.0
    contrast: float = 1.7
    brightness: float = 40.0
    noise: float = 8.0
    jpeg_quality: int = 30
    seed: int = 0


def load_copies(
    photos: Sequence[LabelledPhoto], size_px: int, settings: Augmentation
) -> LabelledPatches:
    """Read photographs and draw altered patches of each; the same input gives the same copies.

    What is drawn depends on the pixels of a photograph and the seed, not on its name or on the
    other photographs. One that is smaller than a patch, or transparent in part, has no copies.

    Parameters
    ----------
    photos : sequence of LabelledPhoto
    size_px : int
        Side of a patch.
    settings : Augmentation

    Raises
    ------
    ImageError
        If a photograph cannot be read.
    """
    copies = LabelledPatches()
    for photo in photos:
        image = read_image(photo.path)
        content = image_sum(image)
        count = min(settings.per_photo, len(cut_patches(image, size_px, max(size_px // 2, 1))))
        if opaque(photo.path) is not None:
            count = 0
        rng = np.random.default_rng([settings.seed, int(content, 16)])
        copies.images.extend(altered(image, size_px, settings, rng) for _ in range(count))
        copies.labels.extend([photo.label] * count)
        copies.groups.extend([photo.group] * count)
        copies.photos.extend([photo.path] * count)
        copies.image_sums.append(content)
    return copies


def altered(
    image: ByteImage, size_px: int, settings: Augmentation, rng: np.random.Generator
) -> ByteImage:
    """One altered patch: cropped, blurred, relit, made noisy and compressed, as a camera does it.

    Parameters
    ----------
    image : ByteImage, shape (rows, columns) or (rows, columns, 3)
        At least one patch wide and high.
    size_px : int
        Side of the patch.
    settings : Augmentation
    rng : Generator
    """
    patch = _crop(image, size_px, settings.largest_crop, rng)
    blur_px = settings.blur_px * rng.uniform() ** 2  # a slight blur is likelier than a strong one
    grey = cv2.GaussianBlur(patch, (0, 0), blur_px + 0.01).astype(np.float64)
    gamma, contrast = settings.contrast ** rng.uniform(-1.0, 1.0, 2)
    grey = 255.0 * (grey / 255.0) ** gamma
    middle = grey.mean()
    grey = middle + settings.brightness * rng.uniform(-1.0, 1.0) + contrast * (grey - middle)
    grey += settings.noise * rng.uniform() ** 2 * rng.standard_normal(grey.shape)
    quality = int(rng.integers(settings.jpeg_quality, 101))
    return _as_jpeg(np.clip(np.rint(grey), 0, 255).astype(np.uint8), quality)


def _crop(
    image: ByteImage, size_px: int, largest_crop: float, rng: np.random.Generator
) -> ByteImage:
    """A square at random, reduced to a patch; the logarithm of its side is uniform."""
    most = min(largest_crop, min(image.shape[:2]) / size_px)
    side = int(size_px * np.exp(rng.uniform(0.0, np.log(most))))
    top, left = (int(rng.integers(0, length - side + 1)) for length in image.shape[:2])
    square = image[top : top + side, left : left + side]
    return np.asarray(cv2.resize(square, (size_px, size_px), interpolation=cv2.INTER_AREA))


def _as_jpeg(image: ByteImage, quality: int) -> ByteImage:
    data: AnyArray = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
    return np.asarray(cv2.imdecode(data, cv2.IMREAD_UNCHANGED))
