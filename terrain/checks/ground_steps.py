"""How a robot moves from image to image, by the terrain that both of them show."""

from dataclasses import dataclass

import cv2
import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.io.files import read_bytes
from odometry.run import Run
from terrain.camera import Camera
from terrain.checks.image_files import MOST_BYTES, spread
from terrain.errors import ImageError
from terrain.image_size import stated_size

PAIRS, FEWEST_PAIRS = 32, 16  # of images that are compared, some milliseconds each
MOST_PIXELS = 400_000_000  # that are decoded, unless there are the fewest pairs: some seconds
APART_M, APART_S = 0.12, 1.0  # travel of the treads between them, if it takes no longer
MOVING_M = 0.02  # with less travel an image shows the same as the one before
WIDTH_PX = 320  # larger images are reduced to it: their details say no more of the motion
REDUCED = {
    1: cv2.IMREAD_GRAYSCALE,
    2: cv2.IMREAD_REDUCED_GRAYSCALE_2,
    4: cv2.IMREAD_REDUCED_GRAYSCALE_4,
    8: cv2.IMREAD_REDUCED_GRAYSCALE_8,
}
FEATURES, CONTRAST = 400, 7  # of an image, and the grey levels of the weakest: sand is smooth
DISTINCT = 0.8  # distance of a feature to its like, over that to the next like it
FEWEST = 12  # features that move as one piece of terrain
# Of the camera's height: how far terrain is looked at, and how far off a feature may be there
FARTHEST, OFF = 6.0, 0.03


@dataclass(frozen=True, eq=False)
class GroundSteps:
    """Motion of the robot in P pairs of images, by the terrain in them.

    Attributes
    ----------
    rows : (P, 2)
        Of images.csv.
    stamps_s : (P, 2)
        Of both images.
    steps : (P, 3)
        x, y [m], yaw [rad] of the second robot frame in the first.
    tried : int
        Pairs of images that were compared.
    """

    rows: IntArray
    stamps_s: FloatArray
    steps: FloatArray
    tried: int

    def __len__(self) -> int:
        return len(self.steps)


def ground_steps(run: Run, camera: Camera) -> GroundSteps:
    """Match the terrain of pairs of images, spread over the motion of a run."""
    pairs = _pairs(run, camera)
    seen = {row: _features(run, camera, row) for row in np.unique(pairs).tolist()}
    off_m = OFF * camera.height_m
    found = [_step(seen[first], seen[second], off_m) for first, second in pairs.tolist()]
    known = [place for place, step in enumerate(found) if step is not None]
    stamps_s = np.empty((0, 2)) if run.images is None else run.images.stamps_s[pairs[known]]
    steps = np.array([found[place] for place in known], dtype=np.float64)
    stamps_s = stamps_s.reshape(-1, 2)
    return GroundSteps(pairs[known].reshape(-1, 2), stamps_s, steps.reshape(-1, 3), len(pairs))


def _pairs(run: Run, camera: Camera) -> IntArray:
    """Rows (P, 2) of images.csv: an image, and the first one after some travel of the treads."""
    if run.images is None or len(run.images) < 2:
        return np.empty((0, 2), dtype=np.int64)
    stamps_s = run.images.stamps_s
    travel_m = np.interp(stamps_s, run.odometry.stamps_s, run.wheel_travel_m)
    first = np.arange(len(stamps_s) - 1)
    latest = np.searchsorted(stamps_s, stamps_s[:-1] + APART_S, side="right") - 1
    second = np.minimum(np.searchsorted(travel_m, travel_m[:-1] + APART_M), latest)
    moves = (second > first) & (travel_m[second] - travel_m[:-1] > MOVING_M)
    chosen = np.flatnonzero(moves)
    most = max(FEWEST_PAIRS, min(PAIRS, MOST_PIXELS // (2 * int(np.prod(camera.image_size)))))
    chosen = chosen[spread(len(chosen), most)] if len(chosen) else chosen
    return np.column_stack([first[chosen], second[chosen]])


Features = tuple[FloatArray, AnyArray]  # places (N, 2) on the terrain [m], and what is there


def _features(run: Run, camera: Camera, row: int) -> Features | None:
    assert run.images is not None  # noqa: S101 - for the type checker: it has rows
    image = _grey(run, camera, str(run.images["file"][row]))
    if image is None:
        return None
    found, described = cv2.ORB.create(FEATURES, fastThreshold=CONTRAST).detectAndCompute(
        image, None
    )
    if not found:
        return None
    pixels = np.array([one.pt for one in found], dtype=np.float64)
    places = camera.pixels_to_ground((pixels + 0.5) * camera.image_size[0] / image.shape[1] - 0.5)
    near = np.linalg.norm(places, axis=1) < FARTHEST * camera.height_m
    return places[near], described[near]


def _grey(run: Run, camera: Camera, name: str) -> AnyArray | None:
    """An image of the camera's size, reduced, in grey."""
    try:
        encoded = read_bytes(run.folder / name, ImageError, MOST_BYTES, "an image has less")
    except ImageError:
        return None
    if stated_size(encoded) != camera.image_size:
        return None
    width = camera.image_size[0]
    flag = REDUCED[max(by for by in REDUCED if by == 1 or width / by >= WIDTH_PX)]
    try:
        image = cv2.imdecode(np.frombuffer(encoded, np.uint8), flag | cv2.IMREAD_IGNORE_ORIENTATION)
    except cv2.error:
        return None
    if image is None or image.shape[1] <= WIDTH_PX:
        return image
    height = round(image.shape[0] * WIDTH_PX / image.shape[1])
    return np.asarray(cv2.resize(image, (WIDTH_PX, height), interpolation=cv2.INTER_AREA))


def _step(before: Features | None, after: Features | None, off_m: float) -> FloatArray | None:
    """The step (3,) under which most terrain of both is the same; None where too little is."""
    if before is None or after is None or min(len(before[0]), len(after[0])) < FEWEST:
        return None
    pairs = cv2.BFMatcher(cv2.NORM_HAMMING).knnMatch(before[1], after[1], k=2)
    same = [one for one, other in pairs if one.distance < DISTINCT * other.distance]
    if len(same) < FEWEST:
        return None
    here = before[0][[one.queryIdx for one in same]]
    there = after[0][[one.trainIdx for one in same]]
    moved, agrees = cv2.estimateAffinePartial2D(there, here, ransacReprojThreshold=off_m)
    if moved is None or int(agrees.sum()) < FEWEST:
        return None
    return np.array([moved[0, 2], moved[1, 2], np.arctan2(moved[1, 0], moved[0, 0])])
