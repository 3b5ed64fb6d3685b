"""All the terrain that an image shows, cut into cells and classified (Chen 2023, Fig. 6)."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, ByteImage, FloatArray
from terrain.camera.camera import Camera
from terrain.classification.answer import Classification, Classifier
from terrain.errors import TerrainError
from terrain.region.region import Rectangle, RegionConfig
from terrain.region.warp import ground_sampling_m, ground_view

MOST_AHEAD_M = 4.0


@dataclass(frozen=True)
class Cell:
    """A square of terrain in the robot frame and its class."""

    rectangle: Rectangle
    classification: Classification


def classify_ground(image: ByteImage, camera: Camera, classifier: Classifier) -> list[Cell]:
    """Classify the visible terrain cell by cell, as without a prediction of the path.

    Parameters
    ----------
    image : (H, W) or (H, W, 3)
        Raw image of the camera.
    camera : Camera
    classifier : Classifier
        Fitted, with a metric scale: a cell is as large as a training patch.

    Returns
    -------
    list of Cell
        Near cells first, from left to right. Empty where the image shows no terrain finely enough.

    Raises
    ------
    TerrainError
        If the classifier has no metric scale.
    CameraError
        If the image is not of the camera's size.
    """
    scale = classifier.metres_per_pixel
    if scale is None:
        raise TerrainError(
            "the classifier was trained without metres per pixel; the terrain of a whole image "
            "can only be cut into cells of a known size"
        )
    camera.check_size(image)
    cells = visible_cells(camera, classifier.patch_size_px * scale, RegionConfig.coarsest * scale)
    views = [ground_view(image, camera, cell, scale) for cell in cells]
    answers = classifier.classify(views)
    return [Cell(cell, answer) for cell, answer in zip(cells, answers, strict=True)]


def visible_cells(camera: Camera, size_m: float, coarsest_m: float) -> list[Rectangle]:
    """Squares of terrain, side by side, that the image shows whole and finely enough.

    Parameters
    ----------
    camera : Camera
    size_m : float
        Side of a square.
    coarsest_m : float
        A pixel may cover so much terrain at the most.

    Returns
    -------
    list of Rectangle
        From the nearest terrain straight ahead to 4 m; near first, then from left to right.
    """
    nearest_m = _nearest_ahead_m(camera)
    if nearest_m is None:
        return []
    rows_x = nearest_m + size_m * np.arange(int((MOST_AHEAD_M - nearest_m) / size_m))
    cells = [cell for x in rows_x for cell in _row(camera, float(x), size_m)]
    return [
        cell
        for cell in cells
        if _is_visible(camera, cell) and ground_sampling_m(camera, cell)[1] <= coarsest_m
    ]


def outline(rectangle: Rectangle, points_per_side: int = 16) -> FloatArray:
    """The border of a rectangle (4 * points_per_side, 2), which a curved lens may bend."""
    corners = rectangle.corners
    share = np.arange(points_per_side)[:, None] / points_per_side
    sides = [
        a + share * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    return np.concatenate(sides)


def _row(camera: Camera, x: float, size_m: float) -> list[Rectangle]:
    """As many squares as fit into the image between x and x + size_m, in its middle."""
    y = np.linspace(MOST_AHEAD_M, -MOST_AHEAD_M, 801)
    across = np.stack(np.meshgrid(np.linspace(x, x + size_m, 5), y), axis=-1)
    seen = y[camera.shows_terrain(camera.ground_to_pixels(across)).all(axis=1)]
    if not len(seen):
        return []
    count = int((seen[0] - seen[-1]) / size_m + 1e-9)
    lefts = (seen[0] + seen[-1]) / 2 + size_m * (count / 2 - np.arange(count))
    return [Rectangle(x, x + size_m, float(left - size_m), float(left)) for left in lefts]


def _is_visible(camera: Camera, cell: Rectangle) -> bool:
    return bool(camera.shows_terrain(camera.ground_to_pixels(outline(cell))).all())


def _nearest_ahead_m(camera: Camera) -> float | None:
    """The nearest terrain straight ahead of the robot that the image shows."""
    x = np.linspace(0.0, MOST_AHEAD_M, 401)
    seen: BoolArray = camera.shows_terrain(camera.ground_to_pixels(np.stack([x, 0 * x], axis=-1)))
    return float(x[seen.argmax()]) if seen.any() else None
