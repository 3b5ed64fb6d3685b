"""Ground seen from above: a rectangle of the ground as an image of known scale."""

import math

import cv2
import numpy as np

from odometry.arrays import ByteImage
from terrain.camera import Camera
from terrain.region import Rectangle


def ground_view(
    image: ByteImage, camera: Camera, rectangle: Rectangle, metres_per_pixel: float
) -> ByteImage:
    """Warp a rectangle of the ground to a view from above.

    Parameters
    ----------
    image : (H, W) or (H, W, 3)
        Raw image of the camera.
    camera : Camera
    rectangle : Rectangle
        In the image, see `predict_region`.
    metres_per_pixel : float
        Scale of the view. Where the image is finer, it is averaged, not skipped.

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
    rows, columns = view_shape(rectangle, metres_per_pixel)
    fineness = max(1, math.ceil(metres_per_pixel / ground_sampling_m(camera, rectangle)[0]))
    step = metres_per_pixel / fineness
    x = rectangle.x_max - step * (np.arange(rows * fineness) + 0.5)
    y = rectangle.y_max - step * (np.arange(columns * fineness) + 0.5)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    pixels = camera.ground_to_pixels(points).astype(np.float32)
    view = cv2.remap(image, pixels[..., 0], pixels[..., 1], cv2.INTER_LINEAR)
    return np.asarray(cv2.resize(view, (columns, rows), interpolation=cv2.INTER_AREA))


def pixel_view(image: ByteImage, camera: Camera, rectangle: Rectangle) -> ByteImage:
    """Crop the image to the pixels that a rectangle of the ground spans, without warping.

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


def ground_sampling_m(camera: Camera, rectangle: Rectangle) -> tuple[float, float]:
    """Finest and coarsest size of a pixel on the ground over a rectangle [m].

    The singular values of the map from ground to pixels at the corners, by a small step inwards:
    the finest and the coarsest direction need not be those of the robot's axes.
    """
    step = 1e-3
    corners = rectangle.corners
    inwards = step * np.sign(corners.mean(axis=0) - corners)
    here = camera.ground_to_pixels(corners)
    moved = [camera.ground_to_pixels(corners + inwards * axis) - here for axis in np.eye(2)]
    pixels_per_metre = np.linalg.svd(np.stack(moved, axis=-1) / step, compute_uv=False)
    return float(1 / pixels_per_metre.max()), float(1 / pixels_per_metre.min())
