"""Parts of the image that stay where they are while the terrain moves: the robot, or dirt."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import cv2
import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray, spread
from odometry.checks.findings.finding import Finding, Level
from odometry.run import Run
from terrain.camera.camera import Camera
from terrain.checks.terrain_views import FARTHEST, TerrainViews
from terrain.image_labels.carried_image import middles, places_at, tiles

ROBOT_IN_IMAGES = "robot_in_images"
APART_M = 0.5  # of travel between images: by then the terrain is another
FEWEST, MOST = 12, 24  # images that are compared
TILE_PX = 8
FINEST_PX, COARSEST_PX = 1.0, 4.0  # sizes of the details of a tile
# Mean correlation of a tile in pairs of images: terrain has 0.2 at most, a part of the robot 0.7
FIXED = 0.5
LEAST_GREY = 1.0  # of details: a tile with less shows noise, or blocks of JPEG
# Of the tiles round a smooth part, in the mean: half of them may be terrain, which has 0.0
BORDER, LEAST_BORDER = 0.05, 8
LEAST_TILES, LEAST_FIXED = 4, 2  # of a part
MOST_SHARE = 0.5  # of the terrain: more is no robot, but a camera that is frozen or covered
SIMPLIFIED_PX = 2.0  # by which an outline may be off, of images of `TerrainViews`


@dataclass(frozen=True, eq=False)
class FixedParts:
    """What stays in its place in the images of a run.

    Attributes
    ----------
    outlines : tuple of (n, 2) arrays
        Polygons in raw pixels, a tile larger than what was found.
    share : float
        Of the terrain in the image that they cover.
    images : int
        That were compared.
    """

    outlines: tuple[FloatArray, ...]
    share: float
    images: int


def fixed_parts(run: Run, camera: Camera, views: TerrainViews) -> FixedParts | None:
    """Look for parts of near terrain in the image that are alike in all images of a run.

    None where there are none, or too few images to say so.
    """
    details = _details(run, views)
    if len(details) < FEWEST:
        return None
    shape = tuple(length // TILE_PX for length in details.shape[1:])
    near = _near_terrain(camera, details.shape[1:])
    of_tiles = np.stack([tiles(one, TILE_PX) for one in details])
    sizes = np.sqrt((of_tiles**2).mean(axis=2))
    alike = _alike(of_tiles)
    fixed = (alike > FIXED) & (np.median(sizes, axis=0) > LEAST_GREY)
    smooth = np.quantile(sizes, 0.9, axis=0) < LEAST_GREY
    found = _parts(*(of.reshape(shape) for of in (fixed & near, smooth & near, alike)))
    share = float(found.ravel()[near].mean()) if near.any() else 0.0
    if not 0 < share < MOST_SHARE:
        return None
    return FixedParts(tuple(_outlines(found, camera.image_size)), share, len(details))


def robot_in_images(parts: FixedParts | None) -> Iterator[Finding]:
    """The finding, with outlines to put into [camera]; mended, the run has them."""
    if parts is None:
        return
    outlines = [np.rint(outline).astype(int).tolist() for outline in parts.outlines]

    def mend(run: Run) -> Run:
        camera = run.settings["camera"]
        added = [*camera.get("robot_outlines", []), *outlines]
        table = {**camera, "robot_outlines": added}
        return replace(run, settings={**run.settings, "camera": table})

    yield Finding(
        ROBOT_IN_IMAGES,
        Level.NOTE,
        f"{100 * parts.share:.0f} % of the terrain in the image stays the same in "
        f"{parts.images} images, while the rest of it moves",
        "The robot itself (a bumper, a wheel, an arm), dirt on the lens or a caption; or terrain "
        "in the shadow of a robot that hardly turns",
        "Nothing to do: run, batch and label look beside it. To state it once for all: "
        f"[camera] robot_outlines = {outlines}",
        mend=mend,
    )


def _details(run: Run, views: TerrainViews) -> AnyArray:
    """Details (N, h, w) of images that are some travel apart, of one size."""
    if run.images is None:
        return np.empty((0, 0, 0))
    found = []
    for row in _rows(run, run.images.stamps_s):
        image = views.grey(str(run.images["file"][row]))
        if image is not None:
            values = image.astype(np.float32)
            fine, coarse = (cv2.GaussianBlur(values, (0, 0), px) for px in (FINEST_PX, COARSEST_PX))
            found.append(fine - coarse)
    return np.array(found)


def _rows(run: Run, stamps_s: FloatArray) -> IntArray:
    travel_m = np.interp(stamps_s, run.odometry.stamps_s, run.wheel_travel_m)
    rows = np.unique(np.searchsorted(travel_m, np.arange(travel_m[0], travel_m[-1], APART_M)))
    return rows[spread(len(rows), MOST)] if len(rows) else rows


def _near_terrain(camera: Camera, shape: tuple[int, ...]) -> BoolArray:
    places_m = places_at(camera, shape[1], middles(shape, TILE_PX))
    near = np.linalg.norm(places_m, axis=1) < FARTHEST * camera.height_m
    return np.asarray(near & camera.shows_terrain(camera.ground_to_pixels(places_m)))


def _alike(of_tiles: AnyArray) -> FloatArray:
    """Mean correlation (K,) of each tile in all pairs of N images, (N, K, pixels)."""
    centred = of_tiles - of_tiles.mean(axis=2, keepdims=True)
    units = centred / np.maximum(np.linalg.norm(centred, axis=2, keepdims=True), 1e-9)
    count = len(units)
    return np.asarray((count * (units.mean(axis=0) ** 2).sum(axis=1) - 1) / (count - 1))


def _parts(fixed: BoolArray, smooth: BoolArray, alike: FloatArray) -> BoolArray:
    """Tiles (rows, columns) of the parts, with those beside them.

    A part has fixed tiles, and smooth ones between and beside them; or it is all smooth, and its
    border stays: that of smooth terrain moves.
    """
    around = np.ones((3, 3), np.uint8)
    found = np.zeros(fixed.shape, dtype=np.bool_)
    count, labels = cv2.connectedComponents((fixed | smooth).astype(np.uint8), connectivity=8)
    for label in range(1, count):
        part = (labels == label).astype(np.uint8)
        border = (cv2.dilate(part, around) - part) > 0
        is_robot = np.count_nonzero(fixed & (part > 0)) >= LEAST_FIXED or (
            np.count_nonzero(border) >= LEAST_BORDER and alike[border].mean() > BORDER
        )
        if is_robot and part.sum() >= LEAST_TILES:
            found |= cv2.dilate(part, around) > 0
    return found


def _outlines(found: BoolArray, size: tuple[int, int]) -> Iterator[FloatArray]:
    """Polygons round tiles, in pixels of images of a size; to the border where they reach it."""
    image: AnyArray = np.kron(found, np.ones((TILE_PX, TILE_PX), np.uint8))
    scale = (np.array(size) - 1) / (np.array(image.shape[::-1]) - 1)
    for contour in _contours(image):
        yield cv2.approxPolyDP(contour, SIMPLIFIED_PX, True)[:, 0].astype(float) * scale


def _contours(image: AnyArray) -> Iterator[AnyArray]:
    """Contours of an image (h, w); a part with a hole is cut in two there, so that none has one."""
    contours, tree = cv2.findContours(image, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_SIMPLE)
    holes = [one for one, (*_, parent) in zip(contours, tree[0], strict=True) if parent >= 0]
    if not holes:
        yield from contours
        return
    first, _, width, _ = cv2.boundingRect(holes[0])
    columns = np.arange(image.shape[1]) < first + width // 2
    for half in (image * columns, image * ~columns):
        if half.any():
            yield from _contours(half)
