"""Where the terrain of one image is in the next one, and images part by part."""

from functools import lru_cache

import cv2
import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.geometry import se2
from terrain.camera.camera import Camera

# Details between these sizes [px] are compared: light, vignetting and blocks of JPEG do not count
FINEST_PX, COARSEST_PX = 1.0, 4.0
NODE_PX = 8  # between such pixels the way of terrain is interpolated, off by 0.1 px at the most


def places_at(camera: Camera, width_px: int, pixels: FloatArray) -> FloatArray:
    """Terrain (N, 2) [m] that is at pixels (N, 2) of an image reduced to a width."""
    times = camera.image_size[0] / width_px
    return camera.pixels_to_ground((pixels + 0.5) * times - 0.5)


def pixels_after(camera: Camera, width_px: int, step: FloatArray, places: FloatArray) -> FloatArray:
    """Where terrain (N, 2) [m] is in a reduced image after a step (3,); NaN where nowhere.

    The step is x, y [m], yaw [rad] of the second robot frame in the first.
    """
    times = camera.image_size[0] / width_px
    there = camera.ground_to_pixels(se2.transform(se2.inverse(step), places))
    return np.asarray((there + 0.5) / times - 0.5)


@lru_cache(maxsize=4)  # of the images that a camera takes one after the other
def places_of_squares(camera: Camera, shape: tuple[int, int], size_px: int) -> FloatArray:
    """Terrain (N, 2) [m] in the `middles` of squares of a reduced image of a shape (h, w)."""
    return places_at(camera, shape[1], middles(shape, size_px))


@lru_cache(maxsize=4)
def _places_of_nodes(camera: Camera, height: int, width: int) -> FloatArray:
    """Terrain (rows, columns, 2) [m] at the middle of every square of NODE_PX, one row beyond."""
    rows, columns = (
        np.arange(-NODE_PX, length + NODE_PX, NODE_PX) + (NODE_PX - 1) / 2
        for length in (height, width)
    )
    nodes = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    return places_at(camera, width, nodes).reshape(len(rows), len(columns), 2)


def carried_back(
    camera: Camera, image: AnyArray, step: FloatArray, size_px: int
) -> tuple[AnyArray, BoolArray, BoolArray]:
    """A reduced image (h, w) after a step, its terrain where it was before, square by square.

    Parameters
    ----------
    camera : Camera
    image : (h, w)
    step : (3,)
        x, y [m], yaw [rad] of the second robot frame in the first.
    size_px : int
        Of the squares, a multiple of NODE_PX.

    Returns
    -------
    (h', w')
        The block round all squares whose terrain is still in the image; the image itself where
        there is none.
    (K,) booleans
        Which squares of the whole image lie in the block, row by row.
    (K',) booleans
        The terrain of which squares of the block is still in the image.
    """
    height, width = image.shape
    places = _places_of_nodes(camera, height, width)
    there = pixels_after(camera, width, step, places.reshape(-1, 2)).reshape(places.shape)
    nodes = there.astype(np.float32)
    known = _squares_within(nodes, (height, width), size_px)
    if not known.any():
        return image, np.ones(known.size, dtype=bool), known.ravel()
    rows, columns = (_span(known, axis) for axis in (1, 0))
    in_block = np.zeros(known.shape, dtype=bool)
    in_block[rows, columns] = True
    times = size_px // NODE_PX
    block = nodes[tuple(slice(of.start * times, of.stop * times + 2) for of in (rows, columns))]
    size = block.shape[1] * NODE_PX, block.shape[0] * NODE_PX
    at_pixels = cv2.resize(block, size, interpolation=cv2.INTER_LINEAR)
    at_pixels = at_pixels[NODE_PX:-NODE_PX, NODE_PX:-NODE_PX]
    carried = cv2.remap(  # type: ignore[call-overload]
        image, at_pixels, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    return np.asarray(carried), in_block.ravel(), known[rows, columns].ravel()


def _squares_within(nodes: AnyArray, shape: tuple[int, int], size_px: int) -> BoolArray:
    """Whether the terrain of squares (rows, columns) is in an image, by the pixels of its nodes.

    The nodes round it must be somewhere: up to them terrain is interpolated.
    """
    height, width = shape
    inside = cv2.inRange(nodes, (0.0, 0.0), (width - 1.0, height - 1.0))  # NaN is not
    somewhere = np.isfinite(nodes[..., 0]).astype(np.uint8)
    inside = cv2.min(inside, cv2.erode(somewhere, np.ones((3, 3))))
    inside = inside[1:, 1:][: height // NODE_PX, : width // NODE_PX]
    squares = tiles(inside, size_px // NODE_PX).all(axis=1)
    return np.asarray(squares.reshape(height // size_px, width // size_px))


def _span(found: BoolArray, over: int) -> slice:
    """From the first to the last row (over columns, 1) or column (over rows, 0) with any."""
    places = np.flatnonzero(found.any(axis=over))
    return slice(int(places[0]), int(places[-1]) + 1)


def details_between(image: AnyArray) -> AnyArray:
    """What a grey image (h, w) shows between FINEST_PX and COARSEST_PX, as float32."""
    values = image.astype(np.float32)
    fine, coarse = (cv2.GaussianBlur(values, (0, 0), size) for size in (FINEST_PX, COARSEST_PX))
    return np.asarray(fine - coarse)


@lru_cache(maxsize=4)  # as above
def middles(shape: tuple[int, ...], size_px: int) -> FloatArray:
    """Middles (N, 2) of squares in an image of a shape (h, w), row by row."""
    u, v = np.meshgrid(np.arange(shape[1] // size_px), np.arange(shape[0] // size_px))
    return np.asarray((np.column_stack([u.ravel(), v.ravel()]) + 0.5) * size_px - 0.5)


def tiles(image: AnyArray, size_px: int) -> AnyArray:
    """Squares (K, size_px ** 2) of an image (h, w), row by row."""
    rows, columns = (length // size_px for length in image.shape)
    whole = image[: rows * size_px, : columns * size_px]
    parts = whole.reshape(rows, size_px, columns, size_px).swapaxes(1, 2)
    return np.asarray(parts.reshape(rows * columns, -1))
