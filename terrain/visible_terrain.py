"""Which terrain an image shows, finely enough, and the largest rectangle of it."""

from math import inf

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from terrain.camera import Camera
from terrain.rectangle import Rectangle

CELLS = 16  # along each side of a rectangle of which a part is shown
STEP_M = 1e-3  # of the differences that give the size of a pixel on the terrain
ASIDE = STEP_M * np.array([[[0.0, 0.0]], [[1.0, 0.0]], [[0.0, 1.0]]])


def is_visible(camera: Camera, points: FloatArray, coarsest_m: float = inf) -> BoolArray:
    """Whether an image shows points of the terrain, and finely enough.

    Parameters
    ----------
    camera : Camera
    points : (..., 2)
        In the robot frame [m].
    coarsest_m : float
        A pixel may cover so much terrain at the most, in its coarsest direction.

    Returns
    -------
    (...) booleans
    """
    if coarsest_m == inf:
        return camera.in_image(camera.ground_to_pixels(points))
    places = np.asarray(points).reshape(-1, 2)
    at, *aside = camera.ground_to_pixels(places + ASIDE)
    by_x, by_y = ((there - at) / STEP_M for there in aside)
    fine = _smallest_stretch(by_x, by_y) * coarsest_m >= 1
    return (camera.in_image(at) & fine).reshape(np.shape(points)[:-1])


def largest_visible(camera: Camera, rectangle: Rectangle, coarsest_m: float = inf) -> Rectangle:
    """The largest part of a rectangle, itself a rectangle, that an image shows whole.

    Its sides lie on a grid of CELLS by CELLS cells; all of it where the image shows all.

    Parameters
    ----------
    camera : Camera
    rectangle : Rectangle
    coarsest_m : float
        See `is_visible`.

    Returns
    -------
    Rectangle
        Of no size where the image shows no cell whole.
    """
    x = np.linspace(rectangle.x_min, rectangle.x_max, CELLS + 1)
    y = np.linspace(rectangle.y_min, rectangle.y_max, CELLS + 1)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    corners = is_visible(camera, points, coarsest_m)
    if corners.all():
        return rectangle
    cells = corners[1:, 1:] & corners[1:, :-1] & corners[:-1, 1:] & corners[:-1, :-1]
    first_x, end_x, first_y, end_y = _largest_block(cells)
    return Rectangle(float(x[first_x]), float(x[end_x]), float(y[first_y]), float(y[end_y]))


def _smallest_stretch(by_x: FloatArray, by_y: FloatArray) -> FloatArray:
    """The smaller singular value of the matrices whose columns are given (N, 2) [px/m]."""
    (u_by_x, v_by_x), (u_by_y, v_by_y) = by_x.T, by_y.T
    squares = u_by_x**2 + v_by_x**2 + (u_by_y**2 + v_by_y**2)
    area = u_by_x * v_by_y - v_by_x * u_by_y
    spread = np.sqrt(np.maximum(squares**2 - 4 * area**2, 0.0))
    return np.asarray(np.sqrt(np.maximum(squares - spread, 0.0) / 2))


def _largest_block(cells: BoolArray) -> IntArray:
    """First and end row, first and end column of the largest block of true cells (n, n)."""
    if not cells.any():
        return np.zeros(4, dtype=int)
    count = np.zeros(np.add(cells.shape, 1), dtype=int)  # of true cells above and left
    count[1:, 1:] = cells.cumsum(axis=0).cumsum(axis=1)
    first, end = np.triu_indices(len(cells) + 1, k=1)
    rows = count[end] - count[first]  # (pairs of rows, columns + 1)
    inside = rows[:, end] - rows[:, first]
    size = (end - first)[:, None] * (end - first)
    row, column = np.unravel_index(np.where(inside == size, size, 0).argmax(), size.shape)
    return np.array([first[row], end[row], first[column], end[column]])
