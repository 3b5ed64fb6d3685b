"""Rectangles on the ground plane, the footprint ahead, and the share that an image shows finely."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.geometry import se2
from odometry.recording.run import Robot
from terrain.camera.camera import Camera


@dataclass(frozen=True)
class Rectangle:
    """A rectangle on the ground plane, its sides along the axes of the robot frame now [m].

    Examples
    --------
    >>> import terrain
    >>> ahead = terrain.Rectangle(x_min=0.8, x_max=1.4, y_min=-0.3, y_max=0.3)
    >>> ahead.corners.shape
    (4, 2)
    """

    x_min: float
    x_max: float
    y_min: float
    y_max: float

    @classmethod
    def round(cls, centre: FloatArray, half_size: FloatArray) -> "Rectangle":
        """From its middle (2,) and half its sides (2,) along x and y."""
        (x_min, y_min), (x_max, y_max) = centre - half_size, centre + half_size
        return cls(float(x_min), float(x_max), float(y_min), float(y_max))

    @property
    def corners(self) -> FloatArray:
        """Corners (4, 2), far left first, clockwise in the image."""
        return np.array(
            [
                [self.x_max, self.y_max],
                [self.x_max, self.y_min],
                [self.x_min, self.y_min],
                [self.x_min, self.y_max],
            ]
        )

    @property
    def middle(self) -> FloatArray:
        """Its middle (2,)."""
        return np.array([self.x_min + self.x_max, self.y_min + self.y_max]) / 2


POINTS = 7  # along each side of the footprint; odd, so that its middle is one of them
TOGETHER = 100  # poses; the first that shows all is seldom far along
FEW = [0, POINTS - 1, POINTS**2 // 2, POINTS**2 - POINTS, POINTS**2 - 1]  # corners and middle


@dataclass(frozen=True)
class FootprintPart:
    """The footprint or one half of it: its middle (2,) in the robot frame, length and width."""

    middle_m: FloatArray
    length_m: float
    width_m: float

    def bounds(self, pose: FloatArray) -> Rectangle:
        """The rectangle round it at a pose (3,), along the axes of the robot frame now.

        Chen 2023 eq. 22.
        """
        sine, cosine = abs(np.sin(pose[2])), abs(np.cos(pose[2]))
        along_x = self.width_m * sine + self.length_m * cosine  # H_p
        along_y = self.width_m * cosine + self.length_m * sine  # L_p
        middle = se2.transform(pose, self.middle_m)
        return Rectangle.round(middle, np.array([along_x, along_y]) / 2)

    @cached_property
    def points(self) -> FloatArray:
        """Points spread over it (POINTS**2, 2), corners included, in the robot frame."""
        share = np.linspace(-0.5, 0.5, POINTS)
        points = np.stack(np.meshgrid(share * self.length_m, share * self.width_m), axis=-1)
        return np.asarray(self.middle_m + points.reshape(-1, 2))


def footprint_parts(robot: Robot, scale: float, *, per_tread: bool) -> tuple[FootprintPart, ...]:
    """The enlarged footprint, of length W_1 and width B_1, or its left and its right half."""
    length_m = scale * (robot.length or robot.track_width)
    width_m = scale * (robot.width or robot.track_width)
    return _parts_of(length_m, width_m, per_tread)


@lru_cache(maxsize=16)
def _parts_of(length_m: float, width_m: float, per_tread: bool) -> tuple[FootprintPart, ...]:
    if not per_tread:
        return (FootprintPart(np.zeros(2), length_m, width_m),)
    aside = np.array([0.0, width_m / 4])
    return FootprintPart(aside, length_m, width_m / 2), FootprintPart(-aside, length_m, width_m / 2)


def visible_shares(
    camera: Camera, poses: FloatArray, parts: tuple[FootprintPart, ...], coarsest_m: float = inf
) -> FloatArray:
    """The visible share (N,) of the parts at poses (N, 3), 0 where a middle is not visible.

    Of several parts the smallest share.
    """
    shares = np.ones(len(poses))
    for part in parts:
        shown = is_visible(camera, se2.transform(poses[:, None], part.points), coarsest_m)
        shares = np.minimum(shares, shown[:, POINTS**2 // 2] * shown.mean(axis=1))
    return shares


def first_whole(
    camera: Camera, poses: FloatArray, parts: tuple[FootprintPart, ...], coarsest_m: float
) -> int | None:
    """The first of poses (N, 3) at which all points of all parts are visible."""
    points = np.concatenate([part.points for part in parts])
    few = np.concatenate([part.points[FEW] for part in parts])
    for start in range(0, len(poses), TOGETHER):
        tried = poses[start : start + TOGETHER]
        places = se2.transform(tried[:, None], few)
        inside = np.flatnonzero(is_visible(camera, places).all(axis=1))
        for place in inside[is_visible(camera, places[inside], coarsest_m).all(axis=1)]:
            if is_visible(camera, se2.transform(tried[place], points), coarsest_m).all():
                return start + int(place)
    return None


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
        return camera.shows_terrain(camera.ground_to_pixels(points))
    places = np.asarray(points).reshape(-1, 2)
    at, *aside = camera.ground_to_pixels(places + ASIDE)
    by_x, by_y = ((there - at) / STEP_M for there in aside)
    fine = _smallest_stretch(by_x, by_y) * coarsest_m >= 1
    return (camera.shows_terrain(at) & fine).reshape(np.shape(points)[:-1])


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


@lru_cache(maxsize=1)  # of CELLS, for each image
def _blocks(cells: int) -> tuple[IntArray, IntArray, IntArray]:
    """First and end (n,) of all runs of cells, and the sizes (n, n) of blocks of two of them."""
    first, end = np.triu_indices(cells + 1, k=1)
    return first, end, np.multiply.outer(end - first, end - first)


def _largest_block(cells: BoolArray) -> IntArray:
    """First and end row, first and end column of the largest block of true cells (n, n)."""
    if not cells.any():
        return np.zeros(4, dtype=int)
    count = np.zeros(np.add(cells.shape, 1), dtype=int)  # of true cells above and left
    count[1:, 1:] = cells.cumsum(axis=0).cumsum(axis=1)
    first, end, size = _blocks(len(cells))
    rows = count[end] - count[first]  # (pairs of rows, columns + 1)
    inside = rows[:, end] - rows[:, first]
    row, column = np.unravel_index(np.where(inside == size, size, 0).argmax(), size.shape)
    return np.array([first[row], end[row], first[column], end[column]])
