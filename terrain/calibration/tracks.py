"""Features tracked between images of a run, with the odometer's motion between them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from tqdm import tqdm

from odometry.arrays import ByteImage, FloatArray, IntArray, spread
from odometry.geometry import se2
from odometry.recording.run import Run
from odometry.trajectory import Trajectory
from terrain.calibration.warp import Warp, followed
from terrain.camera_files.lens_models import Lens
from terrain.errors import CalibrationError, ImageError
from terrain.images import read_image, to_grey

if TYPE_CHECKING:
    from collections.abc import Iterable

PAIRS = 60  # images spread over the run, each with a later one
SHORTEST_M, WANTED_M, LONGEST_M = 0.03, 0.12, 0.6  # travel between the two images of a pair
MOST_TURN_RAD = 0.35
FEWEST = 12  # features of a pair that is used


@dataclass(frozen=True, eq=False)
class Tracks:
    """Features of pairs of images, the pairs one after the other.

    Attributes
    ----------
    before, after : (N, 2)
        Normalised image coordinates without distortion, in the first and the second image.
    pair : (N,)
        Which pair each feature is of, rising.
    steps : (P, 3)
        Motion of the robot from the first to the second image: x, y [m], yaw [rad].
    tried : int
        Pairs of images that were opened.
    """

    before: FloatArray
    after: FloatArray
    pair: IntArray
    steps: FloatArray
    tried: int

    def of_pairs(self, chosen: IntArray) -> "Tracks":
        """The tracks of some pairs, numbered again from 0."""
        place = np.full(len(self.steps), -1)
        place[chosen] = np.arange(len(chosen))
        kept = place[self.pair] >= 0
        return Tracks(
            self.before[kept], self.after[kept], place[self.pair[kept]], self.steps[chosen],
            self.tried,
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Tracker:
    """Pairs of images of a run in which features are tracked.

    Attributes
    ----------
    run : Run
    lens : Lens
    pairs : tuple of (int, int)
        Rows of images.csv.
    steps : (P, 3)
        Motion of the robot between the two images of each pair.
    show_progress : bool
    """

    run: Run
    lens: Lens
    pairs: tuple[tuple[int, int], ...]
    steps: FloatArray
    show_progress: bool = False

    def track(self, mount: FloatArray | None = None) -> Tracks:
        """Track features in all pairs.

        Parameters
        ----------
        mount : (6,), optional
            Where there is one, each second image is first warped to what the first would show if
            all were terrain: the remaining motion is small, and the features keep their shape,
            by which a tracker of windows is off.

        Raises
        ------
        CalibrationError
            If images are not of the size of the lens.
        """
        bar: Iterable[tuple[int, int]] = tqdm(
            self.pairs, "images", unit="pair", disable=None if self.show_progress else True
        )
        befores, afters, used = [], [], []
        for number, rows in enumerate(bar):
            first, second = (_read(self.run, self.lens, row) for row in rows)
            if first is None or second is None:
                continue
            warp = None if mount is None else Warp(self.lens, mount, self.steps[number])
            rays = _tracked_rays(first, second, self.lens, warp)
            known = np.isfinite(np.hstack(rays)).all(axis=1)
            if np.count_nonzero(known) >= FEWEST:
                befores.append(rays[0][known])
                afters.append(rays[1][known])
                used.append(number)
        return Tracks(
            np.concatenate([np.empty((0, 2)), *befores]),
            np.concatenate([np.empty((0, 2)), *afters]),
            np.repeat(np.arange(len(used)), [len(one) for one in befores]),
            self.steps[used].reshape(-1, 3),
            len(self.pairs),
        )


def tracker_of(
    run: Run, lens: Lens, odometer: Trajectory, *, show_progress: bool = False
) -> Tracker:
    """Choose pairs of images to compare.

    The second is the first image after WANTED_M of travel, if the robot then has gone no farther
    than LONGEST_M and turned by no more than MOST_TURN_RAD.

    Raises
    ------
    CalibrationError
        If the run has no images.
    """
    if run.images is None:
        raise CalibrationError(f"{run.folder}: no images.csv, and so no images to track")
    rows = np.flatnonzero(odometer.covers(run.images.stamps_s))
    poses = odometer.at(run.images.stamps_s[rows]).poses
    travel_m = np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(poses[:, :2], axis=0), axis=1))]
    )[: len(rows)]
    seconds = np.searchsorted(travel_m, travel_m + WANTED_M)
    firsts = np.flatnonzero(seconds < len(rows))
    seconds = seconds[firsts]
    steps = np.asarray(se2.between(poses[firsts], poses[seconds])).reshape(-1, 3)
    length_m = np.linalg.norm(steps[:, :2], axis=1)
    usable = (length_m > SHORTEST_M) & (length_m < LONGEST_M)
    usable &= np.abs(steps[:, 2]) < MOST_TURN_RAD
    chosen = np.flatnonzero(usable)
    chosen = chosen[spread(len(chosen), PAIRS)] if len(chosen) else chosen
    pairs = tuple((int(rows[firsts[k]]), int(rows[seconds[k]])) for k in chosen)
    return Tracker(run, lens, pairs, steps[chosen], show_progress)


def _tracked_rays(
    first: ByteImage, second: ByteImage, lens: Lens, warp: Warp | None
) -> tuple[FloatArray, FloatArray]:
    """Normalised coordinates (N, 2) of features in both images; NaN outside of the lens model."""
    if warp is None:
        before, after = followed(first, second)
        return lens.rays(before), lens.rays(after)
    before, after = followed(first, *warp.image(first, second))
    return lens.rays(before), warp.rays(lens.rays(after))


def _read(run: Run, lens: Lens, row: int) -> ByteImage | None:
    if run.images is None:
        return None
    file = run.folder / str(run.images["file"][row])
    try:
        image = to_grey(read_image(file))
    except ImageError:
        return None
    if image.shape[::-1] != lens.image_size:
        seen, expected = image.shape[::-1], lens.image_size
        raise CalibrationError(
            "{}: an image of {} x {} pixels, the lens is that of {} x {}".format(
                file, *seen, *expected
            )
        )
    return image
