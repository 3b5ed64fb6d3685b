"""The way that a robot drove, and when its footprint was over a piece of it."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.geometry import se2
from odometry.run import Run
from odometry.trajectory import Trajectory
from terrain.places import Footprint

STEP_M = 0.03  # of wheel travel, between the poses of a way


@dataclass(frozen=True)
class Passing:
    """From before the footprint was over any part of a piece of ground until it was over none."""

    begin_s: float
    end_s: float


@dataclass(frozen=True, eq=False)
class DrivenWay:
    """Poses along the way, in the odometry frame, and the footprint that was carried along.

    Attributes
    ----------
    trajectory : Trajectory
        In steps of STEP_M of wheel travel, N of them.
    travel_m : (N,)
    footprint : Footprint
    """

    trajectory: Trajectory
    travel_m: FloatArray
    footprint: Footprint

    @classmethod
    def of(cls, run: Run, odometer: Trajectory) -> Self:
        """The way of a run by a trajectory that no pose corrects, so that no place moves."""
        travel_m = np.interp(odometer.stamps_s, run.odometry.stamps_s, run.wheel_travel_m)
        grid_m = np.append(np.arange(travel_m[0], travel_m[-1], STEP_M), travel_m[-1])
        stamps_s = np.unique(np.interp(grid_m, travel_m, odometer.stamps_s))
        along_m = np.interp(stamps_s, odometer.stamps_s, travel_m)
        return cls(odometer.at(stamps_s), along_m, Footprint.of(run.robot, 1.0))

    def ahead(self, stamp_s: float, most_m: float) -> slice:
        """Rows after a stamp, up to so much wheel travel."""
        stamps_s = self.trajectory.stamps_s
        first = int(np.searchsorted(stamps_s, stamp_s))
        at_m = float(np.interp(stamp_s, stamps_s, self.travel_m))
        return slice(first, int(np.searchsorted(self.travel_m, at_m + most_m, side="right")))

    def passings(self, points: FloatArray, rows: slice) -> list[Passing | None]:
        """When the footprint first was over each of several pieces of ground.

        Parameters
        ----------
        points : (n, m, 2)
            Of n pieces, in the odometry frame.
        rows : slice
            Of the way.

        Returns
        -------
        list of n Passing or None
            None where the footprint was not over every point of the piece in one passing.
        """
        robot = se2.inverse(self.trajectory.poses[rows])[:, None, None]
        from_robot = np.abs(se2.transform(robot, points))
        half_m = np.array([self.footprint.length_m, self.footprint.width_m]) / 2
        over = np.all(from_robot <= half_m, axis=-1)  # (rows, n, m)
        stamps_s = self.trajectory.stamps_s[rows]
        return [_first_passing(over[:, piece], stamps_s) for piece in range(len(points))]


def _first_passing(over: BoolArray, stamps_s: FloatArray) -> Passing | None:
    """Of the rows of `over` (rows, points) the first ones in a row in which any point is under."""
    touched = np.any(over, axis=1)
    if not touched.any():
        return None
    first = int(touched.argmax())
    after = np.flatnonzero(~touched[first:])
    end = first + int(after[0]) if len(after) else len(touched)
    if not over[first:end].any(axis=0).all():
        return None
    return Passing(float(stamps_s[max(first - 1, 0)]), float(stamps_s[min(end, len(touched) - 1)]))
