"""The view from above: a rectangle of terrain as an image of known scale, that of the patches."""

import math
from functools import lru_cache

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.camera.camera import Camera
from terrain.classification.answer import Classifier
from terrain.region.region import COARSE, Rectangle


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


def ground_view(
    image: ByteImage,
    camera: Camera,
    rectangle: Rectangle,
    metres_per_pixel: float,
    middle: tuple[int, int] | None = None,
) -> ByteImage:
    """Warp a rectangle of the terrain to a view from above.

    Parameters
    ----------
    image : (H, W) or (H, W, 3)
        Raw image of the camera.
    camera : Camera
    rectangle : Rectangle
        In the image, see `predict_region`.
    metres_per_pixel : float
        Scale of the view. Where the image is finer, it is averaged, not skipped.
    middle : (int, int), optional
        Rows and columns in the middle of the view that are wanted; by default all.

    Returns
    -------
    (rows, columns) or (rows, columns, 3)
        Far is up, left is left. Sides are rounded down to whole pixels.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> camera = terrain.Camera.from_table(run.settings["camera"])
    >>> image = terrain.read_image(run.folder / "images" / "000000.jpg")
    >>> ahead = terrain.Rectangle(x_min=0.8, x_max=1.4, y_min=-0.3, y_max=0.3)
    >>> terrain.ground_view(image, camera, ahead, metres_per_pixel=0.01).shape
    (60, 60)
    """
    whole = view_shape(rectangle, metres_per_pixel)
    rows, columns = middle or whole
    top, left = (whole[0] - rows) // 2, (whole[1] - columns) // 2
    fineness = max(1, math.ceil(metres_per_pixel / ground_sampling_m(camera, rectangle)[0]))
    step = metres_per_pixel / fineness
    far_left = rectangle.x_max - top * metres_per_pixel, rectangle.y_max - left * metres_per_pixel
    u, v = _pixels(camera, far_left, step, (rows * fineness, columns * fineness))
    view = cv2.remap(image, u, v, cv2.INTER_LINEAR)
    return np.asarray(cv2.resize(view, (columns, rows), interpolation=cv2.INTER_AREA))


def _pixels(
    camera: Camera, far_left: tuple[float, float], step_m: float, shape: tuple[int, int]
) -> tuple[AnyArray, AnyArray]:
    """Where the middles of cells from a corner on appear, u and v (rows, columns) as float32.

    `Camera.ground_to_pixels` by OpenCV, without a check where the lens model ends. Depth is
    linear on the ground, and in front of the camera the tangent of the angle off the axis is
    quasi-convex: what holds at the corners of a rectangle holds within.
    """
    x, y = far_left[0] - step_m / 2, far_left[1] - step_m / 2
    ground_of_cell = np.array([[0.0, -step_m, x], [-step_m, 0.0, y], [0.0, 0.0, 1.0]])
    cell_of_ray = np.linalg.inv(camera.ground_to_ray @ ground_of_cell)
    lens = camera.distortion if camera.distortion.size else np.zeros(4)
    u, v = cv2.initUndistortRectifyMap(
        camera.matrix, lens, cell_of_ray, np.eye(3), shape[::-1], cv2.CV_32FC1
    )
    return u, v


def pixel_view(image: ByteImage, camera: Camera, rectangle: Rectangle) -> ByteImage:
    """Crop the image to the pixels that a rectangle of the terrain spans, without warping.

    For a classifier whose training patches have no metric scale.
    """
    pixels = camera.ground_to_pixels(rectangle.corners)
    left, top = np.floor(pixels.min(axis=0)).astype(int)
    right, bottom = np.ceil(pixels.max(axis=0)).astype(int)
    return image[max(top, 0) : bottom + 1, max(left, 0) : right + 1]


def view_shape(rectangle: Rectangle, metres_per_pixel: float) -> tuple[int, int]:
    """Rows and columns of the view of a rectangle."""
    rows = int((rectangle.x_max - rectangle.x_min) / metres_per_pixel + 1e-9)
    columns = int((rectangle.y_max - rectangle.y_min) / metres_per_pixel + 1e-9)
    return rows, columns


@lru_cache(maxsize=16)  # needed to choose a region, and again for its view
def ground_sampling_m(camera: Camera, rectangle: Rectangle) -> tuple[float, float]:
    """Finest and coarsest size of a pixel on the ground over a rectangle [m].

    The singular values of the map from ground to pixels at the corners, by a small step inwards:
    the finest and the coarsest direction need not be those of the robot's axes.
    """
    step = 1e-3
    corners = rectangle.corners
    inwards = step * np.sign(corners.mean(axis=0) - corners)
    here, *moved = camera.ground_to_pixels(
        np.stack([corners, *(corners + inwards * axis for axis in np.eye(2))])
    )
    derivatives = np.stack([there - here for there in moved], axis=-1) / step
    pixels_per_metre = np.linalg.svd(derivatives, compute_uv=False)
    return float(1 / pixels_per_metre.max()), float(1 / pixels_per_metre.min())
