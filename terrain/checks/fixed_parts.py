"""Parts of the image that stay while the terrain moves: the robot, its shadow, dirt."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import cv2
import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray, spread
from odometry.checks.findings.finding import Finding, Level
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.lasting_shade import lasting_shade
from terrain.checks.terrain_views import FARTHEST, TerrainViews
from terrain.image_labels.carried_image import details_between, places_of_squares, tiles

ROBOT_IN_IMAGES = "robot_in_images"
APART_M = 0.5  # of travel between images: by then the terrain is another
FEWEST, MOST = 12, 48  # images that are compared
SPANS = 4  # of them that are looked at by themselves, at most: dirt comes, and a drop goes
TILE_PX = 8
# Mean correlation of a tile in pairs of images: terrain has 0.2 at most, a part of the robot 0.7
FIXED = 0.5
LEAST_DETAIL = 1.0  # of details: a tile with less shows noise, or blocks of JPEG
# Of the tiles round a smooth part, in the mean: terrain has 0, of N images 0.4 / N more or less,
# and blocks of JPEG 0.03
BORDER, BY_CHANCE, LEAST_BORDER = 0.05, 1.2, 8
# Of the tiles at the border of a dark part: their correlation, and how much more their light varies
# than that of tiles farther on. Spots have 0.12 to 0.3 and 0.96 to 1.24; verges along the way have
# less, or 1.3 and more, where the robot sways by 3 cm
SHARP, SWAYS = 0.1, 1.3
LEAST_TILES, LEAST_FIXED = 4, 2  # of a part
MOST_SHARE = 0.4  # of the terrain: more is no robot, but a camera that is frozen or covered
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
    """Look for parts of near terrain in the image that stay in all images, or on a span of them.

    None where there are none, where most of the terrain stays (a camera that is frozen), or where
    there are too few images to say so.
    """
    images = _images(run, views)
    if len(images) < FEWEST:
        return None
    near = _near_terrain(camera, (images.shape[1], images.shape[2]))
    if not near.any():
        return None
    details = np.stack([tiles(details_between(image), TILE_PX) for image in images])
    spans = [slice(None), *_spans(len(images))]
    found = np.any([_fixed(images[span], details[span], near) for span in spans], axis=0)
    share = float(found.ravel()[near].mean())
    if not 0 < share < MOST_SHARE:
        return None
    return FixedParts(tuple(_outlines(found, camera.image_size)), share, len(images))


def _spans(count: int) -> list[slice]:
    """Parts of so many images that are looked at by themselves."""
    parts = np.array_split(np.arange(count), min(SPANS, count // FEWEST))
    return [slice(int(part[0]), int(part[-1]) + 1) for part in parts]


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
        f"{100 * parts.share:.0f} % of the terrain in the image stays as it is while the rest of "
        f"it moves, all the time or for a while, by {parts.images} images",
        "The robot itself (a bumper, a wheel, an arm) or its shadow, dirt on the lens or a "
        "caption; or an edge of the terrain along which the robot drove",
        "Nothing to do: run, batch and label look beside it. To state it once for all: "
        f"[camera] robot_outlines = {outlines}",
        mend=mend,
    )


def _images(run: Run, views: TerrainViews) -> AnyArray:
    """Grey images (N, h, w) that are some travel apart, of one size."""
    if run.images is None or not len(run.images):
        return np.empty((0, 0, 0))
    rows = _rows(run, run.images.stamps_s)
    found = (views.grey(str(run.images["file"][row])) for row in rows)
    return np.array([image for image in found if image is not None], dtype=np.float32)


def _rows(run: Run, stamps_s: FloatArray) -> IntArray:
    travel_m = np.interp(stamps_s, run.odometry.stamps_s, run.wheel_travel_m)
    rows = np.unique(np.searchsorted(travel_m, np.arange(travel_m[0], travel_m[-1], APART_M)))
    return rows[spread(len(rows), MOST)] if len(rows) else rows


def _near_terrain(camera: Camera, shape: tuple[int, int]) -> BoolArray:
    """Tiles (K,) of an image of a shape (h, w) that show terrain, not far off."""
    places_m = places_of_squares(camera, shape, TILE_PX)
    near = np.linalg.norm(places_m, axis=1) < FARTHEST * camera.height_m
    return np.asarray(near & camera.shows_terrain(camera.ground_to_pixels(places_m)))


def _alike(of_tiles: AnyArray) -> FloatArray:
    """Mean correlation (K,) of each tile in all pairs of N images, (N, K, pixels)."""
    centred = of_tiles - of_tiles.mean(axis=2, keepdims=True)
    units = centred / np.maximum(np.linalg.norm(centred, axis=2, keepdims=True), 1e-9)
    count = len(units)
    return np.asarray((count * (units.mean(axis=0) ** 2).sum(axis=1) - 1) / (count - 1))


def _fixed(images: AnyArray, of_tiles: AnyArray, near: BoolArray) -> BoolArray:
    """Tiles (rows, columns) that stay in images (N, h, w), with those beside them.

    By the details (N, K, pixels) of all tiles. All of them where the camera is frozen.
    """
    shape = tuple(length // TILE_PX for length in images.shape[1:])
    sizes = np.sqrt((of_tiles**2).mean(axis=2))
    alike = _alike(of_tiles)
    fixed = near & (alike > FIXED) & (np.median(sizes, axis=0) > LEAST_DETAIL)
    if fixed[near].mean() > MOST_SHARE:
        return np.ones(shape, dtype=np.bool_)
    smooth = near & (np.quantile(sizes, 0.9, axis=0) < LEAST_DETAIL)
    shaded, deviation = lasting_shade(images, near, TILE_PX)
    fixed, smooth, shaded = (of.reshape(shape) for of in (fixed, smooth, shaded))
    alike, deviation = alike.reshape(shape), deviation.reshape(shape)
    parts = [
        *(
            part
            for part in _parts(fixed | smooth)
            if np.count_nonzero(fixed & part) >= LEAST_FIXED
            or _stays(alike[_grown(part) & ~part], len(images))
        ),
        *(part for part in _parts(shaded) if alike[_border(part)].mean() > SHARP),
    ]
    found = np.zeros(shape, dtype=np.bool_)
    for part in parts:
        if not _sways(part, deviation):
            found |= _grown(part)
    return found


def _parts(chosen: BoolArray) -> Iterator[BoolArray]:
    """Connected parts (rows, columns) of LEAST_TILES and more."""
    count, labels = cv2.connectedComponents(chosen.astype(np.uint8), connectivity=8)
    parts = (labels == label for label in range(1, count))
    return (part for part in parts if np.count_nonzero(part) >= LEAST_TILES)


def _grown(part: BoolArray) -> BoolArray:
    """A part with the tiles beside it."""
    return np.asarray(cv2.dilate(part.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)


def _stays(alike: FloatArray, images: int) -> bool:
    """Whether the border (n,) of a smooth part stays: that of smooth terrain moves."""
    return len(alike) >= LEAST_BORDER and float(alike.mean()) > max(BORDER, BY_CHANCE / images)


def _border(part: BoolArray) -> BoolArray:
    """The tiles within and round a part at its border."""
    return _grown(part) & _grown(~part)


def _sways(part: BoolArray, deviation: FloatArray) -> bool:
    """Whether the light at the border varies more than within, and than farther off: a verge."""
    border = _border(part)
    beside = _grown(_grown(_grown(_grown(part)))) & ~_grown(_grown(part)) & (deviation > 0)
    within = part & ~border
    usual = [float(np.median(deviation[tiles])) for tiles in (beside, within) if tiles.any()]
    return float(np.sqrt((deviation[border] ** 2).mean())) > SWAYS * max(usual, default=0.0)


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
