"""Squares of terrain that an image shows finely enough and the robot then drove over."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree
from tqdm import tqdm

from odometry.arrays import FloatArray, IntArray
from odometry.geometry import se2
from odometry.recording.run import Run
from odometry.tables.table import Table
from odometry.trajectory import Trajectory
from odometry.windows.recorded.gaps import odometry_gaps
from terrain.camera.camera import Camera
from terrain.labelling.driven_path import DrivenWay, Passing
from terrain.region.footprint_parts import Rectangle, is_visible
from terrain.region.region import RegionConfig


def place_centres(middles_m: FloatArray, apart_m: float) -> FloatArray:
    """Centres (p, 2) among points (n, 2): each the first that is `apart_m` from those before."""
    centres = np.empty((0, 2))
    for middle_m in middles_m:
        if not np.any(np.hypot(*(centres - middle_m).T) < apart_m):
            centres = np.vstack([centres, middle_m])
    return centres


def places_of(middles_m: FloatArray, centres_m: FloatArray, radius_m: float) -> IntArray:
    """The place in which each square lies whole.

    A place is all that is nearer to its centre than to any other (a Voronoi cell).

    Parameters
    ----------
    middles_m : (n, 2)
        Of the pieces.
    centres_m : (p, 2), p at least 1
    radius_m : float
        From the middle of a piece to its farthest point.

    Returns
    -------
    (n,)
        Index of the place; -1 where the piece crosses a border, or may.
    """
    nearest = cKDTree(centres_m).query(middles_m)[1]
    places = np.array(nearest, dtype=np.int64)
    for place, centre in enumerate(centres_m):
        own = np.flatnonzero(nearest == place)
        others = np.delete(centres_m, place, axis=0)
        between_m = np.hypot(*(others - centre).T)
        to_others = ((middles_m[own, None] - others) ** 2).sum(axis=-1)
        to_own = ((middles_m[own] - centre) ** 2).sum(axis=-1)[:, None]
        crosses = to_others - to_own < 2 * between_m * radius_m  # the border is halfway
        places[own[crosses.any(axis=1)]] = -1
    return places


ASIDE = 0.8  # of what a footprint is wider than a square: so far the outer squares lie apart
STARTS = (0.0, 0.5, 0.25, 0.75)  # sides ahead of the robot; a narrow view shows few of a row
GRID = 5  # points along each side of a square; all of them are shown and driven over


@dataclass(frozen=True)
class DrivenSquare:
    """A square of terrain in one image.

    Attributes
    ----------
    image : str
        File, as images.csv names it.
    stamp_s : float
        Of the image.
    rectangle : Rectangle
        In the robot frame at that stamp.
    passing : Passing
        When the footprint was over it.
    middle_m : (float, float)
        In the odometry frame.
    place_m : (float, float)
        Its middle in the frame of the poses, where there are some.
    """

    image: str
    stamp_s: float
    rectangle: Rectangle
    passing: Passing
    middle_m: tuple[float, float]
    place_m: tuple[float, float]


@dataclass(frozen=True, eq=False)
class SquareFinder:
    """Finds the squares of one run.

    Attributes
    ----------
    run : Run
    images : Table
        Of the run.
    camera : Camera
    way : DrivenWay
    odometer, estimate : Trajectory
        The same run without and with corrections by poses.
    """

    run: Run
    images: Table
    camera: Camera
    way: DrivenWay
    odometer: Trajectory
    estimate: Trajectory

    @cached_property
    def poses(self) -> FloatArray:
        """Pose (n, 3) at each image in the odometry frame; NaN where the odometer has none."""
        return self._at_images(self.odometer)

    @cached_property
    def estimated_poses(self) -> FloatArray:
        """The same by the estimate."""
        return self._at_images(self.estimate)

    @cached_property
    def _gaps_s(self) -> FloatArray:
        return odometry_gaps(self.run).spans_s

    @property
    def reach_m(self) -> float:
        """How far ahead a square may lie, in wheel travel: as far as a region."""
        return RegionConfig.most_ahead_lengths * self.way.footprint.length_m

    def image_rows(self, apart_m: float) -> IntArray:
        """Rows of images.csv that the odometer covers, `apart_m` of wheel travel apart or more."""
        stamps_s = self.images.stamps_s
        covered = np.flatnonzero(np.isfinite(self.poses[:, 0]))
        way_s = self.way.trajectory.stamps_s
        travel_m = np.interp(stamps_s[covered], way_s, self.way.travel_m)
        _, first = np.unique(np.floor(travel_m / apart_m), return_index=True)
        return np.asarray(covered[first], dtype=np.int64)

    def squares(
        self, side_m: float, coarsest_m: float, rows: IntArray, *, show_progress: bool = False
    ) -> Iterator[DrivenSquare]:
        """The squares of some images, near ones first.

        Parameters
        ----------
        side_m : float
        coarsest_m : float
            A pixel may cover so much of the terrain at the most.
        rows : (n,)
            Of images.csv.
        show_progress : bool
        """
        bar = tqdm(rows, desc=self.run.name, unit="image", disable=None if show_progress else True)
        for row in bar:
            yield from self._of_image(int(row), side_m, coarsest_m)

    def rows_before(self, square: DrivenSquare) -> tuple[int, int]:
        """First and end row of images.csv of the way from which the square is within reach."""
        way_s, stamps_s = self.way.trajectory.stamps_s, self.images.stamps_s
        begin_m = float(np.interp(square.passing.begin_s, way_s, self.way.travel_m))
        first_s = float(np.interp(begin_m - self.reach_m, self.way.travel_m, way_s))
        first = int(np.searchsorted(stamps_s, first_s))
        return first, int(np.searchsorted(stamps_s, square.passing.begin_s, side="right"))

    def _of_image(self, row: int, side_m: float, coarsest_m: float) -> list[DrivenSquare]:
        """Those of the first start that has some."""
        for start in STARTS:
            squares = self._from_start(row, side_m, coarsest_m, start * side_m)
            if squares:
                return squares
        return []

    def _from_start(
        self, row: int, side_m: float, coarsest_m: float, start_m: float
    ) -> list[DrivenSquare]:
        stamp_s = float(self.images.stamps_s[row])
        pose, estimated = self.poses[row], self.estimated_poses[row]
        middles = self._middles_ahead(stamp_s, pose, side_m, start_m)
        grid = np.linspace(-side_m / 2, side_m / 2, GRID)
        points = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
        points = middles[:, None] + points
        shown = is_visible(self.camera, points, coarsest_m).all(axis=1)
        middles, points = middles[shown], se2.transform(pose, points[shown])
        rows = self.way.ahead(stamp_s, self.reach_m + 2 * self.way.footprint.radius_m)
        passings = self.way.passings(points, rows)
        half_m = np.full(2, side_m / 2)
        return [
            DrivenSquare(
                str(self.images["file"][row]),
                stamp_s,
                Rectangle.round(middle, half_m),
                passing,
                _point(pose, middle),
                _point(estimated, middle),
            )
            for middle, passing in zip(middles, passings, strict=True)
            if passing is not None and not self._in_gap(stamp_s, passing.end_s)
        ]

    def _middles_ahead(
        self, stamp_s: float, pose: FloatArray, side_m: float, start_m: float
    ) -> FloatArray:
        """Middles (n, 2) along the way ahead, a side apart, in the robot frame at the image."""
        rows = self.way.ahead(stamp_s, self.reach_m)
        travel_m = self.way.travel_m[rows]
        if not len(travel_m):
            return np.empty((0, 2))
        steps_m = np.arange(travel_m[0] + start_m, travel_m[-1], side_m)
        poses = self.way.trajectory.poses[rows][np.searchsorted(travel_m, steps_m)]
        aside_m = ASIDE * max(self.way.footprint.width_m - side_m, 0.0) / 2
        across = np.array([[0.0, aside_m], [0.0, 0.0], [0.0, -aside_m]])
        ahead = se2.between(pose, poses)
        return np.asarray(se2.transform(ahead[:, None], across)).reshape(-1, 2)

    def _in_gap(self, begin_s: float, end_s: float) -> bool:
        """Whether the odometry has a gap between two stamps: where the robot went is not known."""
        return bool(((self._gaps_s[:, 0] < end_s) & (self._gaps_s[:, 1] > begin_s)).any())

    def _at_images(self, trajectory: Trajectory) -> FloatArray:
        stamps_s = self.images.stamps_s
        covered = trajectory.covers(stamps_s)
        poses = np.full((len(stamps_s), 3), np.nan)
        poses[covered] = trajectory.at(stamps_s[covered]).poses
        return poses


def _point(pose: FloatArray, middle: FloatArray) -> tuple[float, float]:
    x, y = se2.transform(pose, middle).tolist()
    return x, y
