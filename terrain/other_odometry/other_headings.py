"""Faults of another program's poses that make its errors meaningless: dead poses, no heading."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.evaluation.other_odometry import Judge
from odometry.geometry import se3
from odometry.io.trajectory_files import from_optical
from odometry.trajectory import SpatialTrajectory, Trajectory
from terrain.other_odometry.shared_turns import (
    CONSTANT_RAD,
    TURNED_RAD,
    shared_pieces,
    turns_of,
)
from terrain.other_odometry.whose_poses import MOVED_M, of_another_drive, of_the_reference

STILL_M = 1e-6  # the other moves by less, the reference by more than MOVED_M
FEWEST_TURNS = 10
# Correlation of turns with the odometer's, above which another reading of yaw is named; above the
# lower one none is looked for, as the file is right as read
NAMED, AS_READ = 0.9, 0.5
MOST_RATIO = 10.0  # of both turns, either way: beyond is another unit (57.3 in degrees)
NOT_COUNTED = "Its errors are not counted: they would be those of the heading"
TILTED_DEG = 50.0  # no skid-steer robot drives there
# By format: by how many places w, x, y, z as read are rotated to get the other order, then the
# order that the file seems to have, and the one that the format wants
OTHER_ORDERS = {
    "tum": (-1, "in the order qw qx qy qz", "qx qy qz qw"),
    "euroc": (1, "in the order qx qy qz qw", "qw qx qy qz"),
}


@dataclass(frozen=True)
class PoseFault:
    """Something about another program's poses that its errors would not show.

    Attributes
    ----------
    note : str
        What is wrong, its cause, and what to do.
    counts : bool
        Whether its errors still mean something.
    fits : bool
        Whether a shift, a scale or a turn of its path could mean something.
    """

    note: str
    counts: bool = False
    fits: bool = True


def other_readings(spatial: SpatialTrajectory, named: str) -> dict[str, FloatArray]:
    """Yaw (N,) if quaternions have the other order, or axes are a camera's, by cause in words.

    Parameters
    ----------
    spatial : SpatialTrajectory
        As the file was read.
    named : {"tum", "kitti", "euroc"}
        Its format.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> turned = odometry.Trajectory(np.zeros(1), np.array([[0.0, 0.0, 0.5]]))
    >>> spatial = odometry.SpatialTrajectory.from_plane(turned)
    >>> [len(yaw) for yaw in other_readings(spatial, "tum").values()]
    [1, 1]
    """
    if named not in OTHER_ORDERS:
        return {}
    optical = from_optical(spatial).plane.poses[:, 2]
    _, seems, wanted = OTHER_ORDERS[named]
    return {
        f"its quaternions are {seems}, not {wanted} as the format has them": _reordered(
            spatial, named
        ).roll_pitch_yaw[:, 2],
        "its axes are those of a camera: --axes optical": optical,
    }


def _reordered(spatial: SpatialTrajectory, named: str) -> SpatialTrajectory:
    """A trajectory as it is where its quaternions have the other order."""
    wxyz = np.roll(spatial.quaternions_wxyz, OTHER_ORDERS[named][0], axis=1)
    turned = se3.pose(spatial.positions_m, se3.rotation_from_quaternion_wxyz(wxyz))
    return SpatialTrajectory(spatial.stamps_s, turned)


def order_fault(spatial: SpatialTrajectory, named: str) -> str:
    """Why quaternions seem to have the other order, without any other sensor; "" where they do not.

    As they are the body lies on its side or back in most rows, and in the other order it is never
    tilted as no robot drives.
    """
    if named not in OTHER_ORDERS:
        return ""
    tilts_deg = _tilts_deg(spatial)
    middle_deg = float(np.median(tilts_deg))
    if middle_deg < TILTED_DEG or _tilts_deg(_reordered(spatial, named)).max() > TILTED_DEG:
        return ""
    _, seems, wanted = OTHER_ORDERS[named]
    return (
        f"the body is tilted by {middle_deg:.0f} degrees in the middle of its rows, and never by "
        f"{TILTED_DEG:.0f} where its quaternions are {seems}; expected {wanted}. (Poses of a "
        "camera need --axes optical.)"
    )


def _tilts_deg(spatial: SpatialTrajectory) -> FloatArray:
    """Angles (N,) between the body's z and that of the map."""
    return np.asarray(np.degrees(np.arccos(np.clip(spatial.poses[:, 2, 2], -1.0, 1.0))))


def pose_fault(
    trajectory: Trajectory, judge: Judge, readings: Mapping[str, FloatArray]
) -> PoseFault | None:
    """Why a trajectory's errors would mislead; None where nothing speaks against them.

    Parameters
    ----------
    trajectory : Trajectory
    judge : Judge
        Its odometer shows how the robot turned.
    readings : Mapping of str to (N,)
        Other yaw [rad] that the file may mean, by the cause in words.
    """
    xy = trajectory.poses[:, :2]
    moved_m = float(np.ptp(judge.reference.poses[:, :2], axis=0).max())
    if np.ptp(xy, axis=0).max() < STILL_M and moved_m > MOVED_M:
        return PoseFault(
            f"it never moves: all of its {len(xy)} positions are ({xy[0, 0]:.4g}, {xy[0, 1]:.4g}), "
            "as of a topic that measures speeds alone and leaves the pose empty. Give a file or "
            "topic with poses; its errors are not counted"
        )
    if fault := _heading_fault(trajectory, judge.odometer, readings):
        return fault
    if note := of_another_drive(trajectory, judge):
        return PoseFault(note, counts=True, fits=False)
    note = of_the_reference(trajectory, judge)
    return PoseFault(note, counts=True) if note else None


def _heading_fault(
    trajectory: Trajectory, odometer: Trajectory, readings: Mapping[str, FloatArray]
) -> PoseFault | None:
    rows = shared_pieces(trajectory, odometer)
    ours = turns_of(odometer, odometer.poses[:, 2], rows)
    if len(ours) < FEWEST_TURNS or np.ptp(np.cumsum(ours)) < TURNED_RAD:
        return None
    yaw = trajectory.poses[:, 2]
    if _fits(as_read := turns_of(trajectory, yaw, rows), ours, AS_READ):
        return None
    degrees = {"its yaw is in degrees, not in radians": np.radians(yaw)}
    for cause, other in {**readings, **degrees}.items():
        if _fits(turns_of(trajectory, other, rows), ours, NAMED):
            return PoseFault(f"{cause}; so read, its turns follow those of ours. {NOT_COUNTED}")
    if np.ptp(np.unwrap(yaw)) < CONSTANT_RAD:
        return PoseFault(
            f"its heading stays at {yaw[0]:.4g} rad while the robot turns by "
            f"{np.abs(ours).sum():.1f} rad in all: a placeholder, or the numbers of a quaternion "
            f"in another order. Write its heading. {NOT_COUNTED}"
        )
    if _fits(-as_read, ours, NAMED):
        note = "its turns are opposite to those of ours: z points down, or its sides are exchanged"
        said = (
            f"{note}. If so, change the sign of y and yaw. Nothing is changed here: the errors are "
            "of the path as given"
        )
        return PoseFault(said, counts=True, fits=False)
    return None


def _fits(turns: FloatArray, ours: FloatArray, least: float) -> bool:
    """Whether turns (K,) rise with ours by a correlation of `least`, in the same unit."""
    sizes = [float(np.sqrt(np.mean(each**2))) for each in (turns, ours)]
    if min(sizes) == 0 or not 1 / MOST_RATIO < sizes[0] / sizes[1] < MOST_RATIO:
        return False
    if np.ptp(turns) < CONSTANT_RAD:
        return False
    return float(np.corrcoef(turns, ours)[0, 1]) > least
