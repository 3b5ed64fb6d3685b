"""How a robot moves from image to image, by the terrain that both of them show."""

from dataclasses import dataclass, field

import cv2
import numpy as np

from odometry.arrays import FloatArray, IntArray, spread
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.terrain_views import FEWEST, Pixels, TerrainViews

PAIRS, FEWEST_PAIRS = 32, 16  # of images that are compared, some milliseconds each
MOST_PIXELS = 400_000_000  # that are decoded, unless there are the fewest pairs: some seconds
APART_M, APART_S = 0.12, 1.0  # travel of the treads between them, if it takes no longer
MOVING_M = 0.02  # with less travel an image shows the same as the one before
# Of the scale between two images: steady cameras have 0.002 to 0.007, and 0.04 where the pitch is
# wrong by 8 degrees; one that rocks by half a degree and more has 0.013 to 0.17
STEADY = 0.012
OFF = 0.03  # of the camera's height: how far off a feature may be on the terrain


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
    scales : (P,)
        How much larger terrain is in the first image than in the second; 1 by the right camera.
    matches : tuple of Pixels
        The same terrain in both images of each pair, some of it mistaken.
    """

    rows: IntArray
    stamps_s: FloatArray
    steps: FloatArray
    tried: int
    scales: FloatArray = field(default_factory=lambda: np.empty(0))
    matches: tuple[Pixels, ...] = ()

    def __len__(self) -> int:
        return len(self.steps)

    @property
    def scale(self) -> tuple[float, float]:
        """Median of the scales' logarithms, and their deviation (1.48 times the median one)."""
        logs = np.log(self.scales)
        middle = float(np.median(logs))
        return middle, 1.48 * float(np.median(np.abs(logs - middle)))

    @property
    def is_steady(self) -> bool:
        """Whether the camera does not rock, and points as [camera] says."""
        return max(abs(of) for of in self.scale) < STEADY


def ground_steps(run: Run, camera: Camera, views: TerrainViews | None = None) -> GroundSteps:
    """Match the terrain of pairs of images, spread over the motion of a run."""
    pairs = pairs_to_compare(run, camera)
    if run.images is None or not len(pairs):
        return GroundSteps(pairs, np.empty((0, 2)), np.empty((0, 3)), len(pairs))
    views = views or TerrainViews(run, camera.image_size)
    files, found = run.images["file"], []
    for place, (first, second) in enumerate(pairs.tolist()):
        same = views.same(camera, str(files[first]), str(files[second]))
        moved = None if same is None else moved_terrain(camera, same)
        if same is not None and moved is not None:
            found.append((place, same, moved))
    known = pairs[[place for place, _, _ in found]].reshape(-1, 2)
    moves = np.array([moved for _, _, moved in found], dtype=np.float64).reshape(-1, 5)
    return GroundSteps(
        known,
        run.images.stamps_s[known].reshape(-1, 2),
        moves[:, :3],
        len(pairs),
        moves[:, 3],
        tuple(same for _, same, _ in found),
    )


def pairs_to_compare(run: Run, camera: Camera) -> IntArray:
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


def moved_terrain(camera: Camera, same: Pixels) -> FloatArray | None:
    """Step (3,) and scale under which most terrain of both is the same, and how large a share.

    None where too little is.
    """
    here, there = (camera.pixels_to_ground(pixels) for pixels in same)
    off_m = OFF * camera.height_m
    moved, agrees = cv2.estimateAffinePartial2D(there, here, ransacReprojThreshold=off_m)
    if moved is None or int(agrees.sum()) < FEWEST:
        return None
    (a, _, x), (b, _, y) = moved
    return np.array([x, y, np.arctan2(b, a), np.hypot(a, b), agrees.mean()])
