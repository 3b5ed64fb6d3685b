"""Whether the image of a rectangle has the scale of the training patches."""

import math

import numpy as np

from terrain.camera import Camera
from terrain.classification.classifier import Classifier
from terrain.region import COARSE, Rectangle
from terrain.warp import ground_sampling_m, view_shape


def scale_mismatch(
    classifier: Classifier, camera: Camera, rectangle: Rectangle, coarsest: float
) -> str:
    """Why a rectangle cannot be compared with the training patches, or "".

    Parameters
    ----------
    classifier : Classifier
    camera : Camera
    rectangle : Rectangle
        In the image.
    coarsest : float
        See `RegionConfig`.
    """
    scale, size_px = classifier.metres_per_pixel, classifier.patch_size_px
    if scale is None:
        pixels = camera.ground_to_pixels(rectangle.corners)
        smallest = float(np.min(pixels.max(axis=0) - pixels.min(axis=0)))
        return "" if smallest >= size_px else "the region is smaller than a training patch"
    if min(view_shape(rectangle, scale)) < size_px:
        return "the region is smaller than a training patch"
    if ground_sampling_m(camera, rectangle)[1] > coarsest * scale:
        return COARSE
    return ""


def coarsest_m(classifier: Classifier, coarsest: float) -> float:
    """Largest size of a pixel on the terrain that a classifier accepts [m]; see `RegionConfig`."""
    scale = classifier.metres_per_pixel
    return math.inf if scale is None else coarsest * scale
