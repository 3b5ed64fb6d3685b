"""The way that a robot drove, and when its footprint was over a piece of it."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.geometry import se2
from odometry.recording.run import Run
from odometry.trajectory import Trajectory
from terrain.switch.place_labels import Footprint

STEP_M = 0.03  # of wheel travel, between the poses of a way


@dataclass(frozen=True)
class Passing:
    """From before the footprint was over any part of a square until it was over none."""

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
        """When the robot first drove over each of several squares of terrain.

        It drives over a square that its footprint covers in one passage, and that lies between
        where its middle comes from and where it goes to: labels are of the terrain under the
        middle, so that they are not known ahead of a place where the robot turned round or went
        back.

        Parameters
        ----------
        points : (n, m, 2)
            Of n pieces, in the odometry frame.
        rows : slice
            Of the way.

        Returns
        -------
        list of n Passing or None
            None where the robot did not go over the piece, or not the first time that its
            footprint was over any part of it.
        """
        poses = self.trajectory.poses[rows]
        from_robot = np.abs(se2.transform(se2.inverse(poses)[:, None, None], points))
        half_m = np.array([self.footprint.length_m, self.footprint.width_m]) / 2
        over = np.all(from_robot <= half_m, axis=-1)  # (rows, n, m)
        stamps_s = self.trajectory.stamps_s[rows]
        found: list[Passing | None] = []
        for piece, of_piece in enumerate(points):
            span = _first_rows(over[:, piece])
            if span is None or not _is_between(of_piece, poses[list(span), :2], half_m[1]):
                found.append(None)
            else:
                found.append(Passing(*stamps_s[list(span)].tolist()))
        return found


def _first_rows(over: BoolArray) -> tuple[int, int] | None:
    """Rows before and after the first ones in which any point of a piece (rows, points) is under.

    None where not all points are under in one of these.
    """
    touched = np.any(over, axis=1)
    if not touched.any():
        return None
    first = int(touched.argmax())
    after = np.flatnonzero(~touched[first:])
    end = first + int(after[0]) if len(after) else len(touched)
    if not np.all(np.any(over[first:end], axis=0)):
        return None
    return max(first - 1, 0), min(end, len(touched) - 1)


def _is_between(points: FloatArray, ends_m: FloatArray, half_width_m: float) -> bool:
    """Whether points (m, 2) lie in a straight strip from one place to another (2, 2)."""
    begin_m, end_m = ends_m
    length_m = float(np.hypot(*(end_m - begin_m)))
    ahead = (end_m - begin_m) / max(length_m, STEP_M)
    along, across = (points - begin_m) @ ahead, (points - begin_m) @ [-ahead[1], ahead[0]]
    return bool(np.all((along >= 0) & (along <= length_m) & (np.abs(across) <= half_width_m)))
